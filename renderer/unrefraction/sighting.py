"""Find the one eye of a photograph, its edges and how it stands before the camera.

What shows no eye, two eyes, too small or too oblique an eye is refused here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from renderer.unrefraction.edges import Edges, find_edges
from renderer.unrefraction.photograph import Photograph
from renderer.unrefraction.pose import TELECENTRIC_MM, Pose
from renderer.unrefraction.pose_fit import find_pose
from renderer.unrefraction.refusal import PhotographError
from renderer.unrefraction.search import Candidate, find_candidates

Field = npt.NDArray[np.float32]
Told = Callable[[str], None]

LEAST_IRIS_PX: Final = 200
WORKING_IRIS_PX: Final = 2400  # finer than the maps' 2048 texels over 12 mm
SEARCHED_PX: Final = 1600
MOST_TILT_DEG: Final = 35.0
LEAST_SCORE: Final = 0.14  # rendered eyes reach 0.27 and more, noise and skin 0.07
RIVAL: Final = 0.6  # of the best score: a second eye
LEAST_PUPIL_RAYS: Final = 0.5
LEAST_LIMBUS_RAYS: Final = 0.28  # two quarters of 50 degrees: lids cover the rest
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
class Sighting:
    """An eye that was found: the photograph's part around it, its edges, its pose."""

    crop: Crop
    edges: Edges
    pose: Pose


def see_eye(
    photograph: Photograph,
    *,
    limbus_mm: float = 11.7,
    distance_mm: float | None = None,
    tell: Told = lambda _step: None,
) -> Sighting:
    """Find the eye; see ``recovery.recover_iris`` for the arguments.

    Raises PhotographError where there is not exactly one eye, or one that cannot be used.
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
    return Sighting(crop, edges, pose)


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
