"""Does the model of ratings fit? Residuals and the ends of the scale, held against chance.

The parameters were fitted to the same ratings, so chance is allowed a little too much: a check that
fails, fails.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import kolmogorov, ndtr

from analysis.diagnostics.predicted import HIGHEST, LOWEST, Predicted
from analysis.estimates.multiplicity import holm

Floats = NDArray[np.float64]
Integers = NDArray[np.intp]
PEOPLE, CELLS = "person", "LoD and distance"
NORMAL, BY_PERSON, BY_CELL = "normal law", f"scatter by {PEOPLE}", f"scatter by {CELLS}"
COLUMNS: Final = ("check", "of", "statistic", "p", "p_holm", "fits")
_WORDS: Final[Mapping[str, str]] = {
    NORMAL: "their distribution is not the model's",
    BY_PERSON: "some people's ratings scatter more, others' less, than it allows for",
    BY_CELL: "ratings of some LoDs scatter more, of others less, than it allows for",
    **{
        f"{end} rating by {of}": f"{who} the {end} rating more often, others less, than it expects"
        for end in (LOWEST, HIGHEST)
        for of, who in ((PEOPLE, "some people give"), (CELLS, "some LoDs get"))
    },
}
_LEVEL: Final = 0.05
_DRAWN: Final = (199, 999)  # studies drawn, for many ratings and for few
_MANY: Final = 5_000


def fit_checks(
    residuals: pd.DataFrame, ends: Sequence[Predicted], rng: np.random.Generator
) -> pd.DataFrame:
    """Return one row for each check; columns are COLUMNS.

    ``residuals`` are ``quantile_residuals``, ``ends`` ``predicted_ends``. The law is Kolmogorov and
    Smirnov's test; scatter asks whether groups' mean squares differ more than those of normal
    residuals; the ends whether groups' counts stray further from the model's than its own draws do.
    ``fits`` is False where the p value, adjusted over all checks after Holm, is below 5 %.
    """
    values = residuals["residual"].to_numpy(dtype=float)
    distance, p = normal_law(values)
    rows: list[dict[str, Any]] = [
        {"check": NORMAL, "of": "residuals", "statistic": distance, "p": p}
    ]
    for check, names in ((BY_PERSON, ["participant"]), (BY_CELL, ["distance", "lod"])):
        groups = residuals.groupby(names, sort=False).ngroup()
        statistic, p = _spread(values, np.asarray(groups, dtype=np.intp), rng)
        rows.append({"check": check, "of": "residuals", "statistic": statistic, "p": p})
    for own in ends:
        check = f"{own.end} rating by {PEOPLE if own.of == 'person' else CELLS}"
        about = {"check": check, "of": "predicted shares", "statistic": float(own.counted.sum())}
        rows.append({**about, "p": own.p_value()})
    table = pd.DataFrame(rows)
    table["p_holm"] = holm(table["p"])
    table["fits"] = table["p_holm"] >= _LEVEL
    return table[list(COLUMNS)]


def normal_law(values: Floats) -> tuple[float, float]:
    """Return how far the values' shares stray from the standard normal law, and the p value.

    Kolmogorov and Smirnov's distance; the p value is their limit's, with Stephens' effective number
    of values (Journal of the Royal Statistical Society B 32, 1970, 115-122).
    """
    count = len(values)
    law = ndtr(np.sort(values))
    ranks = np.arange(count + 1) / count
    distance = float(max((ranks[1:] - law).max(), (law - ranks[:-1]).max()))
    return distance, float(kolmogorov((np.sqrt(count) + 0.12 + 0.11 / np.sqrt(count)) * distance))


def misfits(checks: pd.DataFrame, of: str) -> list[str]:
    """Name what does not fit among the residuals or the predicted shares, in plain words."""
    failed = checks[(checks["of"] == of) & ~checks["fits"]]["check"]
    return [_WORDS[str(check)] for check in failed]


def end_counts(ends: Sequence[Predicted], end: str = HIGHEST) -> tuple[int, float, float, float]:
    """Return how often an end of the scale was given, and the model's mean and 95 % of draws."""
    own = next(found for found in ends if found.of == "cell" and found.end == end)
    drawn = own.drawn.sum(axis=1)
    low, high = np.quantile(drawn, (0.025, 0.975), method="inverted_cdf")
    return int(own.counted.sum()), float(drawn.mean()), float(low), float(high)


def _spread(values: Floats, groups: Integers, rng: np.random.Generator) -> tuple[float, float]:
    """Say how far the groups' mean squares differ, and how often normal residuals' differ as far.

    The statistic is the sum of ((sum of squares) - m)^2 / (2 m) over groups of m residuals, about
    the number of groups where all are normal.
    """
    size = np.bincount(groups).astype(float)
    own = np.bincount(groups, weights=values**2)
    count = _DRAWN[0] if len(values) > _MANY else _DRAWN[1]
    drawn: Floats = rng.chisquare(size, (count, len(size)))

    strays = ((drawn - size) ** 2 / (2 * size)).sum(axis=1)
    statistic = float(((own - size) ** 2 / (2 * size)).sum())
    return statistic, float((1 + (strays >= statistic).sum()) / (1 + count))
