"""The procedural iris: all maps of one iris from a seed and a colour family.

The maps cover a square of 12 mm (MAP_EDGE_MM = 6.0 from the centre to each edge: the iris's radius
of 5.85 mm and a margin of 0.15 mm) on the iris plane, centred on the pupil, for a pupil of 2.0 mm
radius. uv = 0.5 + x_mm / 12; row 0 is the lower edge (v = 0). Made for the viewer's left eye and
mirrored in u for the right one.

For another pupil the tissue stretches evenly between its edge and the root (Pamplona et al. 2009).
A point at radius r of an iris with pupil radius r_p reads the maps at
    r_map = r * 2.0 / r_p                                         inside the pupil,
    r_map = 2.0 + (r - r_p) * (5.85 - 2.0) / (5.85 - r_p)         outside.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from renderer.cache import cached_arrays
from renderer.iris.albedo import build_albedo, core_share
from renderer.iris.layers import build_melanin, build_thickness, scattering
from renderer.iris.layout import IRIS_RADIUS_MM, PUPIL_RADIUS_MM, plan_iris
from renderer.iris.pigment import family
from renderer.iris.plane import HALF_SIZE_MM, enlarge, iris_plane
from renderer.iris.relief import build_relief
from renderer.textures.noise import Field
from renderer.textures.sizes import (
    check_size,
    normals_from_height,
    pack_albedo,
    pack_range,
    shrink,
    unpack_albedo,
    unpack_range,
)

__all__ = [
    "BASE_PX",
    "HEIGHT_RANGE_MM",
    "IRIS_RADIUS_MM",
    "MAP_EDGE_MM",
    "PUPIL_RADIUS_MM",
    "IrisMaps",
    "bake_iris",
    "iris_maps",
    "mean_albedo",
    "mean_thickness_mm",
    "scattering",
    "sized_maps",
]

BASE_PX: Final = 2048
MAP_EDGE_MM: Final = HALF_SIZE_MM
HEIGHT_RANGE_MM: Final = 0.6


@dataclass(frozen=True)
class IrisMaps:
    """The maps of one iris, float32, n texels a side.

    ``albedo`` (n, n, 3) linear Rec. 709 diffuse reflectance; ``normal`` (n, n, 3) unit, tangent
    space, x right, y up, z to the viewer; ``height_mm`` (n, n) relief above the iris's lowest
    point; ``thickness_mm`` (n, n, 4) border layer, front stroma, back stroma, pigment epithelium,
    without features below 0.2 mm; ``cavity`` (n, n) ambient occlusion, 1 open and 0 closed.
    """

    albedo: Field
    normal: Field
    height_mm: Field
    thickness_mm: Field
    cavity: Field


def iris_maps(seed: int, colour: str, *, size_px: int, base_px: int | None = None) -> IrisMaps:
    """Return the maps of an iris with ``size_px`` texels a side, from 1 to ``base_px``.

    Every size is a box filter in linear light of the same iris, baked once at ``base_px`` (BASE_PX
    unless said) and cached: a small base is baked much faster, for eyes that are never seen large.
    Size 1 has the mean of the tissue between pupil and root, lying flat. Raises ValueError for an
    unknown colour or size.
    """
    family(colour)
    base_px = base_px or BASE_PX
    check_size(size_px, base_px)
    return sized_maps(_kept(seed, colour, base_px), size_px)


def sized_maps(kept: dict[str, npt.NDArray[Any]], size_px: int) -> IrisMaps:
    """Return a bake's maps at a size: those of ``bake_iris`` or of an iris file."""
    check_size(size_px, BASE_PX)
    return _mean_maps(kept) if size_px == 1 else _sized(kept, size_px)


def mean_albedo(seed: int, colour: str) -> Field:
    """Return the mean linear albedo (3,) of the tissue between pupil and root."""
    return np.asarray(iris_maps(seed, colour, size_px=1).albedo[0, 0])


def mean_thickness_mm(seed: int, colour: str) -> Field:
    """Return the mean thickness (4,) in mm of the layers between pupil and root."""
    return np.asarray(iris_maps(seed, colour, size_px=1).thickness_mm[0, 0])


def bake_iris(seed: int, colour: str, *, size_px: int) -> dict[str, npt.NDArray[Any]]:
    """Make an iris from nothing, at a size that 4 divides, in compact form for the cache."""
    look = family(colour)
    layout = plan_iris(seed, freckle_rate=look.freckles, crypt_rate=look.crypts)
    plane = iris_plane(layout, size_px)
    relief = build_relief(plane, layout, seed, veil=look.veil)
    albedo = build_albedo(plane, relief, layout, look, seed)
    melanin = build_melanin(relief, core_share(plane, relief, look, seed), look)
    thickness = build_thickness(plane, relief, albedo, melanin)
    tissue = (plane.radius_mm > PUPIL_RADIUS_MM + 0.1) & (plane.radius_mm < IRIS_RADIUS_MM)
    coarse = tissue[2::4, 2::4]
    return {
        "albedo": pack_albedo(albedo),
        "height": pack_range(relief.height_mm, HEIGHT_RANGE_MM),
        "cavity": np.rint(relief.cavity * 255.0).astype(np.uint8),
        "thickness": thickness,
        "mean_albedo": albedo[tissue].mean(axis=0, dtype=np.float64).astype(np.float32),
        "mean_thickness": thickness[coarse].mean(axis=0, dtype=np.float64).astype(np.float32),
    }


@lru_cache(maxsize=2)
def _kept(seed: int, colour: str, size_px: int) -> dict[str, npt.NDArray[Any]]:
    return cached_arrays(
        f"iris:{seed}:{colour}:{size_px}", lambda: bake_iris(seed, colour, size_px=size_px)
    )


def _sized(kept: dict[str, npt.NDArray[Any]], size_px: int) -> IrisMaps:
    height = shrink(unpack_range(kept["height"], HEIGHT_RANGE_MM), size_px)
    thickness = kept["thickness"]
    if size_px > thickness.shape[0]:
        layers = [enlarge(thickness[..., k], size_px) for k in range(4)]
        thickness = np.stack(layers, axis=-1)
    else:
        thickness = shrink(thickness, size_px)
    return IrisMaps(
        albedo=shrink(unpack_albedo(kept["albedo"]), size_px),
        normal=normals_from_height(height, 2.0 * MAP_EDGE_MM / size_px),
        height_mm=height,
        thickness_mm=thickness,
        cavity=shrink(kept["cavity"].astype(np.float32) * np.float32(1.0 / 255.0), size_px),
    )


def _mean_maps(kept: dict[str, npt.NDArray[Any]]) -> IrisMaps:
    return IrisMaps(
        albedo=kept["mean_albedo"].reshape(1, 1, 3),
        normal=np.array([[[0.0, 0.0, 1.0]]], np.float32),
        height_mm=np.zeros((1, 1), np.float32),
        thickness_mm=kept["mean_thickness"].reshape(1, 1, 4),
        cavity=np.ones((1, 1), np.float32),
    )
