"""Simulated observers: people drawn from a population, who answer one trial at a time.

They let a study run itself, on its pages or in bulk, before anyone is recruited. What they answer
must be labelled simulated wherever it appears. Knows no page and no database; randomness is passed
in. Model: the project's reference on analysis, section 5.1.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import exp
from typing import Final

import numpy as np

from analysis.simulation.population import POPULATION, Population, rank_of
from analysis.simulation.remarks import COMMENTS, remark_on
from analysis.tables.columns import EFFECTS

CHOICES: Final[Mapping[str, tuple[str, ...]]] = {
    "works_with_graphics": ("yes", "no"),
    "last_played": ("this week", "this month", "within six months", "longer ago", "never"),
    "gender": ("female", "male", "another", "no answer"),
    "eyesight": ("normal", "corrected to normal", "impaired"),
}
"""What is asked about the participant where a study names no choices of its own."""


@dataclass(frozen=True)
class Stimulus:
    """What an observer sees in one trial.

    ``iris_px`` is the iris's diameter on the frame in pixels. A LoD that is not one of the four
    standard ones brings the level of each of its effects.
    """

    distance: str
    iris_px: float
    left_lod: str
    right_lod: str
    left_levels: Mapping[str, str] = field(default_factory=dict)
    right_levels: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Answer:
    """One filled-in questionnaire; None is a skipped question."""

    left_rating: int | None
    right_rating: int | None
    comparison: int | None
    noticed: str | None
    what_differed: str | None
    comments: str | None
    views: int
    response_ms: int


@dataclass(frozen=True)
class Observer:
    """One simulated person; latent quantities in units of an average observer's noise."""

    is_expert: bool
    leniency: float
    noise: float
    end_avoidance: float
    side: float
    tie_band: float
    criteria: tuple[float, float]
    drift: float
    missing: float
    pace_ms: float
    population: Population = POPULATION

    def answer(self, stimulus: Stimulus, rng: np.random.Generator, *, position: int = 1) -> Answer:
        """Answer every question of one trial; ``position`` is its place in the session, from 1."""
        left, right, difference = self._percepts(stimulus, rng, position)
        noticed = self._notice(stimulus, rng)
        views = 1 + int(rng.poisson(0.4))
        return Answer(
            left_rating=None if self._skips(rng) else self._rate(left, rng),
            right_rating=None if self._skips(rng) else self._rate(right, rng),
            comparison=None if self._skips(rng) else self._compare(difference),
            noticed=None if self._skips(rng) else noticed,
            what_differed=self._describe(stimulus, noticed, rng),
            comments=COMMENTS[int(rng.integers(len(COMMENTS)))] if rng.random() < 0.05 else None,
            views=views,
            response_ms=round(5000 * views + self.pace_ms * exp(0.35 * rng.standard_normal())),
        )

    def about_you(
        self,
        rng: np.random.Generator,
        choices: Mapping[str, Sequence[str]] | None = None,
    ) -> dict[str, str | int]:
        """Answer the questions about the participant.

        ``choices`` are the study's own, ``last_played`` from most recent to never, ``eyesight``
        from the most to the least usual; without them CHOICES.
        """
        own = {**CHOICES, **(choices or {})}
        played, gender, eyesight = own["last_played"], own["gender"], own["eyesight"]
        recent = max(1, len(played) // 2)
        pool = played[:recent] if self.is_expert else played[recent:] or played
        return {
            "works_with_graphics": own["works_with_graphics"][0 if self.is_expert else -1],
            "last_played": pool[int(rng.integers(len(pool)))],
            "age": int(rng.integers(20, 46)),
            "gender": gender[int(rng.integers(min(2, len(gender))))],
            "eyesight": eyesight[min(int(rng.random() < 0.4), len(eyesight) - 1)],
        }

    def _percepts(
        self, stimulus: Stimulus, rng: np.random.Generator, position: int
    ) -> tuple[float, float, float]:
        people = self.population
        mu_left, mu_right = (
            people.realism(stimulus.distance, stimulus.iris_px, rank) for rank in _ranks(stimulus)
        )
        shared = self.leniency + self.drift * (position - 1) / 10
        contrast = people.contrast * (mu_left - mu_right)
        noise = rng.standard_normal(3)
        left = mu_left + contrast + shared - self.side / 2 + self.noise * noise[0]
        right = mu_right - contrast + shared + self.side / 2 + self.noise * noise[1]
        return left, right, right - left + people.comparison_noise * noise[2]

    def _rate(self, percept: float, rng: np.random.Generator) -> int:
        if rng.random() < self.population.lapse:
            return int(rng.integers(1, 6))
        first, *middle, last = self.population.thresholds
        steps = (first - self.end_avoidance, *middle, last + self.end_avoidance)
        return 1 + sum(percept > step for step in steps)

    def _compare(self, difference: float) -> int:
        return int(difference > self.tie_band) - int(difference < -self.tie_band)

    def _notice(self, stimulus: Stimulus, rng: np.random.Generator) -> str:
        people = self.population
        sensitivity = 0.0
        if not _is_same(stimulus):
            sensitivity = people.pair_sensitivity(*_ranks(stimulus))
            sensitivity *= people.visibility(stimulus.iris_px)
            sensitivity *= people.expert_sensitivity if self.is_expert else 1.0
        evidence = sensitivity + rng.standard_normal()
        if evidence > self.criteria[1]:
            return "yes"
        return "unsure" if evidence > self.criteria[0] else "no"

    def _describe(self, stimulus: Stimulus, noticed: str, rng: np.random.Generator) -> str | None:
        if rng.random() >= {"yes": 0.8, "unsure": 0.2, "no": 0.0}[noticed]:
            return None
        return remark_on(
            stimulus.left_levels or dict.fromkeys(EFFECTS, stimulus.left_lod),
            stimulus.right_levels or dict.fromkeys(EFFECTS, stimulus.right_lod),
            rng,
            visibility=self.population.visibility(stimulus.iris_px),
        )

    def _skips(self, rng: np.random.Generator) -> bool:
        return bool(rng.random() < self.missing)


def draw_observer(
    rng: np.random.Generator,
    *,
    is_expert: bool | None = None,
    population: Population = POPULATION,
) -> Observer:
    """Draw one person; whether an expert is drawn too, unless it is said."""
    people = population
    drawn_expert = bool(rng.random() < people.share_of_experts)
    expert = drawn_expert if is_expert is None else is_expert
    group = 0.5 if expert else -0.5
    factor = people.expert_noise if expert else people.other_noise
    low, high = sorted(float(rng.normal(*criterion)) for criterion in people.criteria)
    return Observer(
        is_expert=expert,
        leniency=float(rng.normal(-people.leniency_gap * group, people.leniency_sd)),
        noise=factor * float(rng.lognormal(*people.log_noise)),
        end_avoidance=float(rng.gamma(people.end_avoidance_shape, people.end_avoidance_scale)),
        side=float(rng.normal(*people.side)),
        tie_band=float(rng.lognormal(*people.log_tie_band)),
        criteria=(low, high),
        drift=float(rng.normal(0.0, people.drift_sd)),
        missing=float(rng.uniform(*people.missing)),
        pace_ms=float(rng.lognormal(np.log(14_000.0), 0.3)),
        population=people,
    )


def _ranks(stimulus: Stimulus) -> tuple[float, float]:
    return (
        rank_of(stimulus.left_lod, stimulus.left_levels),
        rank_of(stimulus.right_lod, stimulus.right_levels),
    )


def _is_same(stimulus: Stimulus) -> bool:
    return stimulus.left_lod == stimulus.right_lod
