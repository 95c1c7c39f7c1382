"""Does a person rate as the others do? The slope of their ratings on the others' mean ratings.

A slope of 1 follows the others, 0 has nothing to do with what was shown, -1 turns the scale round.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analysis.screening.presented import Floats, Places, Presented, sums


@dataclass(frozen=True)
class Following:
    """Per person (n_people,): slope, its standard error and the correlation; nan where unknown."""

    slope: Floats
    error: Floats
    correlation: Floats


def others_means(shown: Presented, place: Places) -> Floats:
    """Return for each rating the mean that others gave at the same place; nan where nobody did.

    ``place`` is the stimulus or the cell. Each person's own mean is taken out first and the
    overall mean put back, so that leniency does not count.
    """
    n_people, n_places = len(shown.people), int(place.max(initial=-1)) + 1
    level = sums(shown.person, shown.rating, n_people) / shown.answers
    u = shown.rating - level[shown.person] + (shown.rating.mean() if shown.rating.size else 0.0)
    pair = shown.person * max(n_places, 1) + place
    _, own = np.unique(pair, return_inverse=True)
    n_own = int(own.max(initial=-1)) + 1
    ones = np.ones_like(u)
    total = sums(place, u, n_places)[place] - sums(own, u, n_own)[own]
    count = sums(place, ones, n_places)[place] - sums(own, ones, n_own)[own]
    mean: Floats = np.full(u.shape, np.nan)
    np.divide(total, count, out=mean, where=count > 0)
    return mean


def following(shown: Presented) -> Following:
    """Regress every person's ratings on the others' means of the same cells."""
    n_people = len(shown.people)
    x = others_means(shown, shown.cell)
    known = np.isfinite(x)
    who, x, y = shown.person[known], x[known], shown.rating[known]
    count = sums(who, np.ones_like(x), n_people)
    divisor = np.maximum(count, 1)
    dx = x - (sums(who, x, n_people) / divisor)[who]
    dy = y - (sums(who, y, n_people) / divisor)[who]
    xx, xy, yy = (sums(who, product, n_people) for product in (dx * dx, dx * dy, dy * dy))
    enough = (count > 3) & (xx > 1e-9)
    slope, error, correlation = (np.full(n_people, np.nan) for _ in range(3))
    np.divide(xy, xx, out=slope, where=enough)
    rest = np.maximum(yy - np.nan_to_num(slope) * xy, 0.0)
    np.divide(rest, (count - 2) * xx, out=error, where=enough)
    np.divide(xy, np.sqrt(xx * yy), out=correlation, where=enough & (yy > 1e-9))
    return Following(slope, np.sqrt(error), correlation)
