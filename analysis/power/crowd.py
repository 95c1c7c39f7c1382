"""Many simulated observers at once: the law of ``analysis.simulation.observers`` on whole arrays.

A study's answers cost milliseconds, so that it can be repeated hundreds of times. That both say the
same is tested; free text, response times and views are left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.simulation.population import POPULATION, Population

Floats = NDArray[np.float64]
Integers = NDArray[np.intp]
NOTHING = -9  # a question that was skipped


@dataclass(frozen=True)
class Crowd:
    """People as arrays (n_people,); the meaning of each is that of ``Observer``."""

    is_expert: NDArray[np.bool_]
    leniency: Floats
    noise: Floats
    end_avoidance: Floats
    side: Floats
    tie_band: Floats
    criteria: Floats  # (2, n_people)
    drift: Floats
    missing: Floats
    population: Population


@dataclass(frozen=True)
class Answers:
    """Answers to presentations as arrays (n_presentations,), NOTHING where one was skipped.

    Ratings 1 to 5; ``comparison`` -1, 0, 1; ``noticed`` 0 no, 1 unsure, 2 yes.
    """

    left: Integers
    right: Integers
    comparison: Integers
    noticed: Integers

    def columns(self) -> tuple[Integers, ...]:
        """Return the arrays in their order."""
        return self.left, self.right, self.comparison, self.noticed


def draw_crowd(
    rng: np.random.Generator, people: int, *, population: Population = POPULATION
) -> Crowd:
    """Draw people as ``draw_observer`` does."""
    own = population
    is_expert = rng.random(people) < own.share_of_experts
    group = np.where(is_expert, 0.5, -0.5)
    factor = np.where(is_expert, own.expert_noise, own.other_noise)
    criteria = np.array([rng.normal(*criterion, people) for criterion in own.criteria])
    return Crowd(
        is_expert=is_expert,
        leniency=rng.normal(-own.leniency_gap * group, own.leniency_sd),
        noise=factor * rng.lognormal(*own.log_noise, people),
        end_avoidance=rng.gamma(own.end_avoidance_shape, own.end_avoidance_scale, people),
        side=rng.normal(*own.side, people),
        tie_band=rng.lognormal(*own.log_tie_band, people),
        criteria=np.sort(criteria, axis=0),
        drift=rng.normal(0.0, own.drift_sd, people),
        missing=rng.uniform(*own.missing, people),
        population=own,
    )


def answer_all(
    crowd: Crowd,
    rng: np.random.Generator,
    *,
    person: Integers,
    position: Integers,
    left: Floats,
    right: Floats,
    sensitivity: Floats,
) -> Answers:
    """Let everybody answer what they see, all arrays (n_presentations,).

    ``left`` and ``right`` are the eyes' latent realism without their contrast, ``sensitivity`` the
    pair's d' for people who are no experts, 0 for equal eyes.
    """
    own, count = crowd.population, len(person)
    shared = crowd.leniency[person] + crowd.drift[person] * (position - 1) / 10
    contrast = own.contrast * (left - right)
    noise = rng.standard_normal((4, count))
    scatter, half = crowd.noise[person], crowd.side[person] / 2
    percept_left = left + contrast + shared - half + scatter * noise[0]
    percept_right = right - contrast + shared + half + scatter * noise[1]
    difference = percept_right - percept_left + own.comparison_noise * noise[2]
    band = crowd.tie_band[person]
    factor = np.where(crowd.is_expert[person], own.expert_sensitivity, 1.0)
    evidence = sensitivity * factor + noise[3]
    given = (
        _rated(crowd, person, percept_left, rng),
        _rated(crowd, person, percept_right, rng),
        (difference > band).astype(np.intp) - (difference < -band),
        (evidence > crowd.criteria[:, person]).sum(axis=0),
    )
    skipped = rng.random((4, count)) < crowd.missing[person]
    return Answers(*np.where(skipped, NOTHING, np.array(given, dtype=np.intp)))


def _rated(crowd: Crowd, person: Integers, percept: Floats, rng: np.random.Generator) -> Integers:
    first, *middle, last = crowd.population.thresholds
    avoided = crowd.end_avoidance[person]
    steps = [first - avoided, *(np.full(len(person), step) for step in middle), last + avoided]
    rating = 1 + (percept > np.array(steps)).sum(axis=0)
    lapsed = rng.random(len(person)) < crowd.population.lapse
    return np.asarray(np.where(lapsed, rng.integers(1, 6, len(person)), rating), dtype=np.intp)
