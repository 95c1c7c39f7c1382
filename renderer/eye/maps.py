"""What one eye's shader reads of its tissue: iris and sclera, their layers and their wet surface.

Bakes come from the cache or are made, and become textures; ``sunlight`` has the light's maps.
"""

from __future__ import annotations

from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye import sclera
from renderer.eye.anatomy import CORNEA_IOR
from renderer.eye.kept import Kept
from renderer.eye.micro_relief import SLOPE_RANGE, TILE_MM, micro_relief_tile
from renderer.eye.sclera import HALF_SIZE_MM, sclera_maps
from renderer.eye.subsurface import subsurface_gain
from renderer.eye.textures import (
    float_texture,
    grey_texture,
    packed_texture,
    srgb_texture,
    tiling_texture,
    with_alpha,
)
from renderer.iris.maps import IRIS_RADIUS_MM, MAP_EDGE_MM, PUPIL_RADIUS_MM
from renderer.iris.source import Iris, iris_of

Array = npt.NDArray[np.float64]
Values = dict[str, Any]

HEIGHT_PX: Final = 512  # 0.023 mm: features that the steps through the relief do not miss
THICKNESS_PX: Final = {"high": 512, "ultra": 1024}  # finer than the nodes of each level's march
MULTIPLE_SHARE: Final = 0.45  # of the reflectance: light scattered more than once, a smooth floor


def iris_values(
    gl: moderngl.Context,
    spec: ClipSpec,
    detail: Detail,
    *,
    sun_eye: Array,
    source: Iris | None = None,
    kept: Kept | None = None,
) -> Values:
    """Return the iris's textures and colours for a LoD; ``sun_eye`` (3,) points towards the sun.

    The iris is the clip's own unless a ``source`` is given. ``kept`` has the textures of eyes
    built before and takes these.
    """
    size = int(detail.setting("texture", "iris_map_px"))
    iris, kept = source or iris_of(spec), kept or Kept()
    return {
        **kept.get(("iris", iris, size), lambda: _iris_textures(gl, iris, size)),
        "u_iris_mean": iris.mean_albedo,
        "u_pupil_mm": spec.pupil_mm,
        **_subsurface_values(gl, iris, detail, sun_eye, kept),
    }


def _iris_textures(gl: moderngl.Context, source: Iris, size_px: int) -> Values:
    maps, height = source.maps(size_px), source.maps(min(size_px, HEIGHT_PX)).height_mm
    highest = max(float(height.max()), 1e-3)
    return {
        "u_iris_albedo": srgb_texture(gl, with_alpha(maps.albedo, maps.cavity)),
        "u_iris_normal": packed_texture(gl, maps.normal),
        "u_iris_height": grey_texture(gl, _filled(height) / highest, mips=False),
        "u_relief_mm": (highest, float(height[_tissue(len(height))].mean())),
    }


def _filled(height_mm: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Raise the pupil to the tissue beside it: in the relief it is a hole, not a cliff."""
    axis = ((np.arange(len(height_mm)) + 0.5) / len(height_mm) * 2 - 1) * MAP_EDGE_MM
    x, y = np.meshgrid(axis, axis)
    outwards = np.maximum((PUPIL_RADIUS_MM + 0.12) / np.maximum(np.hypot(x, y), 1e-6), 1.0)
    texel_mm = 2 * MAP_EDGE_MM / len(height_mm)
    row, column = (((a * outwards + MAP_EDGE_MM) / texel_mm).astype(int) for a in (y, x))
    limit = len(height_mm) - 1
    return np.asarray(height_mm[np.clip(row, 0, limit), np.clip(column, 0, limit)])


def _tissue(size_px: int) -> npt.NDArray[np.bool_]:
    """Mark the texels between the maps' pupil and the root; all of them on a map of one."""
    axis = ((np.arange(size_px) + 0.5) / size_px * 2 - 1) * MAP_EDGE_MM
    radius = np.hypot(*np.meshgrid(axis, axis))
    inside = (radius > PUPIL_RADIUS_MM + 0.1) & (radius < IRIS_RADIUS_MM - 0.1)
    return np.asarray(inside | (size_px == 1))


def sclera_values(
    gl: moderngl.Context, spec: ClipSpec, detail: Detail, *, kept: Kept | None = None
) -> Values:
    """Return the sclera's textures and mean colour for a LoD; ``kept`` as for the iris."""
    seed, kept = spec.iris_seed, kept or Kept()
    diffuse_px = int(detail.setting("sclera", "diffuse_map_px"))
    normal_px = max(int(detail.setting("sclera", "normal_map_px")), 1)
    return {
        "u_sclera_albedo": kept.get(
            ("sclera's colour", seed, diffuse_px),
            lambda: srgb_texture(gl, with_alpha(sclera_maps(seed, size_px=diffuse_px).albedo)),
        ),
        "u_sclera_normal": kept.get(
            ("sclera's normals", seed, normal_px),
            lambda: packed_texture(gl, sclera_maps(seed, size_px=normal_px).normal),
        ),
        "u_sclera_mean": sclera.mean_albedo(seed),
        "u_micro_relief": kept.get("micro relief", lambda: tiling_texture(gl, micro_relief_tile())),
    }


def tissue_constants() -> dict[str, float]:
    """Return the numbers that the shaders need to read these maps."""
    return {
        "SCLERA_HALF_SIZE_MM": HALF_SIZE_MM,
        "RELIEF_TILE_MM": TILE_MM,
        "RELIEF_SLOPE_RANGE": SLOPE_RANGE,
    }


def _subsurface_values(
    gl: moderngl.Context, source: Iris, detail: Detail, sun_eye: Array, kept: Kept
) -> Values:
    """Return the layers, their coefficients and the gain that ties them to the map's colour."""
    is_bent = {detail.refraction, detail.caustics} & {"high", "ultra"}
    across = -sun_eye[:2] / (CORNEA_IOR if is_bent else 1.0)
    size = THICKNESS_PX.get(detail.subsurface, 1)
    mean = source.mean_thickness_mm.astype(np.float64)
    tissue = source.tissue
    return {
        "u_thickness": kept.get(
            ("iris's layers", source, size),
            lambda: float_texture(gl, source.maps(size).thickness_mm),
        ),
        "u_sigma_s": tissue.sigma_s.T,
        "u_sigma_t": tissue.sigma_t.T,
        "u_anisotropy": tissue.anisotropy,
        "u_subsurface_gain": subsurface_gain(
            mean, tissue, light_eye=(float(across[0]), float(across[1]))
        ),
        "u_multiple_share": MULTIPLE_SHARE,
    }
