"""Single effects: three verdicts, adjusted over distances, with what they save."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
import pytest

from analysis.costs.cost import COLUMNS, EFFECT_COLUMNS, Costs
from analysis.decision.effect_sentences import effect_answers
from analysis.decision.effects import (
    Change,
    EffectVerdict,
    decide_effects,
    levels_of,
    saving_of,
)
from analysis.decision.margins import Margins
from analysis.decision.verdict_tables import effect_table
from analysis.decision.verdicts import DIFFERENT, EQUIVALENT, NOT_SHOWN
from analysis.estimates.multiplicity import holm
from analysis.tables.columns import EFFECTS

RANKS = {"low": 0.0, "ultra": 3.0, "no-caustics": -1.0, "dull": -1.0}
ULTRA = dict.fromkeys(EFFECTS, "ultra")
LEVELS = {
    "ultra": ULTRA,
    "no-caustics": ULTRA | {"caustics": "off"},
    "dull": ULTRA | {"texture": "low", "sclera": "off"},
}
Z = np.linspace(-3, 3, 2001)
DISTANCES = ("near", "medium", "far")


@dataclass
class Rated:
    """Stands for Realism: no-caustics lies below ultra by a gap of its own at each distance."""

    gaps: dict[str, float]
    spread: float = 0.1
    lod: str = "no-caustics"

    @property
    def cells(self) -> tuple[tuple[str, str], ...]:
        return tuple((d, lod) for d in self.gaps for lod in (self.lod, "ultra"))

    def expected(self) -> tuple[np.ndarray, np.ndarray]:
        values = np.array([v for gap in self.gaps.values() for v in (3.0 - gap, 3.0)])
        return values, values + self.spread * np.outer(Z, [1.0, 0.0] * len(self.gaps))


@dataclass
class Seen:
    """Stands for Noticing: false alarms of 10 %."""

    excess: dict[str, float]
    lod: str = "no-caustics"

    @property
    def pairs(self) -> tuple[tuple[str, str, str], ...]:
        return tuple((d, self.lod, "ultra") for d in self.excess)

    def shares(self) -> tuple[np.ndarray, np.ndarray]:
        values = 0.1 + np.array(list(self.excess.values()))
        return values, values + 0.02 * Z[:, None]

    def false_alarms(self) -> tuple[float, np.ndarray]:
        return 0.1, np.full(len(Z), 0.1)


def decided(
    gaps: dict[str, float], excess: dict[str, float] | None, lod: str = "no-caustics"
) -> list[EffectVerdict]:
    seen = None if excess is None else Seen(excess, lod)
    return decide_effects(Rated(gaps, lod=lod), seen, RANKS, levels=LEVELS, margins=Margins())


UNSEEN = dict.fromkeys(DISTANCES, 0.02)


def test_each_distance_gets_one_of_three_verdicts() -> None:
    found = decided({"near": 0.9, "medium": 0.42, "far": 0.0}, UNSEEN)
    assert [own.outcome for own in found] == [DIFFERENT, NOT_SHOWN, EQUIVALENT]
    assert {(own.lod, own.best, own.name) for own in found} == {
        ("no-caustics", "ultra", "without caustics")
    }
    noticed = decided({"near": 0.0}, {"near": 0.8})
    assert noticed[0].outcome == DIFFERENT
    assert decided({"near": 0.0}, None)[0].outcome == NOT_SHOWN  # nobody knows what is noticed


def test_p_values_are_adjusted_over_the_distances_after_holm() -> None:
    gaps = {"near": 0.23, "medium": 0.22, "far": 0.21}
    alone = [decided({d: gap}, UNSEEN)[0].p_equivalent for d, gap in gaps.items()]
    together = [own.p_equivalent for own in decided(gaps, UNSEEN)]
    assert together == pytest.approx(holm(alone))
    assert together[0] > alone[2]
    # What holds alone at 5 % need not hold among three.
    assert decided({"near": 0.22}, UNSEEN)[0].outcome == EQUIVALENT
    several = decided({"near": 0.22, "medium": 0.9, "far": 0.9}, UNSEEN)
    assert several[0].outcome == NOT_SHOWN


def test_lods_with_a_rank_belong_to_the_sequence_and_not_here() -> None:
    assert decided({"near": 0.0}, UNSEEN, lod="low") == []
    no_best = Rated({"near": 0.0})
    ranks = dict.fromkeys(RANKS, -1.0)
    assert decide_effects(no_best, None, ranks, levels=LEVELS, margins=Margins()) == []


def test_changes_are_read_from_the_levels() -> None:
    frame = pd.DataFrame(
        {"lod": list(LEVELS), **{e: [LEVELS[k][e] for k in LEVELS] for e in EFFECTS}}
    )
    assert levels_of(frame) == LEVELS
    assert levels_of(pd.DataFrame({"lod": ["ultra"]})) == {"ultra": {}}
    dull = decided({"near": 0.0}, None, lod="dull")[0]
    assert dull.changes == (Change("texture", "ultra", "low"), Change("sclera", "ultra", "off"))
    assert dull.name == "texture at low and without sclera"


def costs() -> Costs:
    rows = [
        ("gl", "640x360", 1, "macroscopic", "caustics", "ultra", "ultra", 8.0, 1.0, 9),
        ("gl", "640x360", 1, "macroscopic", "texture", "ultra", "ultra", 15.0, 1.0, 9),
        ("gl", "640x360", 1, "macroscopic", "texture", "low", "ultra", 4.0, 1.0, 9),
    ]
    effects = pd.DataFrame(rows, columns=list(EFFECT_COLUMNS))
    return Costs(pd.DataFrame(columns=list(COLUMNS)), "no LoD was measured", effects=effects)


def test_a_saving_is_the_effects_own_and_names_where_it_was_measured() -> None:
    own = decided({"near": 0.0}, UNSEEN)[0]
    saving = saving_of(own, costs())
    assert saving is not None
    half = 1.959964 * 1.2533 * 1.4826 / 3
    assert (saving.ms, saving.high - saving.ms) == pytest.approx((8.0, half), rel=1e-3)
    assert saving.condition == "macroscopic, one eye, 640x360 pixels, gl"
    texture = EffectVerdict(**{**vars(own), "changes": (Change("texture", "ultra", "low"),)})
    lower = saving_of(texture, costs())
    assert lower is not None
    assert lower.ms == pytest.approx(11.0)
    both = EffectVerdict(**{**vars(own), "changes": (*own.changes, *texture.changes)})
    assert saving_of(both, costs()) is None  # effects share work: their times cannot be added
    assert saving_of(own, None) is None


def test_the_sentence_names_every_distance_and_what_is_saved() -> None:
    found = decided({"near": 0.9, "medium": 0.42, "far": 0.0}, UNSEEN)
    ((name, text),) = effect_answers(found, costs())
    assert name == "without caustics"
    assert text.startswith("enough instead of ultra at far (rated at most 0.27 points lower")
    assert "; not enough at near (rated 0.90 points lower" in text
    assert "; not shown at medium (up to 0.69 points lower" in text
    assert text.endswith("measured at macroscopic, one eye, 640x360 pixels, gl.")
    assert "it saves 8.0\N{NO-BREAK SPACE}ms per eye (6.8" in text
    assert effect_answers([]) == ()


def test_the_table_has_the_documented_columns() -> None:
    found = decided({"near": 0.9, "far": 0.0}, UNSEEN)
    assert list(effect_table(found)) == [
        *("distance", "lod", "best", "change", "verdict"),
        *("realism_loss", "realism_loss_low", "realism_loss_high", "realism_margin"),
        *("noticed_excess", "noticed_excess_low", "noticed_excess_high", "noticed_margin"),
        *("p_equivalent", "p_different"),
    ]
    priced = effect_table(found, costs())
    assert priced["ms_saved"].tolist() == [8.0, 8.0]
    assert effect_table(decided({"near": 0.0}, None))["noticed_margin"].isna().all()
