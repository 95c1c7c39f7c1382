"""Pictures of everything around: where a texel of a latitude-longitude picture looks. Pure numpy.

The OpenEXR library's convention: row 0 is the zenith, the middle column looks along +z, columns
left of it towards +x. So the picture reads rightly from within. In world space the middle lies
before the face, where the camera comes from, and its left half to the viewer's right.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from renderer.light import Vector
from renderer.spherical_harmonics import sh_basis

Radiance = npt.NDArray[np.float32]


def lat_long_directions(height: int, width: int, *, turn_deg: float = 0.0) -> Vector:
    """Return the unit directions (height, width, 3) of a picture's texels in world space.

    ``turn_deg`` turns the picture to the viewer's right.
    """
    elevation = math.pi * (0.5 - (np.arange(height) + 0.5) / height)[:, None]
    azimuth = 2 * math.pi * (0.5 - (np.arange(width) + 0.5) / width)[None, :]
    azimuth = azimuth + math.radians(turn_deg)
    level = np.cos(elevation)
    return np.stack(
        [
            np.sin(azimuth) * level,
            np.broadcast_to(np.sin(elevation), (height, width)),
            np.cos(azimuth) * level,
        ],
        axis=-1,
    )


def solid_angles(height: int, width: int) -> Vector:
    """Return the solid angle (height, 1) in sr of a texel of each row; all sum up to 4 pi."""
    edges = np.sin(math.pi * (0.5 - np.arange(height + 1) / height))
    return np.asarray((edges[:-1] - edges[1:])[:, None] * (2 * math.pi / width))


def sh_of_lat_long(radiance: npt.NDArray[np.floating], *, turn_deg: float = 0.0) -> Vector:
    """Project a picture (height, width, 3) on the first nine spherical harmonics, (9, 3)."""
    height, width = radiance.shape[:2]
    weight = solid_angles(height, width)
    total = np.zeros((9, 3))
    rows = 64  # at a time: bounds the memory
    directions = lat_long_directions(height, width, turn_deg=turn_deg)
    for first in range(0, height, rows):
        part = slice(first, first + rows)
        basis = sh_basis(directions[part]) * weight[part, :, None]
        total += np.einsum("ijk,ijc->kc", basis, radiance[part].astype(float))
    return total
