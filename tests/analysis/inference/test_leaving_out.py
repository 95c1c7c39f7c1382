"""Verdicts without each person: as refits say, and which person moves which."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.inference import leaving_out
from analysis.inference.deciding import decisions_of
from analysis.inference.inferring import Inference, infer
from analysis.inference.leaving_out import COLUMNS, verdicts_without_each
from analysis.screening.sensitivity import without
from analysis.tables.reading import Tables


@pytest.fixture(scope="module")
def inference(thesis_tables: Tables) -> Inference:
    return infer(thesis_tables)


def test_verdicts_are_those_of_fits_without_the_person(
    thesis_tables: Tables, inference: Inference
) -> None:
    found = verdicts_without_each(
        inference.decisions,
        inference.realism,
        inference.noticing,
        comparisons=thesis_tables.comparisons,
    )
    assert tuple(found.columns) == COLUMNS
    assert len(found) == 10 * sum(len(own.verdicts) for own in inference.decisions)
    assert (found["is_moved"] == (found["verdict"] != found["usual"])).all()
    told = found.set_index(["people", "distance", "lod"])["verdict"]
    near = (inference.realism, inference.noticing)
    for who in found["people"].unique()[:3]:
        for own in decisions_of(without(thesis_tables, [who]), near=near):
            for verdict in own.verdicts:
                assert told[who, own.distance, verdict.lod] == verdict.outcome


def test_one_step_lands_beside_the_fit_without_the_person(
    inference: Inference, monkeypatch: pytest.MonkeyPatch
) -> None:
    fit, people = inference.realism.fit, inference.realism.stimuli.people
    exact = leaving_out._moved(fit, people, people)
    monkeypatch.setattr(leaving_out, "is_refitted", lambda _fit: False)
    step = leaving_out._moved(fit, people, people)
    moved, error = np.abs(exact - fit.parameters), np.abs(step - exact)
    assert error.mean() < 0.35 * moved.mean()
    assert (
        np.corrcoef((exact - fit.parameters).ravel(), (step - fit.parameters).ravel())[0, 1] > 0.9
    )


def test_a_verdict_at_its_margin_moves_with_a_person(
    thesis_tables: Tables, inference: Inference
) -> None:
    """With the upper bound just below the margin, whoever held it down takes the verdict along."""
    realism = inference.realism
    own = inference.decisions[-1]
    test = own.verdicts[0].realism
    tight = replace(test, margin=test.low - 0.001)  # shown to be too much, by a hair
    decision = replace(own, verdicts=(replace(own.verdicts[0], realism=tight),))
    found = verdicts_without_each([decision], realism, None, comparisons=thesis_tables.comparisons)
    assert (found["usual"] == "different").all()
    assert 0 < found["is_moved"].sum() < 10


def test_of_two_people_neither_can_be_left_out(inference: Inference) -> None:
    realism = inference.realism
    two = replace(realism, stimuli=replace(realism.stimuli, people=("A", "B")))
    nothing = pd.DataFrame()
    assert verdicts_without_each(inference.decisions, two, None, comparisons=nothing).empty
