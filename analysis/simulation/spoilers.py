"""Simulated observers that spoil data: each kind does to an honest observer's answers one thing.

They prove that screening names them and that they move no verdict.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Final

import numpy as np

from analysis.simulation.observers import Answer, Observer, Stimulus
from analysis.tables.columns import SCALE, STANDARD_LODS

SPOILERS: Final = ("shuffler", "straight-liner", "extreme", "inverter", "side-picker")
_LOW, _HIGH = SCALE


@dataclass(frozen=True)
class Spoiler(Observer):
    """An observer of one of the kinds in SPOILERS; a side-picker always takes the right eye."""

    kind: str = SPOILERS[0]

    def answer(self, stimulus: Stimulus, rng: np.random.Generator, *, position: int = 1) -> Answer:
        """Answer one trial in the kind's way."""
        seen = self._another(rng) if self.kind == "shuffler" else stimulus
        honest = super().answer(seen, rng, position=position)
        if self.kind == "straight-liner":
            middle = (_LOW + _HIGH) // 2
            return replace(
                honest, left_rating=middle, right_rating=middle, comparison=0, noticed="no"
            )
        if self.kind == "side-picker":
            return replace(_favour_right(honest), comparison=1)
        turn = {"extreme": self._to_an_end, "inverter": _turned}.get(self.kind)
        if turn is None:
            return honest
        left, right = (
            None if rating is None else turn(rating)
            for rating in (honest.left_rating, honest.right_rating)
        )
        is_turned = self.kind == "inverter" and honest.comparison is not None
        comparison = -honest.comparison if is_turned and honest.comparison else honest.comparison
        return replace(honest, left_rating=left, right_rating=right, comparison=comparison)

    def _another(self, rng: np.random.Generator) -> Stimulus:
        """Return a stimulus that has nothing to do with the one shown."""
        sizes = self.population.iris_px
        distance = list(sizes)[int(rng.integers(len(sizes)))]
        left, right = (STANDARD_LODS[int(k)] for k in rng.integers(len(STANDARD_LODS), size=2))
        return Stimulus(distance, sizes[distance], left, right)

    def _to_an_end(self, rating: int) -> int:
        """Return the end on the rating's side; the middle goes with the person's leniency."""
        doubled = 2 * rating - (_LOW + _HIGH)
        return _HIGH if doubled > 0 or (doubled == 0 and self.leniency > 0) else _LOW


def spoiled(observer: Observer, kind: str) -> Spoiler:
    """Turn an honest observer into one that spoils; raises ValueError for an unknown kind."""
    if kind not in SPOILERS:
        raise ValueError(f'kind of spoiler: "{kind}"; accepted: {", ".join(SPOILERS)}')
    own = {field.name: getattr(observer, field.name) for field in fields(Observer)}
    return Spoiler(**own, kind=kind)


def _turned(rating: int) -> int:
    return _LOW + _HIGH - rating


def _favour_right(honest: Answer) -> Answer:
    """Give the right eye the better of both ratings, and the left one at least a point less."""
    if honest.left_rating is None or honest.right_rating is None:
        return honest
    best = max(honest.left_rating, honest.right_rating, _LOW + 1)
    worst = min(honest.left_rating, honest.right_rating, best - 1)
    return replace(honest, left_rating=worst, right_rating=best)
