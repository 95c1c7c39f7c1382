"""Real orthonormal spherical harmonics up to order 2: how ambient light is written down.

The order is that of Ramamoorthi and Hanrahan 2001, eq. 3, as ``shaders/light.glsl`` reads it.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

# Ramamoorthi and Hanrahan 2001, eq. 13: c1 to c5 of the irradiance's polynomial.
_TERMS: Final = np.array(
    [0.886227, *(2 * 0.511664,) * 3, *(2 * 0.429043,) * 2, 0.743125, 2 * 0.429043, 0.429043]
)
_LESS_OF_ONE: Final = 0.247708


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


def irradiance_terms(sh: Array) -> Array:
    """Return the factors (9, 3) of 1, y, z, x, xy, yz, zz, xz and xx - yy of a unit normal.

    Their sum is the irradiance that harmonics (9, 3) of radiance give a surface.
    """
    terms = _TERMS[:, None] * sh
    terms[0] -= _LESS_OF_ONE * np.asarray(sh)[6]
    return terms


def terms_irradiance(terms: Array, normal: Array) -> Array:
    """Return the irradiance (3,) on a surface with a unit normal (3,), as ``light.glsl`` does."""
    x, y, z = normal
    powers = np.array([1.0, y, z, x, x * y, y * z, z * z, x * z, x * x - y * y])
    return np.asarray(np.maximum(powers @ terms, 0.0))


def ambient_uniforms(sh: Array) -> dict[str, Any]:
    """Return what ``light.glsl`` reads of ambient light from its harmonics (9, 3)."""
    terms = irradiance_terms(sh)
    return {
        "u_ambient_sh": sh,
        "u_ambient_terms": terms,
        "u_ahead_irradiance": terms_irradiance(terms, np.array([0.0, 0.0, 1.0])),
    }
