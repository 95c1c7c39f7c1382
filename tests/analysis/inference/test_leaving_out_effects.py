"""Verdicts on single effects without each person: as decisions on refitted tables say."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.audit import audit_tables
from analysis.charts.decision import NO_ORDER, decision_chart
from analysis.charts.material import Material
from analysis.decision.effects import decide_effects, decided, levels_of
from analysis.inference.deciding import fit_noticing, fit_realism
from analysis.inference.inferring import Inference, infer
from analysis.inference.leaving_out import COLUMNS
from analysis.inference.leaving_out_effects import effects_without_each
from analysis.report.limits import limits
from analysis.screening.sensitivity import without
from analysis.simulation.observers import Stimulus
from analysis.simulation.simulated import simulate_tables
from analysis.tables.columns import EFFECTS
from analysis.tables.ordering import lod_ranks
from analysis.tables.reading import Tables, tables_from


@pytest.fixture(scope="module")
def ablation() -> Tables:
    """Return seven people's answers to one effect left out at two distances."""
    without_one = dict.fromkeys(EFFECTS, "ultra") | {"reflection": "off"}
    clips = {
        f"{distance}-{right}": Stimulus(
            distance,
            iris_px,
            "ultra",
            right,
            right_levels=without_one if right != "ultra" else {},
        )
        for distance, iris_px in (("near", 160.0), ("far", 12.0))
        for right in ("no-reflection", "ultra")
    }
    return tables_from(simulate_tables(clips, np.random.default_rng(8), participants=7))


@pytest.fixture(scope="module")
def inference(ablation: Tables) -> Inference:
    return infer(ablation)


def test_each_verdict_is_told_without_each_person(ablation: Tables, inference: Inference) -> None:
    own = inference
    found = effects_without_each(
        own.effects, own.realism, own.noticing, comparisons=ablation.comparisons
    )
    assert tuple(found.columns) == COLUMNS
    assert len(own.effects) == 2
    assert len(found) == 2 * 7
    assert (found["is_moved"] == (found["verdict"] != found["usual"])).all()
    usual = {(v.distance, v.lod): v.outcome for v in own.effects}
    named = zip(found["distance"], found["lod"], strict=True)
    assert found["usual"].tolist() == [usual[cell] for cell in named]
    told = found.set_index(["people", "distance", "lod"])["verdict"]
    for who in found["people"].unique()[:2]:
        rest = without(ablation, [who])
        realism = fit_realism(rest, None, near=own.realism)
        assert realism is not None
        for verdict in decide_effects(
            realism,
            fit_noticing(rest, None, near=own.noticing),
            lod_ranks(rest.ratings),
            levels=levels_of(rest.ratings),
            margins=own.margins,
        ):
            assert told[who, verdict.distance, verdict.lod] == verdict.outcome


def test_an_effect_at_its_margin_moves_with_a_person(
    ablation: Tables, inference: Inference
) -> None:
    """With p just below the level, whoever made the difference takes the verdict along."""
    own = inference.effects[0]
    assert inference.realism is not None
    draws = inference.realism.expected()[1]
    cells = inference.realism.cells
    top, low = (cells.index((own.distance, lod)) for lod in (own.best, own.lod))
    bound = float(np.quantile(draws[:, top] - draws[:, low], 0.047))
    tight = replace(own.realism, margin=bound, p_within=0.047)
    (verdict,) = decided([replace(own, realism=tight, noticed=None)])
    assert verdict.outcome == "different"
    found = effects_without_each(
        [verdict], inference.realism, None, comparisons=ablation.comparisons
    )
    assert 0 < found["is_moved"].sum() < 7


def test_without_effects_nobody_is_left_out(inference: Inference) -> None:
    nothing = pd.DataFrame()
    assert effects_without_each((), inference.realism, None, comparisons=nothing).empty
    assert effects_without_each(inference.effects, None, None, comparisons=nothing).empty


def test_the_report_contradicts_no_verdict_on_an_effect(
    ablation: Tables, inference: Inference
) -> None:
    """Without a sequence there are verdicts all the same: neither limits nor charts deny them."""
    audit = audit_tables(ablation.ratings, ablation.comparisons)
    told = " ".join(limits(ablation, audit, inference))
    assert "There is no verdict" not in told
    open_ones = [own for own in inference.effects if own.outcome == "not shown"]
    assert all(f"{own.lod} at {own.distance}" in told for own in open_ones[:1])
    figure = decision_chart(Material(ablation, inferred=inference))
    text = " ".join(own.get_text() for own in figure.texts).replace("\n", " ")
    assert NO_ORDER in text
