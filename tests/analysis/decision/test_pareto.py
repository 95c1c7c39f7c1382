"""Realism against cost: who dominates whom, in how many draws; what a LoD saves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
import pytest

from analysis.costs.cost import COLUMNS, Costs
from analysis.costs.savings import Saving, cost_draws, lod_saving, saving_columns
from analysis.decision.pareto import pareto, pareto_sentences, pareto_table
from analysis.decision.sentences import price
from analysis.models.draws import DRAWS


@dataclass
class Rated:
    """Stands for Realism at one distance: means and a common spread of independent draws."""

    means: dict[str, float]
    spread: float = 1e-6

    @property
    def cells(self) -> tuple[tuple[str, str], ...]:
        return tuple(("near", lod) for lod in self.means)

    def expected(self) -> tuple[np.ndarray, np.ndarray]:
        values = np.array(list(self.means.values()))
        noise = np.random.default_rng(1).standard_normal((DRAWS, len(values)))
        return values, values + self.spread * noise


def costs(ms: dict[str, float], mad: float = 0.0) -> Costs:
    rows = [("gl", "1920x1080", 2, "near", 160.0, lod, own, mad, 9) for lod, own in ms.items()]
    return Costs(pd.DataFrame(rows, columns=list(COLUMNS)), "2 eyes, 1920x1080 pixels, gl", 2.0)


def test_a_lod_is_dominated_by_one_that_costs_no_more_and_looks_no_worse() -> None:
    rated = Rated({"low": 2.0, "medium": 2.9, "high": 2.5, "ultra": 3.0})
    found = {
        own.lod: own for own in pareto(rated, costs({"low": 1, "medium": 2, "high": 3, "ultra": 4}))
    }
    assert {lod: own.is_on_front for lod, own in found.items()} == {
        "low": True,
        "medium": True,
        "high": False,
        "ultra": True,
    }
    assert (found["high"].share_dominated, found["high"].dominated_by) == (1.0, "medium")
    assert found["low"].dominated_by == ""


def test_of_two_that_cost_the_same_the_less_real_is_dominated() -> None:
    found = pareto(Rated({"low": 2.0, "ultra": 3.0}), costs({"low": 5.0, "ultra": 5.0}))
    assert [own.share_dominated for own in found] == [1.0, 0.0]
    equal = pareto(Rated({"low": 3.0, "ultra": 3.0}, spread=0.0), costs({"low": 5.0, "ultra": 5.0}))
    assert [own.share_dominated for own in equal] == [0.0, 0.0]


def test_the_share_of_draws_carries_both_uncertainties() -> None:
    same = pareto(
        Rated({"low": 3.0, "ultra": 3.0}, spread=0.1), costs({"low": 5.0, "ultra": 5.0}, 1.0)
    )
    for own in same:  # cheaper or dearer, better or worse: one of four
        assert own.share_dominated == pytest.approx(0.25, abs=0.03)
    low = same[0]
    error = 1.2533 * 1.4826 / 3
    assert low.ms[2] - low.ms[0] == pytest.approx(1.96 * error, rel=0.08)
    assert low.rating[2] - low.rating[0] == pytest.approx(0.196, rel=0.08)


def test_lods_that_were_not_timed_have_no_point() -> None:
    rated = Rated({"low": 2.0, "medium": 2.5, "ultra": 3.0})
    found = pareto(rated, costs({"low": 1.0, "ultra": 4.0}))
    assert [own.lod for own in found] == ["low", "ultra"]
    alone = pareto(rated, costs({"low": 1.0}))
    assert (alone[0].share_dominated, alone[0].is_on_front) == (0.0, True)
    assert pareto(rated, costs({})) == ()
    assert cost_draws(costs({"low": 1.0}), "far", "low") is None


def test_the_table_and_the_sentences_name_the_dominated() -> None:
    found = pareto(Rated({"low": 2.0, "medium": 1.0}), costs({"low": 1.0, "medium": 2.0}))
    table = pareto_table(found)
    assert list(table) == [
        *("distance", "lod", "ms", "ms_low", "ms_high", "rating", "rating_low", "rating_high"),
        *("share_dominated", "dominated_by", "share_dominated_by", "is_on_front"),
    ]
    assert table["dominated_by"].tolist() == ["", "low"]
    assert pareto_sentences(found) == (
        "near: dominated in realism and cost: medium (in 100\N{NO-BREAK SPACE}% of the draws, "
        "mostly by low).",
    )
    apart = pareto(Rated({"low": 2.0, "ultra": 3.0}), costs({"low": 1.0, "ultra": 2.0}))
    assert pareto_sentences(apart) == (
        "near: no LoD is dominated; what costs more looks more real.",
    )


def test_a_saving_is_per_eye_with_the_share_of_the_frame() -> None:
    saving = lod_saving(costs({"low": 60.0, "ultra": 100.0}, 1.0), "near", "low", best="ultra")
    assert saving is not None
    assert (saving.ms, saving.share) == pytest.approx((20.0, 0.4))
    error = np.sqrt(2) * 1.2533 * 1.4826 / 3 / 2
    assert saving.high - saving.low == pytest.approx(2 * 1.96 * error, rel=0.08)
    assert price(saving).startswith("it saves 20.0\N{NO-BREAK SPACE}ms per eye (19.")
    assert "40\N{NO-BREAK SPACE}% of the frame (39" in price(saving)
    assert saving_columns(saving)["ms_saved"] == pytest.approx(20.0)
    assert np.isnan(saving_columns(None)["ms_saved"])
    assert lod_saving(costs({"low": 60.0}), "near", "low", best="ultra") is None


def test_nothing_saved_is_said_so() -> None:
    assert price(Saving(1.0, -1.0, 3.0, "")) == (
        "it saves 1.0\N{NO-BREAK SPACE}ms per eye (−1.0\N{NO-BREAK SPACE}ms to "
        "3.0\N{NO-BREAK SPACE}ms), not told apart from nothing"
    )
    assert price(Saving(-2.0, -3.0, -1.0, "")) == (
        "it saves nothing: 2.0\N{NO-BREAK SPACE}ms per eye are added"
    )
