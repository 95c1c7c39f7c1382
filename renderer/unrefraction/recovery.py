"""From a photograph to an iris: the steps in order, and what is refused on the way.

Everything is decided here from the photograph alone; nobody draws or clicks.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.iris.maps import BASE_PX, HEIGHT_RANGE_MM, IRIS_RADIUS_MM, PUPIL_RADIUS_MM
from renderer.textures.sizes import pack_albedo, pack_range
from renderer.unrefraction import visible
from renderer.unrefraction.edges import Edges, find_edges
from renderer.unrefraction.fill import fill_hidden
from renderer.unrefraction.light import (
    Limbus,
    even_light,
    find_limbus,
    lift_veils,
    to_reflectance,
)
from renderer.unrefraction.photograph import Photograph
from renderer.unrefraction.pose import TELECENTRIC_MM, Pose, find_pose
from renderer.unrefraction.refusal import PhotographError
from renderer.unrefraction.search import Candidate, find_candidates
from renderer.unrefraction.texels import Texels, place_texels
from renderer.unrefraction.tissue import (
    build_height,
    build_thickness,
    scattering_of,
    surface_mm,
)

Field = npt.NDArray[np.float32]
Mask = npt.NDArray[np.bool_]
Told = Callable[[str], None]

LEAST_IRIS_PX: Final = 200
WORKING_IRIS_PX: Final = 2400  # finer than the maps' 2048 texels over 12 mm
SEARCHED_PX: Final = 1600
MOST_TILT_DEG: Final = 35.0
LEAST_SCORE: Final = 0.14  # rendered eyes reach 0.27 and more, noise and skin 0.07
RIVAL: Final = 0.6  # of the best score: a second eye
LEAST_SEEN: Final = 0.45
LEAST_PUPIL_RAYS: Final = 0.5
LEAST_LIMBUS_RAYS: Final = 0.28  # two quarters of 50 degrees: lids cover the rest
LEAST_DETAIL: Final = 0.02
UNVEILED_MM: Final = 5.0  # from the axis, on the maps: no limbus veils this from any side
CLIPPED: Final = 0.97
MOST_CLIPPED: Final = 0.12
LEAST_WHITE: Final = 0.03
NEAREST_MM: Final = 60.0


@dataclass(frozen=True)
class Crop:
    """The part of the photograph around the eye: linear, perhaps reduced by a whole factor."""

    pixels: Field
    left: int
    top: int
    factor: int

    def to_photograph(self, points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return points (..., 2) of the crop in the photograph's pixels."""
        return (points + 0.5) * self.factor - 0.5 + [self.left, self.top]


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
    tell("looking for the eye")
    candidate = _one_eye(photograph)
    crop = _crop(photograph, candidate)
    edges = _edges(photograph, crop, candidate)
    tell("fitting the eye")
    if distance_mm is None:
        distance_mm = _distance_mm(photograph, edges, limbus_mm / crop.factor)
    pose = find_pose(edges, turn=candidate.turn, limbus_mm=limbus_mm, distance_mm=distance_mm)
    _check_pose(photograph, edges, pose, crop)
    tell("following the light through the cornea")
    texels = place_texels(pose, BASE_PX)
    colour = _sampled(crop.pixels, texels)
    tell("telling iris from lids and glints")
    limbus, white = find_limbus(colour, texels)
    seen, clipped = _seen(colour, crop, texels, limbus, pose)
    _check_light(photograph, seen, texels, clipped, white)
    tell("taking the light off")
    bare = lift_veils(colour, texels, limbus=limbus, white=white)
    level = even_light(bare, texels, seen=seen, pupil_mm=pose.pupil_mm)
    look, cast = to_reflectance(level, white, is_monochrome=photograph.is_monochrome)
    detail = _detail(look, seen, texels)
    _check_detail(photograph, detail)
    tell("filling what was hidden")
    look = fill_hidden(
        look,
        seen | (texels.radius_mm < PUPIL_RADIUS_MM + 0.05),
        radius_mm=texels.radius_mm,
        angle=texels.angle,
    )
    tell("guessing relief and layers")
    return _assembled(
        look,
        seen,
        texels,
        photograph=photograph,
        pose=pose,
        crop=crop,
        edges=edges,
        numbers={"white_balance_cast": cast, "detail": detail, "clipped": clipped},
    )


def _one_eye(photograph: Photograph) -> Candidate:
    """Return where the photograph's only eye is, in its pixels."""
    step = max(1, math.ceil(max(photograph.pixels.shape[:2]) / SEARCHED_PX))
    small = _reduced(photograph.pixels, step) / np.float32(np.iinfo(photograph.pixels.dtype).max)
    candidates = find_candidates(small.astype(np.float32))
    if not candidates or candidates[0].score < LEAST_SCORE:
        raise PhotographError(
            f"{photograph.name}: no eye found; a sharp photograph of one open eye is accepted, "
            "with pupil, iris and white on both sides"
        )
    best = candidates[0]
    for other in candidates[1:]:
        if other.score > RIVAL * best.score and 0.6 < other.limbus / best.limbus < 1.6:
            places = " and ".join(
                f"({c.x * step:.0f}, {c.y * step:.0f})"
                for c in sorted((best, other), key=lambda c: c.x)
            )
            raise PhotographError(
                f"{photograph.name}: two eyes found, at {places} pixels; crop it to one eye"
            )
    diameter = 2 * best.limbus * step
    if diameter < 0.85 * LEAST_IRIS_PX:
        raise _too_small(photograph, diameter)
    return Candidate(
        x=(best.x + 0.5) * step - 0.5,
        y=(best.y + 0.5) * step - 0.5,
        limbus=best.limbus * step,
        pupil=best.pupil * step,
        turn=best.turn,
        score=best.score,
    )


def _too_small(photograph: Photograph, diameter: float) -> PhotographError:
    return PhotographError(
        f"{photograph.name}: the iris is {diameter:.0f} pixels wide; at least {LEAST_IRIS_PX} are "
        "needed, 1000 or more show its fibres"
    )


def _reduced(pixels: npt.NDArray[Any], factor: int) -> Field:
    """Shrink (h, w, 3) by a whole factor, a box filter, in strips to bound the memory."""
    if factor == 1:
        return pixels.astype(np.float32)
    rows, columns = pixels.shape[0] // factor, pixels.shape[1] // factor
    reduced = np.empty((rows, columns, 3), np.float32)
    for row in range(rows):
        strip = pixels[row * factor : (row + 1) * factor, : columns * factor]
        reduced[row] = strip.reshape(factor, columns, factor, 3).mean(axis=(0, 2), dtype=np.float32)
    return reduced


def _crop(photograph: Photograph, eye: Candidate) -> Crop:
    factor = max(1, int(2 * eye.limbus // WORKING_IRIS_PX))
    reach = 1.45 * eye.limbus
    height, width = photograph.pixels.shape[:2]
    left, top = max(0, int(eye.x - reach)), max(0, int(eye.y - reach))
    right, bottom = min(width, int(eye.x + reach)), min(height, int(eye.y + reach))
    linear = photograph.linear((left, top, right, bottom))
    return Crop(_reduced(linear, factor), left, top, factor)


def _edges(photograph: Photograph, crop: Crop, eye: Candidate) -> Edges:
    start = Candidate(
        x=(eye.x - crop.left + 0.5) / crop.factor - 0.5,
        y=(eye.y - crop.top + 0.5) / crop.factor - 0.5,
        limbus=eye.limbus / crop.factor,
        pupil=eye.pupil / crop.factor,
        turn=eye.turn,
        score=eye.score,
    )
    red = 0.6 * crop.pixels[..., 0] + 0.4 * crop.pixels[..., 1]
    edges = find_edges(crop.pixels.max(axis=-1), red, start)
    if edges is None:
        raise PhotographError(
            f"{photograph.name}: something like an eye at ({eye.x:.0f}, {eye.y:.0f}) pixels, but "
            "no round edge of pupil and iris; a sharp photograph of one open eye is accepted"
        )
    return edges


def _distance_mm(photograph: Photograph, edges: Edges, limbus_mm: float) -> float:
    """Return how far the camera was, from its focal length; ``limbus_mm`` per crop's reduction."""
    if photograph.focal_px is None:
        return TELECENTRIC_MM
    px_per_mm = 2 * edges.limbus.ellipse.major / limbus_mm
    return max(photograph.focal_px / px_per_mm, NEAREST_MM)


def _check_pose(photograph: Photograph, edges: Edges, pose: Pose, crop: Crop) -> None:
    diameter = 2 * edges.limbus.ellipse.major * crop.factor
    if diameter < LEAST_IRIS_PX:
        raise _too_small(photograph, diameter)
    if pose.tilt_deg > MOST_TILT_DEG:
        raise PhotographError(
            f"{photograph.name}: the eye looks {pose.tilt_deg:.0f} degrees past the camera; "
            f"at most {MOST_TILT_DEG:.0f} are accepted: look into the lens"
        )
    if edges.pupil.share < LEAST_PUPIL_RAYS or edges.limbus.share < LEAST_LIMBUS_RAYS:
        raise PhotographError(
            f"{photograph.name}: {edges.limbus.share:.0%} of the iris's edge and "
            f"{edges.pupil.share:.0%} of the pupil's are seen; {LEAST_LIMBUS_RAYS:.0%} and "
            f"{LEAST_PUPIL_RAYS:.0%} are needed: open the eye wide and keep lashes out of the way"
        )


def _sampled(pixels: Field, texels: Texels) -> Field:
    """Return the crop's linear colours at every texel, cubic."""
    at = [texels.y_px, texels.x_px]
    parts = [
        ndimage.map_coordinates(pixels[..., c], at, order=3, mode="nearest", output=np.float32)
        for c in range(3)
    ]
    return np.maximum(np.stack(parts, axis=-1), 0.0)


def _seen(
    colour: Field, crop: Crop, texels: Texels, limbus: Limbus, pose: Pose
) -> tuple[Mask, float]:
    """Return which texels show the iris's own tissue, and the share of it that is burnt out."""
    n = colour.shape[0]
    step = n // visible.GRID_PX
    coarse = colour.reshape(visible.GRID_PX, step, visible.GRID_PX, step, 3).mean(axis=(1, 3))
    sparse = place_texels(pose, visible.GRID_PX)
    lids = visible.find_lids(coarse, sparse, clear=limbus.clear(sparse.surface_mm))
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
        & (limbus.clear(texels.surface_mm) > visible.LIMBUS_CLEAR)
    )
    tissue = (texels.radius_mm > PUPIL_RADIUS_MM + 0.15) & (texels.radius_mm < UNVEILED_MM)
    burnt = colour.min(axis=-1) > CLIPPED
    clipped = float(burnt[tissue & open_part].mean()) if (tissue & open_part).any() else 1.0
    hair = visible.find_lashes(colour, 12.0 / n) & (texels.radius_mm > PUPIL_RADIUS_MM + 0.4)
    return open_part & ~glints[row, column] & ~hair, clipped


def _check_light(
    photograph: Photograph, seen: Mask, texels: Texels, clipped: float, white: Field
) -> None:
    tissue = (texels.radius_mm > PUPIL_RADIUS_MM) & (texels.radius_mm < UNVEILED_MM)
    share = float(seen[tissue].mean())
    if clipped > MOST_CLIPPED or float(white.min()) > 0.995:
        raise PhotographError(
            f"{photograph.name}: over-exposed, {clipped:.0%} of the iris and its brightest white "
            f"{float(white.min()):.0%} bright; expose so that the white of the eye keeps its shades"
        )
    if float(white.max()) < LEAST_WHITE:
        raise PhotographError(
            f"{photograph.name}: under-exposed, the white of the eye has {float(white.max()):.1%} "
            f"of full brightness; at least {LEAST_WHITE:.0%} is needed"
        )
    if share < LEAST_SEEN:
        raise PhotographError(
            f"{photograph.name}: {share:.0%} of the iris is seen, lids, lashes and reflections "
            f"hide the rest; at least {LEAST_SEEN:.0%} is needed"
        )


def _detail(look: Field, seen: Mask, texels: Texels) -> float:
    """Return how much the iris's brightness varies at the size of its fibres, 0.05 to 0.3 mm."""
    light = np.log(np.maximum(look.mean(axis=-1), 2e-3))[::2, ::2]
    band = ndimage.gaussian_filter(light, 2.5) - ndimage.gaussian_filter(light, 10.0)
    ring = (seen & (texels.radius_mm > 2.5) & (texels.radius_mm < 4.8))[::2, ::2]
    return float(band[ring].std()) if ring.any() else 0.0


def _check_detail(photograph: Photograph, detail: float) -> None:
    if detail < LEAST_DETAIL:
        raise PhotographError(
            f"{photograph.name}: blurred, the iris's fibres vary by {detail:.1%} where sharp "
            f"photographs show 5 % and more; at least {LEAST_DETAIL:.0%} is needed"
        )


def _assembled(
    look: Field,
    seen: Mask,
    texels: Texels,
    *,
    photograph: Photograph,
    pose: Pose,
    crop: Crop,
    edges: Edges,
    numbers: dict[str, float],
) -> Recovery:
    """Split the look into colour, relief and layers, and write down what was found."""
    r = texels.radius_mm
    look = _with_pupil(look, r)
    height, cavity = build_height(look, r)
    # Cavities are dark in the photograph already: their shade is taken out of the colour, because
    # whoever draws the maps puts it back.
    albedo = np.clip(look / np.maximum(cavity, 0.35)[..., None], 0.0015, 0.95).astype(np.float32)
    thickness = build_thickness(albedo, height, r)
    tissue = (r > PUPIL_RADIUS_MM + 0.1) & (r < IRIS_RADIUS_MM)
    n = thickness.shape[0]
    coarse = tissue.reshape(n, BASE_PX // n, n, BASE_PX // n)[:, 0, :, 0]
    mean = albedo[tissue].mean(axis=0, dtype=np.float64).astype(np.float32)
    layers = scattering_of(mean)
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
    ring = (r > PUPIL_RADIUS_MM) & (r < IRIS_RADIUS_MM)
    share = float(seen[ring & (r < UNVEILED_MM)].mean())
    found = _found(photograph, pose, crop, edges, share) | numbers
    found["mean_albedo"] = [round(float(v), 4) for v in mean]
    return Recovery(arrays, albedo, relief, cavity, seen & ring, pose, crop, found)


def _with_pupil(look: Field, radius_mm: Field) -> Field:
    """Blacken the pupil: what it showed were reflections."""
    share = np.clip((radius_mm - PUPIL_RADIUS_MM + 0.03) / 0.06, 0.0, 1.0)[..., None]
    return np.asarray(0.003 + (look - 0.003) * share, np.float32)


def _found(
    photograph: Photograph, pose: Pose, crop: Crop, edges: Edges, share: float
) -> dict[str, Any]:
    warnings = list(photograph.notes)
    if pose.distance_mm > 0.5 * TELECENTRIC_MM:
        warnings.append("no focal length in the file: taken from far away (--focal, --distance)")
    if share < 0.75:
        warnings.append(f"{1 - share:.0%} of the iris was hidden and is invented")
    px = pose.px_per_mm * crop.factor
    if px * 11.7 < 700:
        warnings.append(f"the iris is {px * 11.7:.0f} pixels wide: too coarse for single fibres")
    ellipses = {}
    for name, edge in (("limbus", edges.limbus), ("pupil", edges.pupil)):
        centre = crop.to_photograph(np.array([edge.ellipse.x, edge.ellipse.y]))
        ellipses[name] = {
            "x_px": round(float(centre[0]), 2),
            "y_px": round(float(centre[1]), 2),
            "major_px": round(edge.ellipse.major * crop.factor, 2),
            "minor_px": round(edge.ellipse.minor * crop.factor, 2),
            "angle_deg": round(math.degrees(edge.ellipse.angle), 1),
            "rays": round(edge.share, 3),
        }
    return {
        "photograph": photograph.name,
        "size_px": [photograph.pixels.shape[1], photograph.pixels.shape[0]],
        "ellipses": ellipses,
        "px_per_mm": round(px, 3),
        "pupil_apparent_mm": round(2 * edges.pupil.ellipse.radius / pose.px_per_mm, 3),
        "pupil_true_mm": round(2 * pose.pupil_mm, 3),
        "pupil_decentre_mm": [round(pose.pupil_x_mm, 3), round(pose.pupil_y_mm, 3)],
        "gaze_yaw_deg": round(math.degrees(pose.yaw), 2),
        "gaze_pitch_deg": round(math.degrees(pose.pitch), 2),
        "tilt_deg": round(pose.tilt_deg, 2),
        "roll_deg": round(math.degrees(pose.roll), 2),
        "distance_mm": round(pose.distance_mm, 1),
        "iris_seen": round(share, 3),
        "warnings": warnings,
    }
