"""How large the iris is in a clip, from the camera alone: no frame has to be rendered for it."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from renderer.camera import iris_px_of_frame
from renderer.clip import ClipSpec


@lru_cache(maxsize=4096)
def median_iris_px(spec: ClipSpec) -> tuple[float, float]:
    """Return the median of the iris's diameter over a clip's frames in pixels, left and right."""
    frames = [iris_px_of_frame(spec, frame) for frame in range(0, spec.frame_count, 5)]
    left, right = np.median(frames, axis=0)
    return round(float(left), 2), round(float(right), 2)
