"""How large the iris is in a clip, from the camera alone: no frame has to be rendered for it."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from renderer.camera import iris_px
from renderer.clip import ClipSpec


@lru_cache(maxsize=4096)
def median_iris_px(spec: ClipSpec) -> tuple[float, float]:
    """Return the iris's diameter in the clip's pixels, left and right, as median over the orbit."""
    frames = [iris_px(spec, spec.azimuth_deg(frame)) for frame in range(0, spec.frame_count, 5)]
    left, right = np.median(frames, axis=0)
    return round(float(left), 2), round(float(right), 2)
