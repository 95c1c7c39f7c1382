"""Which way up an eye is, from its limbus: the edge is softer above and below than at the sides.

Where lids cover the limbus, vessels and thin tissue reach further over the cornea (the pannus). The
limbus's shape alone tells a turned eye badly from one that looks aside: both are ellipses aslant.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.unrefraction.ellipse import Ellipse
from renderer.unrefraction.limbus import climbed_mm

Array = npt.NDArray[np.float64]

LEVELS: Final = (0.25, 0.6)  # of the step: the slope between them is the edge's, not the ring's
WITNESSES: Final = 18  # the edge wanders over 2 mm: neighbouring rays say the same
EVEN: Final = 0.03  # how far the waves of eyes that are seen perfectly would spread
LEAST_WITNESSES: Final = 60  # rays
ODD: Final = 0.8  # of the median: such a width is no limbus's


@dataclass(frozen=True)
class Softness:
    """How the edge's width waves around the eye: shares of its mean width.

    ``wave`` are the parts along cos 2t and sin 2t, t the direction in the picture, anticlockwise;
    ``weight`` (2, 2) makes numbers of spread 1 from them.
    """

    wave: Array
    weight: Array

    def errors(self, roll: float) -> Array:
        """Return how badly the wave suits an eye turned anticlockwise, (2,), of spread 1."""
        expected = -WAVE * np.array([np.cos(2 * roll), np.sin(2 * roll)])
        return np.asarray(self.weight @ (self.wave - expected))


def _wave() -> float:
    """Return half of the widths' difference, in shares of the mean, in the average eye."""
    side, above = (
        climbed_mm(bearing, LEVELS[1]) - climbed_mm(bearing, LEVELS[0])
        for bearing in (0.0, 0.5 * np.pi)
    )
    return (above - side) / (above + side)


WAVE: Final = _wave()


def find_softness(
    inner: Array, outer: Array, limbus: Ellipse, *, rays: int, tolerance: float
) -> Softness | None:
    """Measure the wave between the points (n, 2) at both LEVELS on ``rays`` rays.

    The rays start from the ellipse's middle; points further than ``tolerance`` pixels from it are
    lids. None where too little of the limbus is seen.
    """
    near, far = (_on_rays(points, limbus, rays) for points in (inner, outer))
    t = np.arange(rays) / rays * 2 * np.pi
    at = limbus.radius_at(-t)
    width = (far - near) / at  # a view from the side narrows both alike
    seen = np.abs(0.5 * (near + far) - at) < tolerance
    if seen.sum() < LEAST_WITNESSES:
        return None
    width = width / np.median(width[seen])
    seen &= np.abs(width - 1.0) < ODD
    if seen.sum() < LEAST_WITNESSES:
        return None
    waves = np.stack([np.ones(rays), np.cos(2 * t), np.sin(2 * t)], axis=1)[seen]
    found, *_ = np.linalg.lstsq(waves, width[seen], rcond=None)
    spread = float(np.std(width[seen] - waves @ found)) / found[0]
    # Neighbours say the same; and where lids leave the sides alone, wave and mean mix.
    unsure = spread**2 * (rays / WITNESSES) * np.linalg.inv(waves.T @ waves)[1:, 1:]
    unsure += EVEN**2 * np.eye(2)
    return Softness(found[1:] / found[0], np.linalg.inv(np.linalg.cholesky(unsure)))


def _on_rays(points: Array, limbus: Ellipse, rays: int) -> Array:
    """Return the points' distances from the middle by the number of their ray; NaN elsewhere."""
    off = points - [limbus.x, limbus.y]
    number = np.rint(np.arctan2(-off[:, 1], off[:, 0]) / (2 * np.pi) * rays).astype(int) % rays
    distance = np.full(rays, np.nan)
    distance[number] = np.hypot(off[:, 0], off[:, 1])
    return distance
