"""Where in a picture an eye is: a coarse search for two nested edges, pupil and limbus.

After Daugman 1993: the centre and radius at which brightness grows most across a circle. Lids hide
two of the limbus's four quarters, so that only two opposite ones count, at any turn of the picture.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

Array = npt.NDArray[np.float32]

SEARCH_PX: Final = 320  # long side of the searched picture
RADII_PX: Final = 11.0 * 1.09 ** np.arange(33)  # 11 to 175: an iris of 7 % to 110 % of the side
ANGLES: Final = 32
PUPIL_SHARES: Final = np.array([0.2, 0.26, 0.33, 0.42, 0.53, 0.66])  # of the iris's radius
TURNS: Final = (0, 4, 8, 12)  # of the eye's long axis, in steps of 11.25 degrees
UPRIGHT_BONUS: Final = 2.0  # photographs are mostly upright
MIDDLE_BONUS: Final = 0.15  # and their subject is mostly in the middle


@dataclass(frozen=True)
class Candidate:
    """Where an eye seems to be: pixels of the searched picture's original, score 0 to about 1."""

    x: float
    y: float
    limbus: float
    pupil: float
    turn: float  # of the line between the lids' corners, radians, y down
    score: float


def find_candidates(picture: Array) -> list[Candidate]:
    """Return the best places of an eye in a picture (height, width, 3) of 0..1 encoded values.

    Best first; no two overlap. May be empty.
    """
    small, factor = _shrunk(picture)
    value = ndimage.gaussian_filter(small.max(axis=-1), 1.0)
    red = ndimage.gaussian_filter(0.6 * small[..., 0] + 0.4 * small[..., 1], 1.0)
    found: list[tuple[float, ...]] = []
    for radius in RADII_PX[0.62 * max(value.shape) > RADII_PX]:
        found += _at_radius(value, red, float(radius))
    found.sort(key=lambda row: -row[-1])
    kept: list[tuple[float, ...]] = []
    for row in found:
        if len(kept) < 4 and all(_apart(row, other) for other in kept):
            kept.append(row)
    return [
        Candidate(
            x=(x + 0.5) * factor - 0.5,
            y=(y + 0.5) * factor - 0.5,
            limbus=limbus * factor,
            pupil=pupil * factor,
            turn=turn,
            score=score,
        )
        for x, y, limbus, pupil, turn, score in kept
    ]


def _apart(row: tuple[float, ...], other: tuple[float, ...]) -> bool:
    distance = float(np.hypot(row[0] - other[0], row[1] - other[1]))
    return distance > 1.6 * max(row[2], other[2])


def _shrunk(picture: Array) -> tuple[Array, float]:
    factor = max(max(picture.shape[:2]) / SEARCH_PX, 1.0)
    if factor == 1.0:
        return picture, 1.0
    blurred = ndimage.gaussian_filter(picture, (0.4 * factor, 0.4 * factor, 0.0))
    rows, columns = (int(side / factor) for side in picture.shape[:2])
    y, x = (((np.arange(n) + 0.5) * factor - 0.5) for n in (rows, columns))
    return blurred[np.rint(y).astype(int)[:, None], np.rint(x).astype(int)[None, :]], factor


def _at_radius(value: Array, red: Array, radius: float) -> list[tuple[float, ...]]:
    """Return x, y, limbus, pupil, turn and score of the best centres for one iris radius."""
    height, width = value.shape
    step = max(2, int(radius / 8))
    y, x = np.mgrid[step:height:step, step:width:step]
    y, x = y.ravel(), x.ravel()
    limbus, turn = _limbus_score(red, x, y, radius)
    likely = limbus > 0.06
    if not likely.any():
        return []
    x, y, limbus, turn = x[likely], y[likely], limbus[likely], turn[likely]
    pupil, share = _pupil_score(value, x, y, radius)
    off = np.hypot(x / width - 0.5, y / height - 0.5)
    score = limbus * pupil * (1.0 - MIDDLE_BONUS * off)
    score = np.sqrt(np.clip(score, 0.0, None))
    best = np.argsort(-score)[:12]
    return [
        (
            float(x[i]),
            float(y[i]),
            radius,
            float(share[i] * radius),
            float(turn[i]),
            float(score[i]),
        )
        for i in best
    ]


def _ring(picture: Array, x: Array, y: Array, radius: float | Array) -> Array:
    """Return the picture on circles, (centres, ANGLES); NaN outside of it."""
    angle = np.arange(ANGLES) / ANGLES * 2 * np.pi
    px = np.rint(x[:, None] + np.multiply.outer(np.broadcast_to(radius, x.shape), np.cos(angle)))
    py = np.rint(y[:, None] + np.multiply.outer(np.broadcast_to(radius, x.shape), np.sin(angle)))
    height, width = picture.shape
    inside = (px >= 0) & (px < width) & (py >= 0) & (py < height)
    taken = picture[
        np.clip(py, 0, height - 1).astype(np.intp), np.clip(px, 0, width - 1).astype(np.intp)
    ]
    return np.where(inside, taken, np.nan).astype(np.float32)


def _contrast(inner: Array, outer: Array) -> Array:
    return np.asarray((outer - inner) / (outer + inner + 0.1))


def _limbus_score(red: Array, x: Array, y: Array, radius: float) -> tuple[Array, Array]:
    """Return the weaker of two opposite quarters' contrasts at the best turn, and the turn."""
    rings = [_ring(red, x, y, radius * share) for share in (0.8, 0.9, 1.08, 1.2)]
    contrast = _contrast(np.maximum(rings[0], rings[1]), np.fmin(rings[2], rings[3]))
    best = np.full(x.shape, -1.0, np.float32)
    turn = np.zeros(x.shape, np.float32)
    reach = np.arange(-3, 4)
    for number in TURNS:
        sides = [
            contrast[:, (number + half + reach) % ANGLES].mean(axis=1) for half in (0, ANGLES // 2)
        ]
        weaker = np.minimum(sides[0], sides[1]) * (UPRIGHT_BONUS if number == 0 else 1.0)
        better = np.nan_to_num(weaker, nan=-1.0) > best
        best = np.where(better, weaker, best)
        turn = np.where(better, number / ANGLES * 2 * np.pi, turn)
    return best, turn.astype(np.float32)


def _pupil_score(value: Array, x: Array, y: Array, radius: float) -> tuple[Array, Array]:
    """Return the best concentric dark disc's contrast and its share of the iris's radius."""
    best = np.zeros(x.shape, np.float32)
    share = np.full(x.shape, 0.4, np.float32)
    for part in PUPIL_SHARES:
        inner = np.nan_to_num(_ring(value, x, y, 0.8 * part * radius), nan=1.0)
        outer = np.nan_to_num(_ring(value, x, y, 1.25 * part * radius), nan=0.0)
        contrast = _contrast(inner, outer)
        # A glint may sit on the edge and a lid may cover some of it: the lower quartile decides.
        typical = np.quantile(contrast, 0.25, axis=1)
        better = typical > best
        best = np.where(better, typical, best)
        share = np.where(better, part, share)
    return best.astype(np.float32), share.astype(np.float32)
