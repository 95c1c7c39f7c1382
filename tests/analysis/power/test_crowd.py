"""Many observers at once answer as single ones do."""

from __future__ import annotations

import numpy as np
import pytest

from analysis.power.assumed import thesis_like
from analysis.power.crowd import NOTHING, Answers, answer_all, draw_crowd
from analysis.simulation.observers import Stimulus, draw_observer
from analysis.simulation.population import POPULATION

CLIPS = (
    Stimulus("macroscopic", 350.0, "low", "ultra"),
    Stimulus("near", 160.0, "high", "medium"),
    Stimulus("far", 12.0, "ultra", "ultra"),
)
PEOPLE = 4000


@pytest.fixture(scope="module")
def crowd_answers() -> Answers:
    truth, rng = thesis_like(CLIPS), np.random.default_rng(5)
    clip = np.tile(np.arange(3), PEOPLE)
    left, right = (
        np.array([truth.realism[c.distance, lod] for c in CLIPS for lod in (getattr(c, side),)])
        for side in ("left_lod", "right_lod")
    )
    d = np.array([truth.sensitivity.get((c.distance, c.left_lod, c.right_lod), 0.0) for c in CLIPS])
    return answer_all(
        draw_crowd(rng, PEOPLE),
        rng,
        person=np.repeat(np.arange(PEOPLE), 3),
        position=clip + 1,
        left=left[clip],
        right=right[clip],
        sensitivity=d[clip],
    )


@pytest.fixture(scope="module")
def single_answers() -> np.ndarray:
    rng = np.random.default_rng(7)
    grades = {"no": 0, "unsure": 1, "yes": 2, None: NOTHING}
    rows = []
    for _ in range(PEOPLE // 4):
        person = draw_observer(rng)
        for position, clip in enumerate(CLIPS, start=1):
            given = person.answer(clip, rng, position=position)
            values = (given.left_rating, given.right_rating, given.comparison)
            rows.append([*(NOTHING if v is None else v for v in values), grades[given.noticed]])
    return np.array(rows).reshape(-1, 3, 4)


def test_every_answer_is_as_frequent_as_with_single_observers(
    crowd_answers: Answers, single_answers: np.ndarray
) -> None:
    crowd = np.stack(crowd_answers.columns(), axis=1).reshape(-1, 3, 4)
    for clip in range(3):
        for question in range(4):
            for value in np.unique(single_answers[:, clip, question]):
                shares = [np.mean(a[:, clip, question] == value) for a in (crowd, single_answers)]
                # five standard errors of the smaller sample
                error = 5 * np.sqrt(max(shares[0] * (1 - shares[0]), 1e-3) / (PEOPLE // 4))
                assert shares[0] == pytest.approx(shares[1], abs=error)


def test_answers_of_one_person_hang_together_as_with_single_observers(
    crowd_answers: Answers, single_answers: np.ndarray
) -> None:
    crowd = np.stack(crowd_answers.columns(), axis=1).reshape(-1, 3, 4)
    found = []
    for answers in (crowd, single_answers):
        both = answers[(answers[:, 2, :3] != NOTHING).all(axis=1)][:, 2]
        found.append(np.corrcoef(both[:, :3].T)[np.triu_indices(3, 1)])
    np.testing.assert_allclose(found[0], found[1], atol=0.15)
    assert found[0][0] > 0.1  # leniency is shared by both eyes


def test_a_crowd_is_drawn_from_the_population() -> None:
    crowd = draw_crowd(np.random.default_rng(2), 20_000)
    assert crowd.is_expert.mean() == pytest.approx(POPULATION.share_of_experts, abs=0.02)
    assert crowd.end_avoidance.mean() == pytest.approx(0.30, abs=0.01)
    assert (crowd.criteria[0] <= crowd.criteria[1]).all()
