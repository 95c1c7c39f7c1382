"""What simulated observers are assumed to see: the truth that a simulated study has to find.

Losses are in points of the population's mean rating, noticing in shares of people beyond false
alarms: the quantities that verdicts are about.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, roots_hermitenorm

from analysis.decision.margins import Margins
from analysis.decision.verdicts import DIFFERENT, EQUIVALENT
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION, Population, rank_of
from analysis.tables.columns import STANDARD_LODS

Floats = NDArray[np.float64]
Cell = tuple[str, str]
Pair = tuple[str, str, str]
EDGE: Final = 1e-6  # a truth this close to its margin is on it


@dataclass(frozen=True)
class Assumed:
    """The latent realism of each cell (distance, LoD) and the d' of each pair shown there.

    Pairs (distance, LoD, other) stand both ways round; equal ones have none.
    """

    name: str
    realism: Mapping[Cell, float]
    sensitivity: Mapping[Pair, float]
    population: Population = POPULATION

    def loss(self, distance: str, lod: str, *, best: str) -> float:
        """Return by how many points a LoD is truly rated below the best."""
        mu = np.array([self.realism[distance, name] for name in (best, lod)])
        rating = self.population.mean_rating(mu)
        return float(rating[0] - rating[1])

    def excess(self, distance: str, lod: str, *, best: str) -> float:
        """Return the true share of people who notice it beside the best, beyond false alarms."""
        return excess_of(self.sensitivity[distance, lod, best], self.population)

    def verdict(self, distance: str, lod: str, *, best: str, margins: Margins) -> str:
        """Return the right verdict: equivalent or different.

        It is empty on a margin, where none is right, and for a pair never shown that looks as real.
        """
        beyond = self.loss(distance, lod, best=best) - margins.realism_points
        if (distance, lod, best) not in self.sensitivity:
            return DIFFERENT if beyond > EDGE else ""
        beyond = max(beyond, self.excess(distance, lod, best=best) - margins.noticed_share)
        if beyond > EDGE:
            return DIFFERENT
        return EQUIVALENT if beyond < -EDGE else ""


@dataclass(frozen=True)
class Differences:
    """What is assumed of one LoD at one distance, against the best there."""

    loss: float | None = None
    noticed: float | None = None


def thesis_like(clips: Iterable[Stimulus], *, population: Population = POPULATION) -> Assumed:
    """Assume what the thesis says in words, and our numbers where it gives none."""
    realism: dict[Cell, float] = {}
    sensitivity: dict[Pair, float] = {}
    for clip in clips:
        ranks = [
            rank_of(clip.left_lod, clip.left_levels),
            rank_of(clip.right_lod, clip.right_levels),
        ]
        for lod, rank in zip((clip.left_lod, clip.right_lod), ranks, strict=True):
            realism[clip.distance, lod] = population.realism(clip.distance, clip.iris_px, rank)
        if clip.left_lod != clip.right_lod:
            d = population.pair_sensitivity(ranks[0], ranks[1])
            d *= population.visibility(clip.iris_px)
            sensitivity[clip.distance, clip.left_lod, clip.right_lod] = d
            sensitivity[clip.distance, clip.right_lod, clip.left_lod] = d
    return Assumed("thesis", realism, sensitivity, population)


def changed(
    base: Assumed, name: str, *, best: Mapping[str, str], wanted: Mapping[Cell, Differences]
) -> Assumed:
    """Return ``base`` with other differences from the ``best`` LoD of each distance."""
    people = base.population
    realism, sensitivity = dict(base.realism), dict(base.sensitivity)
    for (distance, lod), own in wanted.items():
        top = best[distance]
        if own.loss is not None:
            level = float(people.mean_rating(np.array(realism[distance, top])))
            realism[distance, lod] = _latent(level - own.loss, people)
        if own.noticed is not None and (distance, lod, top) in sensitivity:
            d = sensitivity_of(own.noticed, people)
            sensitivity[distance, lod, top] = sensitivity[distance, top, lod] = d
    return Assumed(name, realism, sensitivity, people)


def excess_of(sensitivity: float, population: Population = POPULATION) -> float:
    """Return P(yes) at d' less P(yes) at 0, over people's criteria and expertise."""
    yes = _yes(np.array([sensitivity, 0.0]), population)
    return float(yes[0] - yes[1])


def sensitivity_of(excess: float, population: Population = POPULATION) -> float:
    """Return the d' at which so large a share notice beyond false alarms."""
    return _solved(lambda d: excess_of(d, population), excess, 0.0, 12.0)


def _latent(rating: float, population: Population) -> float:
    return _solved(lambda mu: float(population.mean_rating(np.array(mu))), rating, -8.0, 8.0)


def _solved(function: Callable[[float], float], wanted: float, low: float, high: float) -> float:
    """Bisect a rising function; its ends where ``wanted`` lies beyond them."""
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) < wanted else (low, middle)
    return low


def _yes(d: Floats, population: Population) -> Floats:
    nodes, weights = roots_hermitenorm(31)
    weights = weights / weights.sum()
    first, second = (mean + sd * nodes for mean, sd in population.criteria)
    criterion = np.maximum.outer(first, second)  # yes lies beyond the higher of the two
    share: Floats = np.zeros(d.shape)
    for part, factor in (
        (population.share_of_experts, population.expert_sensitivity),
        (1 - population.share_of_experts, 1.0),
    ):
        beyond = ndtr(factor * d[:, None, None] - criterion)
        share = share + part * (beyond * np.outer(weights, weights)).sum(axis=(1, 2))
    return share


def best_lods(clips: Iterable[Stimulus], margins: Margins) -> dict[str, str]:
    """Return the best LoD shown at each distance: the sequence's first, or the highest."""
    shown: dict[str, dict[str, float]] = {}
    for clip in clips:
        own = shown.setdefault(clip.distance, {})
        own[clip.left_lod] = rank_of(clip.left_lod, clip.left_levels)
        own[clip.right_lod] = rank_of(clip.right_lod, clip.right_levels)
    order = order_of(margins)
    return {
        distance: max(own, key=lambda lod: (order.get(lod, -1.0), own[lod], lod))
        for distance, own in shown.items()
    }


def order_of(margins: Margins) -> Mapping[str, float]:
    """Return what orders the LoDs, the best highest, as the verdicts take it."""
    return margins.order({lod: float(rank) for rank, lod in enumerate(STANDARD_LODS, start=1)})


def lower_cells(clips: Iterable[Stimulus], best: Mapping[str, str]) -> list[Cell]:
    """Return every (distance, LoD) that is shown, but for the best of each distance."""
    cells = {
        (clip.distance, lod): None for clip in clips for lod in (clip.left_lod, clip.right_lod)
    }
    return [cell for cell in cells if best[cell[0]] != cell[1]]


def _equal(margins: Margins) -> Differences:
    del margins
    return Differences(0.0, 0.0)


NAMED: Final[Mapping[str, Callable[[Margins], Differences]]] = MappingProxyType(
    {
        "equal": _equal,
        "realism-margin": lambda margins: Differences(margins.realism_points, 0.0),
        "noticed-margin": lambda margins: Differences(0.0, margins.noticed_share),
    }
)
"""Truths beside the thesis's: no difference at all, and the two edges of "enough"."""


def named_truth(name: str, clips: Iterable[Stimulus], margins: Margins) -> Assumed:
    """Return a truth by its name, "thesis" or one of NAMED; raises ValueError for another."""
    listed = list(clips)
    base = thesis_like(listed)
    if name == base.name:
        return base
    if name not in NAMED:
        accepted = ", ".join([base.name, *NAMED])
        raise ValueError(f'truth: "{name}"; accepted: {accepted}, or a TOML file')
    best = best_lods(listed, margins)
    wanted = dict.fromkeys(lower_cells(listed, best), NAMED[name](margins))
    return changed(base, name, best=best, wanted=wanted)
