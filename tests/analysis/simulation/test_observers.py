"""Simulated observers against the check values of the reference, section 5.3.

Tolerances are about three standard errors of the simulation here (200 studies of 10 people).
"""

from dataclasses import dataclass

import numpy as np
import pytest

from analysis.simulation.observers import CHOICES, Answer, Stimulus, draw_observer
from analysis.simulation.population import POPULATION, rank_of
from analysis.tables.columns import EFFECTS, STANDARD_LODS

STUDIES = 200


@dataclass
class Simulated:
    """Answers of 200 simulated thesis studies, by clip."""

    ratings: np.ndarray  # (studies, people, clips, eyes), nan where missing
    comparison: np.ndarray  # (studies, people, clips)
    noticed: list[list[str | None]]


@pytest.fixture(scope="module")
def simulated(thesis_clips: dict[str, Stimulus]) -> Simulated:
    rng = np.random.default_rng(53)
    clips = list(thesis_clips.values())
    ratings = np.full((STUDIES, 10, 7, 2), np.nan)
    comparison = np.full((STUDIES, 10, 7), np.nan)
    noticed: list[list[str | None]] = [[] for _ in clips]
    for study in range(STUDIES):
        for person in range(10):
            observer = draw_observer(rng, is_expert=person < 6)
            for k, clip in enumerate(clips):
                answer = observer.answer(clip, rng)
                ratings[study, person, k] = [
                    np.nan if r is None else r for r in (answer.left_rating, answer.right_rating)
                ]
                if answer.comparison is not None:
                    comparison[study, person, k] = answer.comparison
                noticed[k].append(answer.noticed)
    return Simulated(ratings, comparison, noticed)


def test_latent_realism_gives_the_populations_mean_ratings() -> None:
    latent = np.array(list(POPULATION.latent.values()))
    wanted = np.array(list(POPULATION.mean_ratings.values()))
    np.testing.assert_allclose(POPULATION.mean_rating(latent), wanted, atol=1e-9)


def test_mean_rating_agrees_with_simulated_people(rng: np.random.Generator) -> None:
    people = [draw_observer(rng) for _ in range(4000)]
    ratings = [o._rate(o.leniency + o.noise * rng.standard_normal() + 0.3, rng) for o in people]
    assert np.mean(ratings) == pytest.approx(float(POPULATION.mean_rating(np.array(0.3))), abs=0.06)


def test_perfect_fives_are_as_rare_as_in_the_thesis(simulated: Simulated) -> None:
    fives = (simulated.ratings == 5).sum(axis=(1, 2, 3))
    assert fives.mean() == pytest.approx(6.07, abs=0.65)
    assert fives.std() == pytest.approx(2.9, abs=0.5)


def test_low_is_rated_highest_at_far(simulated: Simulated) -> None:
    means = np.nanmean(simulated.ratings, axis=1)
    low_at_far = means[:, 6, 1]
    elsewhere = np.stack([means[:, 0, 1], means[:, 3, 0], means[:, 4, 0], means[:, 5, 1]])
    assert low_at_far.mean() == pytest.approx(2.475, abs=0.06)
    assert low_at_far.std() == pytest.approx(0.29, abs=0.045)
    assert (low_at_far > elsewhere.max(axis=0)).mean() == pytest.approx(0.97, abs=0.04)


def test_shares_of_the_five_ratings(simulated: Simulated) -> None:
    found = [(simulated.ratings == k).sum() for k in range(1, 6)]
    shares = np.array(found) / np.sum(found)
    np.testing.assert_allclose(shares, [0.19, 0.30, 0.29, 0.18, 0.04], atol=0.015)


def test_comparison_shares(simulated: Simulated) -> None:
    shares = np.stack([(simulated.comparison == c).mean(axis=(0, 1)) for c in (-1, 0, 1)], axis=1)
    shares /= shares.sum(axis=1, keepdims=True)
    wanted = [
        [0.88, 0.10, 0.03],
        [0.18, 0.30, 0.52],
        [0.36, 0.34, 0.30],
        [0.03, 0.10, 0.87],
        [0.07, 0.18, 0.76],
        [0.85, 0.11, 0.03],
        [0.42, 0.33, 0.25],
    ]
    np.testing.assert_allclose(shares, wanted, atol=0.035)


def test_nearly_everyone_notices_refraction_and_few_dynamic_reflection(
    simulated: Simulated,
) -> None:
    yes = [answers.count("yes") / len(answers) for answers in simulated.noticed]
    assert yes[0] == pytest.approx(0.92, abs=0.03)
    assert yes[1] == pytest.approx(0.21, abs=0.04)
    assert yes[2] == pytest.approx(0.94, abs=0.03)


def test_questions_are_skipped_in_one_to_three_of_a_hundred(simulated: Simulated) -> None:
    assert np.isnan(simulated.ratings).mean() == pytest.approx(0.02, abs=0.003)


def test_identical_eyes_are_rarely_seen_as_different(rng: np.random.Generator) -> None:
    catch = Stimulus("macroscopic", 350.0, "high", "high")
    answers = [draw_observer(rng).answer(catch, rng) for _ in range(1500)]
    false_alarms = np.mean([a.noticed == "yes" for a in answers])
    assert false_alarms == pytest.approx(0.10, abs=0.03)


def test_same_seed_same_answers() -> None:
    def session(seed: int) -> list[Answer]:
        rng = np.random.default_rng(seed)
        observer = draw_observer(rng)
        clip = Stimulus("near", 160.0, "low", "ultra")
        return [observer.answer(clip, rng, position=k) for k in range(1, 8)]

    assert session(3) == session(3)
    assert session(3) != session(4)


def test_words_name_only_effects_that_differ(rng: np.random.Generator) -> None:
    """Between high and ultra only the reflection crosses a level that anyone mentions."""
    clip = Stimulus("macroscopic", 350.0, "ultra", "high")
    observer = draw_observer(rng, is_expert=True)
    said = {observer.answer(clip, rng).what_differed for _ in range(400)} - {None}
    about_reflection = {words for words in said if words and "left eye" in words}
    assert about_reflection
    assert not any("pupil" in words or "veins" in words for words in said if words)


def test_a_named_lod_lies_between_the_ranks_of_its_levels() -> None:
    levels = dict.fromkeys(EFFECTS, "ultra") | {"caustics": "off"}
    rank = rank_of("ultra-no-caustics", levels)
    assert rank == pytest.approx(6 * 4 / 7)
    low, ultra = POPULATION.realism("near", 160.0, 3.0), POPULATION.realism("near", 160.0, 4.0)
    assert low < POPULATION.realism("near", 160.0, rank) < ultra
    assert POPULATION.realism("near", 160.0, 0.0) < POPULATION.realism("near", 160.0, 1.0)


def test_a_named_lod_without_levels_is_refused(rng: np.random.Generator) -> None:
    clip = Stimulus("near", 160.0, "low", "shiny")
    with pytest.raises(ValueError, match='LoD "shiny" has no rank and no levels were given; acc'):
        draw_observer(rng).answer(clip, rng)


def test_a_distance_of_its_own_is_interpolated_in_pixels() -> None:
    between = POPULATION.realism("conversation", 80.0, 1.0)
    assert POPULATION.latent["near"][0] < between < POPULATION.latent["medium"][0]
    assert POPULATION.realism("elsewhere", 160.0, 4.0) == pytest.approx(
        POPULATION.latent["near"][3]
    )


def test_sensitivity_is_symmetric_and_zero_between_equal_standard_lods() -> None:
    for a in range(1, 5):
        assert POPULATION.pair_sensitivity(a, a) == 0.0
        for b in range(1, 5):
            assert POPULATION.pair_sensitivity(a, b) == POPULATION.pair_sensitivity(b, a)
    assert len(STANDARD_LODS) == len(POPULATION.sensitivity)


def test_about_you_uses_the_studys_choices(rng: np.random.Generator) -> None:
    own = {"last_played": ["today", "long ago"], "gender": ["x"], "eyesight": ["fine"]}
    expert = draw_observer(rng, is_expert=True).about_you(rng, own)
    other = draw_observer(rng, is_expert=False).about_you(rng, own)
    assert (expert["works_with_graphics"], expert["last_played"]) == ("yes", "today")
    assert (other["works_with_graphics"], other["last_played"]) == ("no", "long ago")
    assert (other["gender"], other["eyesight"]) == ("x", "fine")
    assert draw_observer(rng).about_you(rng)["last_played"] in CHOICES["last_played"]
