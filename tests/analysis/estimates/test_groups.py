"""Group effects beside scipy and statsmodels, and how often they cry wolf."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from scipy.stats import ttest_ind
from statsmodels.stats.multitest import multipletests

from analysis.estimates.groups import (
    BIAS,
    COLUMNS,
    FEWEST,
    NOT_ASKED,
    QUESTIONS,
    SCATTER,
    group_effects,
    welch,
)


def people(rng: np.random.Generator, count: int = 30, *, gap: float = 0.0) -> pd.DataFrame:
    """Return what a screening knows of people; the first half's bias is greater by ``gap``."""
    is_first = np.arange(count) < count // 2
    return pd.DataFrame(
        {
            "participant": [f"p{i}" for i in range(count)],
            "bias": gap * is_first + 0.4 * rng.standard_normal(count),
            "inconsistency": np.exp(0.3 * rng.standard_normal(count)),
            "slope": 1 + 0.3 * rng.standard_normal(count),
        }
    )


def said(count: int = 30, **answers: object) -> pd.DataFrame:
    return pd.DataFrame({"participant": [f"p{i}" for i in range(count)], **answers})


def test_a_difference_is_scipy_s_and_its_adjustment_statsmodels(rng: np.random.Generator) -> None:
    signals = people(rng, gap=0.5)
    asked = said(works_with_graphics=["no"] * 15 + ["yes"] * 15, gender=["a", "b", "c"] * 10)
    found = group_effects(signals, asked)
    assert tuple(found.columns) == COLUMNS
    own = found[found["question"] == "works_with_graphics"].set_index("outcome")
    assert own["group"].unique().tolist() == ["no"]  # the other half says the same again
    bias = signals["bias"].to_numpy()
    peer = ttest_ind(bias[:15], bias[15:], equal_var=False)
    ends = peer.confidence_interval(0.95)
    assert own.loc[BIAS, "p"] == pytest.approx(peer.pvalue)
    assert (own.loc[BIAS, "low"], own.loc[BIAS, "high"]) == pytest.approx((ends.low, ends.high))
    logs = np.log(signals["inconsistency"].to_numpy())
    ratio = np.exp(logs[:15].mean() - logs[15:].mean())
    assert own.loc[SCATTER, "estimate"] == pytest.approx(ratio)
    given = found["p"].dropna()
    assert len(given) == 3 + 9
    adjusted = multipletests(given, method="holm")[1]
    assert found.loc[given.index, "p_holm"].to_numpy(dtype=float) == pytest.approx(adjusted)


def test_what_was_not_asked_is_said_to_be_so(rng: np.random.Generator) -> None:
    for participants in (pd.DataFrame(), said(age=[20, 50] * 15, eyesight=[None] * 30)):
        found = group_effects(people(rng), participants)
        silent = found[found["note"] == NOT_ASKED]["question"].tolist()
        wanted = [name for name in QUESTIONS if participants.empty or name != "age"]
        assert silent == wanted


def test_ages_are_banded(rng: np.random.Generator) -> None:
    ages = [18] * 8 + [24] * 4 + [25] * 5 + [39] * 5 + [70] * 8
    found = group_effects(people(rng), said(age=ages))
    own = found[(found["question"] == "age") & (found["outcome"] == BIAS)].set_index("group")
    assert own["people"].to_dict() == {"up to 24": 12, "25 to 39": 10, "60 and over": 8}
    assert (own["people"] + own["others"] == 30).all()


def test_a_small_group_is_not_estimated(rng: np.random.Generator) -> None:
    sight = ["corrected"] * (FEWEST - 1) + ["normal"] * (31 - FEWEST)
    found = group_effects(people(rng), said(eyesight=sight))
    own = found[found["question"] == "eyesight"]
    assert own["note"].tolist() == ["fewer than 5 people in the group"]
    assert own["estimate"].isna().all()
    assert own[["people", "others"]].to_numpy().tolist() == [[4, 26]]


def test_people_who_spoil_data_are_left_out(rng: np.random.Generator) -> None:
    signals = people(rng)
    asked = said(works_with_graphics=["no"] * 15 + ["yes"] * 15)
    less = group_effects(signals, asked, {"p0": 0.1, "p20": 0.9})
    own = less[less["question"] == "works_with_graphics"]
    assert own[["people", "others"]].drop_duplicates().to_numpy().tolist() == [[14, 15]]


def test_people_all_alike_are_a_statement(rng: np.random.Generator) -> None:
    signals = people(rng).assign(bias=0.0, inconsistency=0.0, slope=np.nan)
    found = group_effects(signals, said(works_with_graphics=["no"] * 15 + ["yes"] * 15))
    own = found[found["question"] == "works_with_graphics"]
    assert set(own["note"]) == {"people do not differ"}
    assert own["p"].isna().all()


@pytest.mark.parametrize("count", [10, 24])
def test_groups_of_chance_seldom_differ(rng: np.random.Generator, count: int) -> None:
    """Before the adjustment: at most 7 in 100 (here of 600)."""
    rejected = []
    for _ in range(600):
        values = rng.standard_normal(count) + 0.7 * rng.exponential(size=count)
        half = rng.permutation(count) < count * 6 // 10
        found = welch(values[half], values[~half])
        assert found is not None
        rejected.append(found.p < 0.05)
    assert np.mean(rejected) <= 0.07


def test_a_detectable_difference_is_found_in_four_of_five_studies(rng: np.random.Generator) -> None:
    found, detectable = [], []
    for _ in range(300):
        own, others = rng.standard_normal(12) + 1.2, rng.standard_normal(12)
        result = welch(own, others)
        assert result is not None
        found.append(result.p < 0.05)
        detectable.append(result.detectable)
    assert np.mean(detectable) == pytest.approx(1.2, abs=0.05)
    assert np.mean(found) == pytest.approx(0.8, abs=0.06)
