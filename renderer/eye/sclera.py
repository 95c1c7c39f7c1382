"""The procedural white of the eye: colour with vessels at two depths, and a subtle normal map.

The maps are azimuthal equidistant projections of the globe about the gaze axis: the texture's
centre is the gaze axis, its edge lies at EDGE_DEG of polar angle, u to the viewer's right and v up
(row 0 is v = 0). A direction (x, y, z) of eye space reads
    uv = 0.5 + 0.5 * (x, y) / hypot(x, y) * acos(z) / radians(EDGE_DEG).
Made for the viewer's left eye, whose nose side lies towards +x; mirrored in u for the right eye.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.cache import cached_arrays
from renderer.eye.scleral_vessels import EDGE_DEG, HALF_SIZE_MM, LIMBUS_ARC_MM, vessel_density
from renderer.textures.noise import Field, noise_grid
from renderer.textures.sizes import (
    check_size,
    normals_from_height,
    pack_albedo,
    pack_range,
    shrink,
    smoothstep,
    unpack_albedo,
    unpack_range,
)

__all__ = [
    "BASE_PX",
    "EDGE_DEG",
    "HALF_SIZE_MM",
    "LIMBUS_ARC_MM",
    "MAX_TILT_DEG",
    "ScleraMaps",
    "bake_sclera",
    "mean_albedo",
    "sclera_maps",
]

BASE_PX: Final = 2048

# Linear Rec. 709; reference/eye-rendering.md, 1.6. The white of an eye is a warm light grey.
WHITE: Final = (0.735, 0.672, 0.628)
YELLOW: Final = (0.71, 0.60, 0.44)  # towards the canthi and where fat lies under the conjunctiva
PINK: Final = (0.68, 0.44, 0.40)  # near the caruncle and in the folds
BLUISH: Final = (0.58, 0.605, 0.63)  # thin sclera: next to the limbus, and in patches
# What a vessel of full density leaves of the light, per channel: blood near the surface, and seen
# through the conjunctiva, where scattering in front of it turns red bluish-pink.
BLOOD: Final = (0.62, 0.13, 0.11)
DEEP_BLOOD: Final = (0.72, 0.47, 0.56)
MAX_TILT_DEG: Final = 5.0
_HEIGHT_RANGE_MM: Final = 0.2


@dataclass(frozen=True)
class ScleraMaps:
    """Maps of the white of one eye, float32, n texels a side.

    ``albedo`` (n, n, 3) linear Rec. 709; ``normal`` (n, n, 3) unit, tangent space of the map: x
    along u, y along v, z out of the globe, tilted by at most MAX_TILT_DEG and flat in the cornea.
    """

    albedo: Field
    normal: Field


def sclera_maps(seed: int, *, size_px: int) -> ScleraMaps:
    """Return the maps with ``size_px`` texels a side, from 1 to 2048, all of the same eye.

    Size 1 has the mean colour of what the lids leave free (the band up to 35 degrees above and
    below, outside the cornea) and is flat. Raises ValueError for an unknown size.
    """
    check_size(size_px, BASE_PX)
    kept = _kept(seed, BASE_PX)
    if size_px == 1:
        flat = np.array([[[0.0, 0.0, 1.0]]], np.float32)
        return ScleraMaps(albedo=kept["mean_albedo"].reshape(1, 1, 3), normal=flat)
    height = shrink(unpack_range(kept["height"], _HEIGHT_RANGE_MM), size_px)
    return ScleraMaps(
        albedo=shrink(unpack_albedo(kept["albedo"]), size_px),
        normal=_limited(normals_from_height(height, 2.0 * HALF_SIZE_MM / size_px)),
    )


def mean_albedo(seed: int) -> Field:
    """Return the mean linear albedo (3,) of the visible white."""
    return np.asarray(sclera_maps(seed, size_px=1).albedo[0, 0])


@lru_cache(maxsize=2)
def _kept(seed: int, size_px: int) -> dict[str, npt.NDArray[Any]]:
    return cached_arrays(f"sclera:{seed}:{size_px}", lambda: bake_sclera(seed, size_px=size_px))


def bake_sclera(seed: int, *, size_px: int) -> dict[str, npt.NDArray[Any]]:
    """Make the white of an eye from nothing, in compact form for the cache."""
    line = ((np.arange(size_px) + 0.5) / size_px * 2.0 - 1.0) * HALF_SIZE_MM
    x = np.broadcast_to(line.astype(np.float32)[None, :], (size_px, size_px))
    y = np.broadcast_to(line.astype(np.float32)[:, None], (size_px, size_px))
    arc = np.sqrt(x * x + y * y)
    front, deep = vessel_density(seed, size_px)
    outside = smoothstep(LIMBUS_ARC_MM - 0.1, LIMBUS_ARC_MM + 0.5, arc)
    front, deep = front * outside, deep * outside
    planes = _base_colour(x, y, arc, seed=seed)
    for part, blood, blood_behind in zip(planes, BLOOD, DEEP_BLOOD, strict=True):
        absorbed = deep * np.float32(math.log(blood_behind)) + front * np.float32(math.log(blood))
        np.multiply(part, np.exp(absorbed), out=part)
    albedo = np.ascontiguousarray(np.moveaxis(np.clip(planes, 0.02, 0.95), 0, -1))
    seen = (arc > LIMBUS_ARC_MM + 0.4) & (arc < 15.0) & (np.abs(y) < 7.2)
    return {
        "albedo": pack_albedo(albedo),
        "height": pack_range(_height_mm(front, outside, seed), _HEIGHT_RANGE_MM),
        "mean_albedo": albedo[seen].mean(axis=0, dtype=np.float64).astype(np.float32),
    }


def _base_colour(x: Field, y: Field, arc: Field, *, seed: int) -> Field:
    """Return the colour without vessels (3, n, n): warm grey, its regions blending softly."""
    n = arc.shape[0]
    broad = noise_grid(n, n, cells=(7.0, 7.0), seed=seed * 8 + 1)
    mottle = noise_grid(n, n, cells=(45.0, 45.0), seed=seed * 8 + 2)
    fine = noise_grid(n, n, cells=(160.0, 160.0), seed=seed * 8 + 3)
    side = np.abs(x) + np.float32(1.1) * broad
    yellow = np.float32(0.72) * smoothstep(7.0, 15.0, side)
    # Fat under the conjunctiva, beside the limbus on both sides.
    yellow += np.float32(0.25) * np.exp(-(((side - 8.3) / 1.1) ** 2) - (y / 1.6) ** 2)
    pink = np.float32(0.75) * smoothstep(11.0, 17.5, x + np.float32(0.7) * broad)
    pink = np.maximum(pink, np.float32(0.55) * smoothstep(14.0, 20.0, arc))
    # Towards the lids the conjunctiva thickens and more blood shows through.
    pink = np.maximum(
        pink, np.float32(0.42) * smoothstep(3.2, 7.5, np.abs(y) + np.float32(0.5) * broad)
    )
    # Capillaries too fine to be drawn one by one flush the conjunctiva in soft-edged patches.
    patches = noise_grid(n, n, cells=(26.0, 26.0), seed=seed * 8 + 6)
    patches += np.float32(0.6) * noise_grid(n, n, cells=(75.0, 75.0), seed=seed * 8 + 7)
    flush = smoothstep(-0.3, 2.2, patches) * smoothstep(LIMBUS_ARC_MM, LIMBUS_ARC_MM + 2.0, arc)
    pink = np.maximum(pink, np.float32(0.44) * flush)
    bluish = np.float32(0.55) * smoothstep(LIMBUS_ARC_MM + 1.5, LIMBUS_ARC_MM - 0.2, arc)
    bluish += np.float32(0.30) * smoothstep(
        0.1, 1.6, noise_grid(n, n, cells=(13.0, 13.0), seed=seed * 8 + 8)
    )
    shade = 1.0 + 0.018 * broad + 0.014 * mottle + 0.008 * fine
    planes = np.empty((3, n, n), np.float32)
    for c in range(3):
        colour = np.full((n, n), WHITE[c], np.float32)
        for share, other in ((yellow, YELLOW), (pink, PINK), (bluish, BLUISH)):
            colour += (np.float32(other[c]) - colour) * share
        # Mottling is mostly yellow against white: it moves blue more than red.
        planes[c] = colour * (1.0 + (0.6 + 0.6 * c) * (shade - 1.0))
    return planes


def _height_mm(front: Field, outside: Field, seed: int) -> Field:
    """Return the surface's unevenness: conjunctiva's folds and vessels that lift it."""
    n = front.shape[0]
    height = 0.012 * noise_grid(n, n, cells=(34.0, 34.0), seed=seed * 8 + 4)
    height += 0.005 * noise_grid(n, n, cells=(80.0, 80.0), seed=seed * 8 + 5)
    texel_mm = 2.0 * HALF_SIZE_MM / n
    bumps = ndimage.gaussian_filter(front, 0.04 / texel_mm, truncate=3.0)
    return np.asarray(0.06 + outside * (height + np.float32(0.010) * bumps), np.float32)


def _limited(normal: Field) -> Field:
    """Bend normals back so that none tilts more than MAX_TILT_DEG, keeping small tilts as are."""
    limit = math.tan(math.radians(MAX_TILT_DEG))
    slope = normal[..., :2] / normal[..., 2:]
    steep = np.sqrt((slope * slope).sum(axis=-1, keepdims=True))
    slope = slope / np.sqrt(np.float32(1.0) + (steep / np.float32(limit)) ** 2)
    length = np.sqrt((slope * slope).sum(axis=-1, keepdims=True) + np.float32(1.0))
    return np.asarray(np.concatenate([slope / length, 1.0 / length], axis=-1), np.float32)
