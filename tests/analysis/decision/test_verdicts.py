"""Verdicts: the three of them, the sequence, the shares of draws."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from analysis.decision import verdicts
from analysis.decision.verdict_tables import verdict_table
from analysis.decision.verdicts import (
    DIFFERENT,
    EQUIVALENT,
    NOT_SHOWN,
    Decision,
    Margins,
    decide,
)

RANKS = {"low": 0.0, "medium": 1.0, "high": 2.0, "ultra": 3.0, "plain": -1.0}
Z = np.linspace(-3, 3, 2001)  # evenly spread draws: quantiles are read off


@dataclass
class Rated:
    """Stands for Realism: the cells' mean ratings and draws."""

    means: dict[str, float]
    spread: float = 0.02

    @property
    def cells(self) -> tuple[tuple[str, str], ...]:
        return tuple(("near", lod) for lod in self.means)

    def expected(self) -> tuple[np.ndarray, np.ndarray]:
        values = np.array(list(self.means.values()))
        own = np.where(np.array(list(self.means)) == "ultra", 0.0, 1.0)
        return values, values + self.spread * np.outer(Z, own)


@dataclass
class Seen:
    """Stands for Noticing: each pair's share of yes, and false alarms of 10 %."""

    yes: dict[str, float]
    spread: float = 0.02

    @property
    def pairs(self) -> tuple[tuple[str, str, str], ...]:
        return tuple(("near", lod, "ultra") for lod in self.yes)

    def shares(self) -> tuple[np.ndarray, np.ndarray]:
        values = np.array(list(self.yes.values()))
        return values, values + self.spread * Z[:, None]

    def false_alarms(self) -> tuple[float, np.ndarray]:
        return 0.1, np.full(len(Z), 0.1)


MEANS = {"low": 1.8, "medium": 2.8, "high": 3.0, "ultra": 3.1}
UNSEEN = {"low": 0.15, "medium": 0.15, "high": 0.12}


def decided(means: dict[str, float], yes: dict[str, float] | None, **margins: float) -> Decision:
    noticing = None if yes is None else Seen(yes)
    found = decide(Rated(means), noticing, RANKS, margins=Margins(**margins))
    assert len(found) == 1
    return found[0]


def outcomes(decision: Decision) -> dict[str, str]:
    return {verdict.lod: verdict.outcome for verdict in decision.verdicts}


def test_the_cheapest_is_the_last_that_passes_from_the_highest_down() -> None:
    decision = decided(MEANS, UNSEEN)
    assert outcomes(decision) == {"high": EQUIVALENT, "medium": EQUIVALENT, "low": DIFFERENT}
    assert (decision.best, decision.lod) == ("ultra", "medium")
    assert [v.share_cheapest for v in decision.verdicts] == [0.0, 1.0, 0.0]
    assert decision.best_share == 0.0


def test_what_is_noticed_is_not_equivalent_however_real_it_looks() -> None:
    decision = decided(MEANS, UNSEEN | {"medium": 0.9})
    assert outcomes(decision) == {"high": EQUIVALENT, "medium": DIFFERENT, "low": DIFFERENT}
    assert decision.lod == "high"


def test_a_lod_after_the_first_failure_is_not_tested() -> None:
    decision = decided(MEANS | {"medium": 2.59, "low": 3.1}, UNSEEN)  # medium: .51, unclear
    assert outcomes(decision) == {"high": EQUIVALENT, "medium": NOT_SHOWN, "low": NOT_SHOWN}
    assert [v.is_reached for v in decision.verdicts] == [True, True, False]
    assert decision.lod == "high"


def test_not_knowing_whether_it_was_noticed_is_not_equality() -> None:
    decision = decided(MEANS, None)
    assert outcomes(decision) == {"high": NOT_SHOWN, "medium": NOT_SHOWN, "low": DIFFERENT}
    assert decision.lod == "ultra"


def test_the_bounds_are_one_sided_at_the_stated_confidence() -> None:
    high = decided(MEANS, UNSEEN, confidence=0.975).verdicts[0].realism
    bound = 0.02 * np.quantile(Z, 0.975)
    assert (high.value, high.low, high.high) == pytest.approx((0.1, 0.1 - bound, 0.1 + bound))


def test_shares_say_how_often_each_is_the_cheapest() -> None:
    decision = decided(MEANS | {"high": 2.6}, UNSEEN)  # a gap of .5: in half of the draws enough
    high, medium, _ = decision.verdicts
    assert medium.share_cheapest == pytest.approx(0.5, abs=0.01)
    assert high.share_cheapest == 0.0
    assert decision.best_share == pytest.approx(0.5, abs=0.01)


def test_lods_without_a_rank_and_lonely_ones_are_left_out() -> None:
    assert outcomes(decided({"plain": 3.0, **MEANS}, UNSEEN)).keys() == {"high", "medium", "low"}
    assert decide(Rated({"ultra": 3.0}), Seen({}), RANKS) == []


def test_the_table_has_a_row_for_every_verdict() -> None:
    decision = decided(MEANS, UNSEEN)
    table = verdict_table([decision, replace(decision, distance="far")])
    assert table["lod"].tolist() == ["high", "medium", "low"] * 2
    assert table["chosen"].tolist() == [False, True, False] * 2
    assert table["noticed_excess"].tolist() == pytest.approx([0.02, 0.05, 0.05] * 2)


def test_impossible_margins_are_refused() -> None:
    with pytest.raises(
        ValueError, match=r"noticed_margin: found 1.5; accepted: above 0 and below 1"
    ):
        Margins(noticed_share=1.5)
    assert Margins() == verdicts.DEFAULT
