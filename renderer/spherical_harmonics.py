"""Real orthonormal spherical harmonics up to order 2: how ambient light is written down.

The order is that of Ramamoorthi and Hanrahan 2001, eq. 3, as ``shaders/light.glsl`` reads it.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def sh_basis(directions: Array) -> Array:
    """Return the nine harmonics at unit ``directions`` (..., 3), as (..., 9)."""
    x, y, z = np.moveaxis(directions, -1, 0)
    return np.stack(
        [
            0.282095 * np.ones_like(x),
            0.488603 * y,
            0.488603 * z,
            0.488603 * x,
            1.092548 * x * y,
            1.092548 * y * z,
            0.315392 * (3 * z * z - 1),
            1.092548 * x * z,
            0.546274 * (x * x - y * y),
        ],
        axis=-1,
    )
