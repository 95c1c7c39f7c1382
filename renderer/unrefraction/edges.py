"""The edges of pupil and limbus to a fraction of a pixel, on rays from the eye's middle.

Works on one channel of linear light. The limbus is where the light crosses half of the step between
its two sides: a picture's blur moves such a crossing less than it moves the steepest point. The
pupil's edge is lined by the ruff, nearly black in every eye, and begins where the light has risen
by a small share of the sclera's: a share of the step itself lies further out in darker irises.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.unrefraction.ellipse import Ellipse, robust_ellipse
from renderer.unrefraction.search import Candidate
from renderer.unrefraction.softness import LEVELS, Softness, find_softness

Array = npt.NDArray[np.float64]
Picture = npt.NDArray[np.float32]

RAYS: Final = 240
STEPS: Final = 320  # samples along a ray
PUPIL_LEVEL: Final = 0.1  # of the step, for the first look, before the sclera is known
RUFF_LEVEL: Final = 0.006  # of the sclera's light: found within 0.005 mm in irises of every colour
LIMBUS_LEVEL: Final = 0.5  # half of the light comes from the sclera
SIDE: Final = 0.5  # |sin| of the rays that meet sclera, not lids
PUPIL_TOLERANCE: Final = 0.035  # of the pupil's radius: the ruff is scalloped
LIMBUS_TOLERANCE: Final = 0.02  # of the iris's radius


@dataclass(frozen=True)
class Edge:
    """Points (n, 2) in pixels on one edge, the ellipse through them, the share of rays with one."""

    points: Array
    ellipse: Ellipse
    share: float


@dataclass(frozen=True)
class Edges:
    """Pupil and limbus of one eye, and where the limbus is soft, if enough of it is seen."""

    pupil: Edge
    limbus: Edge
    softness: Softness | None = None


def find_edges(value: Picture, red: Picture, start: Candidate) -> Edges | None:
    """Refine a candidate in linear pictures (height, width); None where no two edges are found.

    ``value`` shows the pupil best (the strongest channel), ``red`` the limbus (sclera is warmer
    than most irises).
    """
    pupil_near = partial(_edge_near, value, level=PUPIL_LEVEL, tolerance=PUPIL_TOLERANCE)
    limbus_near = partial(_edge_near, red, level=LIMBUS_LEVEL)
    pupil = pupil_near((start.x, start.y), start.pupil, reach=(0.5, 1.7))
    if pupil is None:
        return None
    middle = (pupil.ellipse.x, pupil.ellipse.y)
    pupil = pupil_near(middle, pupil.ellipse.radius, reach=(0.7, 1.35))
    limbus = limbus_near(middle, start.limbus, reach=(0.72, 1.3), tolerance=2.5 * LIMBUS_TOLERANCE)
    if pupil is None or limbus is None:
        return None
    middle = (limbus.ellipse.x, limbus.ellipse.y)
    limbus = limbus_near(
        middle, limbus.ellipse.radius, reach=(0.82, 1.2), tolerance=LIMBUS_TOLERANCE
    )
    if limbus is None:
        return None
    middle = (pupil.ellipse.x, pupil.ellipse.y)
    ruff = pupil_near(
        middle,
        pupil.ellipse.radius,
        reach=(0.7, 1.35),
        rise=RUFF_LEVEL * _sclera_light(value, limbus.ellipse),
    )
    return Edges(ruff or pupil, limbus, _softness(red, limbus.ellipse))


def _softness(red: Picture, limbus: Ellipse) -> Softness | None:
    inner, outer = (
        edge_points(red, (limbus.x, limbus.y), limbus.radius, reach=(0.82, 1.2), level=level)
        for level in LEVELS
    )
    tolerance = LIMBUS_TOLERANCE * limbus.radius
    return find_softness(inner, outer, limbus, rays=RAYS, tolerance=tolerance)


def _sclera_light(picture: Picture, limbus: Ellipse) -> float:
    """Return the sclera's brightness to both sides of the limbus."""
    points = limbus.points(RAYS)
    points = points[np.abs(points[:, 1] - limbus.y) < SIDE * limbus.radius]
    out = [limbus.x, limbus.y] + 1.1 * (points - [limbus.x, limbus.y])
    return float(np.median(ndimage.map_coordinates(picture, out.T[::-1], order=1, mode="nearest")))


def _edge_near(
    picture: Picture,
    middle: tuple[float, float],
    radius: float,
    *,
    reach: tuple[float, float],
    level: float,
    tolerance: float,
    rise: float | None = None,
) -> Edge | None:
    points = edge_points(picture, middle, radius, reach=reach, level=level, rise=rise)
    fitted = robust_ellipse(points, tolerance=tolerance * radius)
    if fitted is None:
        return None
    ellipse, support = fitted
    if not 0.6 * radius < ellipse.radius < 1.7 * radius:
        return None
    return Edge(points[support], ellipse, float(support.sum()) / RAYS)


def edge_points(
    picture: Picture,
    middle: tuple[float, float],
    radius: float,
    *,
    reach: tuple[float, float],
    level: float,
    rise: float | None = None,
) -> Array:
    """Return the points (n, 2) where rays cross from dark to bright, at most one per ray.

    ``reach`` is the searched part of each ray in shares of ``radius``. The edge lies where the
    share ``level`` of the step is climbed, or the brightness ``rise`` if that is given.
    """
    share = np.linspace(*reach, STEPS)
    angle = np.arange(RAYS) / RAYS * 2 * np.pi
    x = middle[0] + radius * np.outer(np.cos(angle), share)
    y = middle[1] + radius * np.outer(np.sin(angle), share)
    height, width = picture.shape
    outside = (x < 0) | (x > width - 1) | (y < 0) | (y > height - 1)
    polar = ndimage.map_coordinates(picture, [y, x], order=1, mode="nearest")
    polar = ndimage.gaussian_filter1d(polar, 1.0, axis=0, mode="wrap")
    at = _crossings(polar, per_step=(reach[1] - reach[0]) / STEPS, level=level, rise=rise)
    found = np.isfinite(at)
    column = np.where(found, at, 0.0)
    found &= ~outside[np.arange(RAYS), np.rint(column).astype(np.intp)]
    r = radius * np.interp(column, np.arange(STEPS), share)
    points = np.stack([middle[0] + r * np.cos(angle), middle[1] + r * np.sin(angle)], axis=1)
    return np.asarray(points[found])


def _crossings(polar: Picture, *, per_step: float, level: float, rise: float | None) -> Array:
    """Return where each row crosses its own level, in steps; NaN where it grows nowhere."""
    smooth = ndimage.gaussian_filter1d(polar, 0.02 / per_step, axis=1, mode="nearest")
    growth = np.gradient(smooth, axis=1)
    near, far = int(0.06 / per_step), int(0.18 / per_step)
    growth[:, :near] = growth[:, -near:] = -1.0
    steepest = np.argmax(growth, axis=1)
    row, step = np.arange(len(polar)), np.arange(near, far)

    def side(sign: int) -> Array:
        columns = np.clip(steepest[:, None] + sign * step, 0, polar.shape[1] - 1)
        return np.asarray(np.median(polar[row[:, None], columns], axis=1))

    inner, outer = side(-1), side(+1)
    step_up = outer - inner
    threshold = inner + (level * step_up if rise is None else np.minimum(rise, 0.3 * step_up))
    fine = ndimage.gaussian_filter1d(polar, 0.004 / per_step, axis=1, mode="nearest")
    # The last place before the bright side that still lies below the threshold.
    bright = np.minimum(steepest + near, polar.shape[1] - 1)
    below = (fine < threshold[:, None]) & (np.arange(polar.shape[1]) <= bright[:, None])
    last = below.shape[1] - 1 - np.argmax(below[:, ::-1], axis=1)
    following = np.minimum(last + 1, polar.shape[1] - 1)
    low, high = fine[row, last], fine[row, following]
    part = np.clip((threshold - low) / np.maximum(high - low, 1e-9), 0.0, 1.0)
    grows = below.any(axis=1) & (outer > 1.15 * inner + 0.002) & (last > 0)
    return np.where(grows, last + part, np.nan)
