"""From a photograph to an iris: the steps in order.

Everything is decided from the photograph alone; nobody draws or clicks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from renderer.iris.maps import BASE_PX, HEIGHT_RANGE_MM, IRIS_RADIUS_MM, PUPIL_RADIUS_MM
from renderer.textures.sizes import pack_albedo, pack_range
from renderer.unrefraction import visible
from renderer.unrefraction.fill import fill_hidden
from renderer.unrefraction.found import describe
from renderer.unrefraction.light import even_light, lift_veils, to_reflectance
from renderer.unrefraction.limbus import Limbus
from renderer.unrefraction.limbus_fit import find_limbus
from renderer.unrefraction.photograph import Photograph
from renderer.unrefraction.pose import Pose
from renderer.unrefraction.quality import (
    CLIPPED,
    UNVEILED_MM,
    check_detail,
    check_light,
    detail_of,
)
from renderer.unrefraction.scale import on_scale
from renderer.unrefraction.sighting import Crop, Sighting, Told, see_eye
from renderer.unrefraction.texels import Texels, place_texels, sample
from renderer.unrefraction.tissue import (
    build_height,
    surface_mm,
    unshaded,
)

Field = npt.NDArray[np.float32]
Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Recovery:
    """An iris and how it was come by.

    ``arrays`` are what an iris file holds (renderer.iris.file); ``albedo`` (2048, 2048, 3) linear,
    ``seen`` marks the texels that the photograph showed; ``found`` is plain JSON.
    """

    arrays: dict[str, npt.NDArray[Any]]
    albedo: Field
    height_mm: Field
    cavity: Field
    seen: Mask
    pose: Pose
    crop: Crop
    found: dict[str, Any]

    @property
    def gaze_deg(self) -> tuple[float, float]:
        """The gaze's yaw and pitch that shows a drawn eye as the photograph did."""
        return math.degrees(self.pose.yaw), math.degrees(self.pose.pitch)


def recover_iris(
    photograph: Photograph,
    *,
    limbus_mm: float = 11.7,
    distance_mm: float | None = None,
    tell: Told = lambda _step: None,
) -> Recovery:
    """Take the iris out of a photograph of one eye.

    ``limbus_mm`` is the visible iris's width; ``distance_mm`` the camera's distance, else it
    follows from the focal length, else the camera is far away. ``tell`` hears of every step.
    Raises PhotographError for a photograph that shows no iris well enough.
    """
    sighting = on_scale(
        see_eye(photograph, limbus_mm=limbus_mm, distance_mm=distance_mm, tell=tell)
    )
    pose, crop = sighting.pose, sighting.crop
    tell("following the light through the cornea")
    texels = place_texels(pose, BASE_PX)
    colour = sample(crop.pixels, texels)
    tell("telling iris from lids and glints")
    limbus, white = find_limbus(colour, texels)
    seen, clipped = _seen(colour, crop, texels, limbus, pose)
    check_light(photograph, seen, texels, clipped, white)
    tell("taking the light off")
    bare = lift_veils(colour, texels, limbus=limbus, white=white)
    level = even_light(bare, texels, seen=seen, pupil_mm=pose.pupil_mm)
    look, cast = to_reflectance(level, white, is_monochrome=photograph.is_monochrome)
    detail = detail_of(look, seen, texels)
    check_detail(photograph, detail)
    tell("filling what was hidden")
    look = fill_hidden(
        look,
        seen | (texels.radius_mm < PUPIL_RADIUS_MM + 0.05),
        radius_mm=texels.radius_mm,
        angle=texels.angle,
    )
    tell("guessing relief and layers")
    numbers = {"white_balance_cast": cast, "detail": detail, "clipped": clipped}
    share = float(seen[_ring(texels, UNVEILED_MM)].mean())
    found = describe(photograph, sighting, share=share) | numbers
    return _assembled(look, seen, texels, sighting=sighting, found=found)


def _ring(texels: Texels, outer_mm: float) -> Mask:
    """Mark the tissue from the pupil to a radius on the maps."""
    return np.asarray((texels.radius_mm > PUPIL_RADIUS_MM + 0.1) & (texels.radius_mm < outer_mm))


def _seen(
    colour: Field, crop: Crop, texels: Texels, limbus: Limbus, pose: Pose
) -> tuple[Mask, float]:
    """Return which texels show the iris's own tissue, and the share of it that is burnt out."""
    n = colour.shape[0]
    step = n // visible.GRID_PX
    coarse = colour.reshape(visible.GRID_PX, step, visible.GRID_PX, step, 3).mean(axis=(1, 3))
    sparse = place_texels(pose, visible.GRID_PX)
    lids = visible.find_lids(coarse, sparse, clear=limbus.clear(sparse.surface_mm, sparse.bearing))
    height, width = crop.pixels.shape[:2]
    inside = (
        (texels.x_px > 1)
        & (texels.y_px > 1)
        & (texels.x_px < width - 2)
        & (texels.y_px < height - 2)
    )
    glints = visible.find_glints(crop.pixels, px_per_mm=pose.px_per_mm)
    row = np.clip(np.rint(texels.y_px), 0, height - 1).astype(np.intp)
    column = np.clip(np.rint(texels.x_px), 0, width - 1).astype(np.intp)
    open_part = (
        inside
        & visible.between_lids(lids, n)
        & (limbus.clear(texels.surface_mm, texels.bearing) > visible.LIMBUS_CLEAR)
    )
    tissue = (texels.radius_mm > PUPIL_RADIUS_MM + 0.15) & (texels.radius_mm < UNVEILED_MM)
    burnt = colour.min(axis=-1) > CLIPPED
    clipped = float(burnt[tissue & open_part].mean()) if (tissue & open_part).any() else 1.0
    hair = visible.find_lashes(colour, 12.0 / n) & (texels.radius_mm > PUPIL_RADIUS_MM + 0.4)
    return open_part & ~glints[row, column] & ~hair, clipped


def _assembled(
    look: Field,
    seen: Mask,
    texels: Texels,
    *,
    sighting: Sighting,
    found: dict[str, Any],
) -> Recovery:
    """Split the look into colour, relief and layers."""
    r = texels.radius_mm
    look = _with_pupil(look, r)
    height, cavity = build_height(look, r)
    albedo, thickness, layers = unshaded(look, height, cavity, r)
    tissue = _ring(texels, IRIS_RADIUS_MM)
    n = thickness.shape[0]
    coarse = tissue.reshape(n, BASE_PX // n, n, BASE_PX // n)[:, 0, :, 0]
    mean = albedo[tissue].mean(axis=0, dtype=np.float64).astype(np.float32)
    relief = surface_mm(height)
    arrays: dict[str, npt.NDArray[Any]] = {
        "albedo": pack_albedo(albedo),
        "height": pack_range(relief, HEIGHT_RANGE_MM),
        "cavity": np.rint(cavity * 255.0).astype(np.uint8),
        "thickness": thickness,
        "mean_albedo": mean,
        "mean_thickness": thickness[coarse].mean(axis=0, dtype=np.float64).astype(np.float32),
        "sigma_s": layers.sigma_s,
        "sigma_t": layers.sigma_t,
        "anisotropy": layers.anisotropy,
    }
    found = found | {"mean_albedo": [round(float(v), 4) for v in mean]}
    return Recovery(
        arrays, albedo, relief, cavity, seen & tissue, sighting.pose, sighting.crop, found
    )


def _with_pupil(look: Field, radius_mm: Field) -> Field:
    """Blacken the pupil: what it showed were reflections."""
    share = np.clip((radius_mm - PUPIL_RADIUS_MM + 0.03) / 0.06, 0.0, 1.0)[..., None]
    return np.asarray(0.003 + (look - 0.003) * share, np.float32)
