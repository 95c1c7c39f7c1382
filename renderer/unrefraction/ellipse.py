"""Ellipses in pictures: fitted to points, robustly, and sampled. Pure numpy.

Pixel coordinates: x to the right, y down, whole numbers at the pixels' centres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

RANSAC_ROUNDS: Final = 200
SAMPLE: Final = 6  # points that make a trial ellipse: five would fit noise exactly
LEAST_RATIO: Final = 0.6  # of the axes: no accepted view shortens a circle more


@dataclass(frozen=True)
class Ellipse:
    """Centre and half axes in pixels; ``angle`` of the major axis to +x in radians, y down."""

    x: float
    y: float
    major: float
    minor: float
    angle: float

    @property
    def radius(self) -> float:
        """The radius of the circle with the same area."""
        return math.sqrt(self.major * self.minor)

    def points(self, count: int = 180) -> Array:
        """Return points (count, 2) along the ellipse."""
        t = np.arange(count) / count * 2 * np.pi
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        along, across = self.major * np.cos(t), self.minor * np.sin(t)
        x = self.x + cos * along - sin * across
        return np.stack([x, self.y + sin * along + cos * across], axis=1)

    def radius_at(self, angles: Array) -> Array:
        """Return the distance from the centre to the ellipse in directions, in pixels."""
        turned = angles - self.angle
        return np.asarray(
            self.major
            * self.minor
            / np.hypot(self.minor * np.cos(turned), self.major * np.sin(turned))
        )

    def errors(self, points: Array) -> Array:
        """Return how far points (n, 2) lie outside (+) or inside (-) along their own radius."""
        dx, dy = points[:, 0] - self.x, points[:, 1] - self.y
        return np.asarray(np.hypot(dx, dy) - self.radius_at(np.arctan2(dy, dx)))


def fit_ellipse(points: Array) -> Ellipse | None:
    """Fit an ellipse to points (n, 2) by least squares; None where they form no ellipse.

    Halir and Flusser 1998, "Numerically stable direct least squares fitting of ellipses".
    """
    middle, spread = points.mean(axis=0), max(float(points.std()), 1e-9)
    x, y = ((points - middle) / spread).T
    d1 = np.stack([x * x, x * y, y * y], axis=1)
    d2 = np.stack([x, y, np.ones_like(x)], axis=1)
    s3 = d2.T @ d2
    if np.linalg.cond(s3) > 1e12:
        return None
    t = -np.linalg.solve(s3, d2.T @ d1)
    m = d1.T @ d1 + (d1.T @ d2) @ t
    values, vectors = np.linalg.eig(np.stack([m[2] / 2, -m[1], m[0] / 2]))
    if np.iscomplexobj(values):
        return None
    is_ellipse = 4 * vectors[0] * vectors[2] - vectors[1] ** 2 > 0
    if not is_ellipse.any():
        return None
    first = vectors[:, int(np.argmax(is_ellipse))]
    return _from_conic(np.concatenate([first, t @ first]), middle, spread)


def _from_conic(conic: Array, middle: Array, spread: float) -> Ellipse | None:
    a, b, c, d, e, f = conic
    matrix = np.array([[a, b / 2], [b / 2, c]])
    centre = np.linalg.solve(2 * matrix, [-d, -e])
    level = -(f + 0.5 * float(np.array([d, e]) @ centre))
    values, vectors = np.linalg.eigh(matrix)
    squares = level / values
    if not np.all(np.isfinite(squares)) or np.any(squares <= 0):
        return None
    axes = np.sqrt(squares)
    long = int(np.argmax(axes))
    angle = math.atan2(vectors[1, long], vectors[0, long])
    x, y = middle + spread * centre
    return Ellipse(x, y, spread * float(axes[long]), spread * float(axes[1 - long]), angle)


def robust_ellipse(
    points: Array, *, tolerance: float
) -> tuple[Ellipse, npt.NDArray[np.bool_]] | None:
    """Return the ellipse that most points support within ``tolerance`` pixels, and which do.

    RANSAC (Fischler and Bolles 1981) with a fixed seed, then a fit to the supporters.
    """
    if len(points) < 2 * SAMPLE:
        return None
    rng = np.random.Generator(np.random.PCG64(28))
    best, support = None, 0
    for _ in range(RANSAC_ROUNDS):
        trial = fit_ellipse(points[rng.choice(len(points), SAMPLE, replace=False)])
        if trial is None or trial.minor < LEAST_RATIO * trial.major:
            continue
        count = int(np.sum(np.abs(trial.errors(points)) < tolerance))
        if count > support:
            best, support = trial, count
    if best is None:
        return None
    for _ in range(4):
        supporters = np.abs(best.errors(points)) < tolerance
        fitted = fit_ellipse(points[supporters]) if supporters.sum() >= 2 * SAMPLE else None
        if fitted is None:
            return None
        best = fitted
    return best, np.abs(best.errors(points)) < tolerance
