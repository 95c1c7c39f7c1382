"""Profile-likelihood intervals beside R's confint, closed forms, and Wald's."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.special import ndtr, ndtri

from analysis.models.counts import Counts, count_answers
from analysis.models.fitting import fit
from analysis.models.links import LOGIT, PROBIT, Link
from analysis.models.ordinal import LENIENCY, PERSON_EFFECTS, OrdinalModel
from analysis.models.predictors import Linear
from analysis.models.priors import PRIORS
from analysis.models.profile import profile_interval

sys.path.append(str(Path(__file__).parent))
from peers import ask_r


@pytest.mark.peer
@pytest.mark.parametrize("link", [PROBIT, LOGIT])
def test_intervals_of_wine_are_those_of_r(link: Link) -> None:
    name = {"probit": "probit", "logit": "logit"}[link.name]
    wine = ask_r(
        f'f <- clm(rating ~ temp + contact, data = wine, link = "{name}")\n'
        "ci <- confint(f)\n"
        'wine$low <- ci["tempwarm", 1]; wine$high <- ci["tempwarm", 2]\n'
        'wine$low2 <- ci["contactyes", 1]; wine$high2 <- ci["contactyes", 2]; write.csv(wine)'
    )
    kinds, what = np.unique(wine[["temp", "contact"]].agg(" ".join, axis=1), return_inverse=True)
    location = np.array([["warm" in kind, "yes" in kind] for kind in kinds], dtype=float)
    counts = count_answers(wine["judge"] * 0, what, wine["rating"] - 1, shape=(1, 4, 5))
    model = OrdinalModel(Linear(location, ("temp", "contact")), effects=(), link=link)
    found, own = fit(model, counts), wine.iloc[0]
    assert profile_interval(found, "temp") == pytest.approx((own["low"], own["high"]), abs=2e-3)
    assert profile_interval(found, "contact") == pytest.approx(
        (own["low2"], own["high2"]), abs=2e-3
    )


def test_of_a_share_it_is_the_closed_form() -> None:
    found = fit(
        OrdinalModel(Linear(np.zeros((1, 0)), ()), 2, effects=()),
        Counts(np.array([[[3.0, 17.0]]])),
    )
    low, high = profile_interval(found, "threshold_1")

    def fall(threshold: float) -> float:
        return 2 * (_log(3, 17, 3 / 20) - _log(3, 17, float(ndtr(threshold))))

    assert fall(low) == pytest.approx(3.8415, abs=5e-3)
    assert fall(high) == pytest.approx(3.8415, abs=5e-3)
    assert low < ndtri(0.15) < high
    assert ndtri(0.15) - low > high - ndtri(0.15)  # the rarer side is the wider one


def test_a_spread_near_zero_has_a_longer_lower_arm_than_walds() -> None:
    rng = np.random.default_rng(3)
    who = np.repeat(np.arange(12), 30)
    leniency = 0.3 * ndtri((np.arange(12) + 0.5) / 12)
    answer = np.searchsorted([-1.0, 0.0, 1.0], rng.standard_normal(who.size) + leniency[who])
    counts = count_answers(who, who * 0, answer, shape=(12, 1, 4))
    found = fit(OrdinalModel(Linear(np.zeros((1, 0)), ()), 4, effects=(LENIENCY,)), counts)
    name = "log_sd:leniency"
    low, high = profile_interval(found, name)
    assert low < found.value(name) < high
    assert found.value(name) - low > 1.96 * found.standard_error(name)


def test_what_is_not_bounded_is_infinite() -> None:
    table = np.zeros((4, 2, 2))
    table[:, 0, 0] = table[:, 1, 1] = 3
    model = OrdinalModel(Linear(np.array([[0.0], [1.0]]), ("high",)), 2, effects=())
    low, high = profile_interval(fit(model, Counts(table)), "high")
    assert high == np.inf
    assert low > 0 or low == -np.inf
    with pytest.raises(KeyError, match="no parameter low"):
        profile_interval(fit(model, Counts(table)), "low")


def test_the_way_back_from_beyond_does_not_lead_astray() -> None:
    """Three people of very different scatter: the likelihood has a second, lower top."""
    rng = np.random.default_rng(5)
    who, what = np.repeat(np.arange(3), 32), np.tile(np.arange(16), 6)
    scatter = np.array([0.3, 1.0, 3.0])[who]
    place = rng.normal(0, 0.3, 16)
    percept = place[what] + scatter * rng.standard_normal(who.size)
    answer = np.searchsorted([-1.3, -0.3, 0.8, 1.8], percept)
    cells = Linear(np.eye(16)[:, 1:], tuple(f"cell {i}" for i in range(1, 16)))
    counts = count_answers(who, what, answer, shape=(3, 16, 5))
    found = fit(OrdinalModel(cells, 5, PERSON_EFFECTS), counts, priors=PRIORS)
    low, high = profile_interval(found, "log_sd:leniency")
    assert low < found.value("log_sd:leniency") < high


def _log(hits: int, misses: int, share: float) -> float:
    return float(hits * np.log(share) + misses * np.log(1 - share))
