"""How well do people agree? ICC and ordinal alpha, with and without leniency; each person's tau.

Plain leniency lowers absolute agreement although it spoils no comparison of LoDs, so every
coefficient is given again after each person's bias was taken out.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
import pandas as pd

from analysis.descriptive.means import t_interval
from analysis.reliability.intraclass import Coefficient, intraclass
from analysis.reliability.ordinal_alpha import krippendorff
from analysis.screening.annex_e import bias_and_inconsistency
from analysis.screening.following import others_means
from analysis.screening.presented import Presented, presented

COLUMNS: Final = ("coefficient", "bias", "value", "low", "high", "interval", "people", "stimuli")
KEPT, REMOVED = "as rated", "bias removed"
_FEW: Final = 3  # ratings below which a person's tau says nothing


def reliability(ratings: pd.DataFrame, rng: np.random.Generator) -> pd.DataFrame:
    """Return the coefficients of agreement, one row each; columns are COLUMNS.

    ICC needs people who rated the same stimuli: it takes those who rated every stimulus. Alpha
    takes everyone. A value is empty where the data leave it open.
    """
    shown = presented(ratings)
    rows: list[dict[str, object]] = []
    for name, own in ((KEPT, shown), (REMOVED, _without_bias(shown))):
        table = complete_table(own)
        sizes = {"people": table.shape[1], "stimuli": table.shape[0]}
        for label, found in zip(("ICC(2,1)", "ICC(2,k)"), intraclass(table), strict=True):
            rows.append(_row(label, name, found, "F law") | sizes)
        unit_count = int(own.stimulus.max(initial=-1)) + 1
        sizes = {"people": len(own.people), "stimuli": unit_count}
        alphas = krippendorff(own.stimulus, own.person, own.rating, rng)
        for interval, alpha in zip(("over people", "over stimuli"), alphas, strict=True):
            rows.append(_row("alpha, ordinal", name, alpha, interval) | sizes)
    taus = person_taus(ratings)["tau_b"].dropna()
    low, high = t_interval(taus)
    mean = Coefficient(float(taus.mean()) if len(taus) else np.nan, low, high)
    sizes = {"people": len(taus), "stimuli": int(shown.cell.max(initial=-1)) + 1}
    rows.append(_row("mean τ-b with the others", KEPT, mean, "over people") | sizes)
    return pd.DataFrame(rows, columns=list(COLUMNS))


def complete_table(shown: Presented) -> np.ndarray:
    """Return the mean ratings (n_stimuli, n_people) of those who rated every stimulus."""
    n_stimuli = int(shown.stimulus.max(initial=-1)) + 1
    shape = (n_stimuli, len(shown.people))
    total, count = np.zeros(shape), np.zeros(shape)
    np.add.at(total, (shown.stimulus, shown.person), shown.rating)
    np.add.at(count, (shown.stimulus, shown.person), 1)
    whole = (count > 0).all(axis=0)
    return np.asarray(total[:, whole] / count[:, whole])


def person_taus(ratings: pd.DataFrame) -> pd.DataFrame:
    """Return each person's Kendall tau-b with the mean ratings of the others.

    Columns: participant, ratings, tau_b; empty for fewer than three ratings or ratings all alike.
    """
    shown = presented(ratings)
    others = others_means(shown, shown.cell)
    table = pd.DataFrame({"person": shown.person, "others": others, "rating": shown.rating})
    rows = []
    for who, own in table.dropna().groupby("person", sort=True):
        varies = len(own) >= _FEW and own["rating"].nunique() > 1 and own["others"].nunique() > 1
        tau = tau_b(own["others"].to_numpy(), own["rating"].to_numpy()) if varies else np.nan
        rows.append((shown.people[int(str(who))], len(own), tau))
    return pd.DataFrame(rows, columns=["participant", "ratings", "tau_b"])


def tau_b(x: np.ndarray, y: np.ndarray) -> float:
    """Return Kendall's tau-b of two rows of numbers, over all pairs; nan where one never varies."""
    above = np.triu_indices(len(x), 1)
    one, other = (np.sign(np.subtract.outer(values, values)[above]) for values in (x, y))
    norm = np.sqrt(float((one**2).sum()) * float((other**2).sum()))
    return float(one @ other) / norm if norm else float("nan")


def _without_bias(shown: Presented) -> Presented:
    if not shown.rating.size:
        return shown
    bias = bias_and_inconsistency(shown).bias
    return replace(shown, rating=shown.rating - bias[shown.person])


def _row(name: str, bias: str, found: Coefficient, interval: str) -> dict[str, object]:
    row = {"coefficient": name, "bias": bias, "value": found.value, "low": found.low}
    return row | {"high": found.high, "interval": interval}
