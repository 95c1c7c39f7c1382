"""Ratings as three arrays: who rated which stimulus how; a stimulus is one eye as it was shown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.descriptive.means import answered

Floats = NDArray[np.float64]
Places = NDArray[np.intp]
_STIMULUS: Final = ("distance", "lod", "other_lod", "eye")


@dataclass(frozen=True)
class Presented:
    """The ratings that count: ``person``, ``stimulus`` and ``cell`` number from 0 (n_ratings,).

    A stimulus is a LoD at a distance, the LoD beside it and the side; a cell is the LoD at the
    distance alone, which more people share.
    """

    people: tuple[str, ...]
    person: Places
    stimulus: Places
    cell: Places
    rating: Floats

    @property
    def answers(self) -> Floats:
        """How many ratings each person gave (n_people,)."""
        return np.bincount(self.person, minlength=len(self.people)).astype(float)


def presented(ratings: pd.DataFrame) -> Presented:
    """Number the people and the stimuli of a ratings table; empty arrays for an empty one."""
    rows = answered(ratings)
    person, people = pd.factorize(rows["participant"], sort=True)
    seen = rows[list(_STIMULUS)].astype("string").fillna("")
    stimulus, cell = (
        np.asarray(seen.groupby(list(names), sort=True).ngroup(), dtype=np.intp)
        for names in (_STIMULUS, _STIMULUS[:2])
    )
    return Presented(
        people=tuple(map(str, people)),
        person=person.astype(np.intp),
        stimulus=stimulus,
        cell=cell,
        rating=rows["rating"].to_numpy(dtype=float),
    )


def sums(place: Places, values: Floats, count: int) -> Floats:
    """Sum the values that stand at each place (count,)."""
    return np.bincount(place, values, minlength=count).astype(float)
