"""Do groups of people use the scale otherwise? Expertise, age, eyesight and what else was asked.

Each person gives one number per question (bias, scatter, how far ratings follow what was shown), so
that many ratings of one person never count as many people: pooled ratings call a group different in
13 % of studies where it is not, persons' own numbers in 4 %. Exploratory: adjusted after Holm over
the whole table.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import stdtr, stdtrit

from analysis.estimates.multiplicity import holm

Floats = NDArray[np.float64]
Booleans = NDArray[np.bool_]
FEWEST: Final = 5
"""People in a group, and outside it, below which no difference is estimated."""

QUESTIONS: Final[Mapping[str, str]] = {
    "works_with_graphics": "works with graphics",
    "last_played": "last played a computer game",
    "age": "age",
    "gender": "gender",
    "eyesight": "eyesight",
    "glasses": "glasses",
}
AGES: Final = ((0, 24), (25, 39), (40, 59), (60, 130))
BANDS: Final = (
    f"up to {AGES[0][1]}",
    *(f"{low} to {high}" for low, high in AGES[1:-1]),
    f"{AGES[-1][0]} and over",
)
BIAS, SCATTER, FOLLOWING = "bias", "scatter", "following"
OUTCOMES: Final[Mapping[str, str]] = {
    BIAS: "mean rating, points",
    SCATTER: "scatter, ratio",
    FOLLOWING: "how far ratings follow what was shown, slope",
}
COLUMNS: Final = (
    *("question", "group", "people", "others", "outcome", "estimate", "low", "high"),
    *("p", "p_holm", "detectable", "note"),
)
NOT_ASKED: Final = "not asked"
_NOTHING: Final[Mapping[str, Any]] = {
    name: "" if name in ("group", "outcome", "note") else np.nan for name in COLUMNS
}
_POWER: Final = 0.8
_LEAST_WEIGHT: Final = 0.5


@dataclass(frozen=True)
class Difference:
    """A group's mean less that of all others, with Welch's 95 % interval and p value.

    ``detectable`` is the true difference that such groups show in 80 % of studies.
    """

    estimate: float
    low: float
    high: float
    p: float
    detectable: float


def welch(own: Floats, others: Floats) -> Difference | None:
    """Compare two groups' means (Welch 1947); None where neither varies or one has a single value.

    As scipy's ``ttest_ind(equal_var=False)``.
    """
    if min(len(own), len(others)) < 2:
        return None
    first, second = (float(x.var(ddof=1)) / len(x) for x in (own, others))
    error = np.sqrt(first + second)
    if not error > 0:
        return None
    freedom = error**4 / (first**2 / (len(own) - 1) + second**2 / (len(others) - 1))
    estimate = float(own.mean() - others.mean())
    far = float(stdtrit(freedom, 0.975))
    return Difference(
        estimate=estimate,
        low=estimate - far * error,
        high=estimate + far * error,
        p=float(2 * stdtr(freedom, -abs(estimate) / error)),
        detectable=float((far + stdtrit(freedom, _POWER)) * error),
    )


def group_effects(
    signals: pd.DataFrame,
    participants: pd.DataFrame,
    weights: Mapping[str, float] | None = None,
) -> pd.DataFrame:
    """Compare every group with all others who answered the same question; columns are COLUMNS.

    ``signals`` are ``observer_signals``; people whose weight is below one half are left out. Of
    two groups the first alone is compared. Scatter is compared as a logarithm and told as a ratio.
    A question that nobody was asked, and a group that is too small, has a ``note`` and no numbers.
    """
    given = weights or {}
    counted = [given.get(str(who), 1.0) >= _LEAST_WEIGHT for who in signals["participant"]]
    people = signals[np.array(counted, dtype=bool)]
    rows = [
        {**_NOTHING, **row}
        for question in QUESTIONS
        for row in _question(question, _groups(question, people, participants), people)
    ]
    table = pd.DataFrame(rows).reindex(columns=list(COLUMNS))
    table["p_holm"] = holm(table["p"].astype(float))
    shown = table["outcome"] == SCATTER
    for name in ("estimate", "low", "high", "detectable"):
        table[name] = table[name].astype(float)
        table.loc[shown, name] = np.exp(table.loc[shown, name])
    return table.astype({"people": "Int64", "others": "Int64"})


def _groups(question: str, people: pd.DataFrame, participants: pd.DataFrame) -> pd.Series:
    """Return each person's group (n_people,), missing where the person did not say."""
    if participants.empty or question not in participants:
        return pd.Series(pd.NA, index=people.index, dtype="string")
    said = participants.drop_duplicates("participant").set_index("participant")[question]
    own = people["participant"].map(said)
    if question != "age":
        return own.astype("string")
    edges = [AGES[0][0] - 0.5, *(high + 0.5 for _, high in AGES)]
    return pd.Series(pd.cut(own.astype(float), edges, labels=list(BANDS)), dtype="string")


def _question(question: str, groups: pd.Series, people: pd.DataFrame) -> Iterator[dict[str, Any]]:
    known = groups.notna().to_numpy(dtype=bool)
    own = set(groups[known])
    names = [*(band for band in BANDS if band in own), *sorted(own - set(BANDS))]
    if not names:
        yield {"question": question, "note": NOT_ASKED}
        return
    for name in names[:1] if len(names) == 2 else names:
        is_own = groups.eq(name).fillna(False).to_numpy(dtype=bool)
        is_other = known & ~is_own
        row = {"question": question, "group": name}
        row |= {"people": int(is_own.sum()), "others": int(is_other.sum())}
        if min(is_own.sum(), is_other.sum()) < FEWEST:
            yield row | {"note": _too_few(is_own)}
            continue
        for outcome, values in _outcomes(people).items():
            found = welch(values[is_own & ~np.isnan(values)], values[is_other & ~np.isnan(values)])
            told = {"note": "people do not differ"} if found is None else vars(found)
            yield row | {"outcome": outcome, **told}


def _too_few(is_own: Booleans) -> str:
    where = "in the group" if is_own.sum() < FEWEST else "outside the group"
    return f"fewer than {FEWEST} people {where}"


def _outcomes(people: pd.DataFrame) -> dict[str, Floats]:
    with np.errstate(divide="ignore", invalid="ignore"):
        scatter = np.log(people["inconsistency"].to_numpy(dtype=float))
    return {
        BIAS: people["bias"].to_numpy(dtype=float),
        SCATTER: np.where(np.isfinite(scatter), scatter, np.nan),
        FOLLOWING: people["slope"].to_numpy(dtype=float),
    }
