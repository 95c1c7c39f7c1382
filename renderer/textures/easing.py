"""The smooth step of GLSL, for shapes and textures that are made in numpy."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def ease(x: Floats) -> Floats:
    """Return 0 below 0, 1 above 1 and x^2 (3 - 2 x) between: smoothstep(0, 1, x)."""
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * (3.0 - 2.0 * x))
