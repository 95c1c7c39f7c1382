"""Who would see what: the plan of a study as plain rows, before anybody has taken part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.simulation.observers import Stimulus

Integers = NDArray[np.intp]
COLUMNS: Final = ("participant", "position", "clip")


@dataclass(frozen=True)
class Plan:
    """One way in which people come: ``clips`` by name, and a row for each presentation.

    ``table`` has the columns participant (numbered from 0 in the order in which people come),
    position (of the trial in the visit, from 1) and clip. Raises ValueError for a clip that is not
    among ``clips`` or a missing column.
    """

    clips: Mapping[str, Stimulus]
    table: pd.DataFrame

    def __post_init__(self) -> None:
        if missing := [name for name in COLUMNS if name not in self.table]:
            raise ValueError(f"plan: no column {', '.join(missing)}; needed: {', '.join(COLUMNS)}")
        if unknown := sorted(set(self.table["clip"]) - set(self.clips)):
            raise ValueError(f"plan: unknown clip {unknown[0]}; there are {', '.join(self.clips)}")

    @cached_property
    def person(self) -> Integers:
        """Who sees it (n_presentations,), from 0."""
        return np.asarray(self.table["participant"], dtype=np.intp)

    @cached_property
    def position(self) -> Integers:
        """The trial's place in the visit (n_presentations,), from 1."""
        return np.asarray(self.table["position"], dtype=np.intp)

    @cached_property
    def clip(self) -> Integers:
        """The clip's number in ``clips`` (n_presentations,)."""
        place = {name: i for i, name in enumerate(self.clips)}
        return np.asarray(self.table["clip"].map(place), dtype=np.intp)

    @property
    def stimuli(self) -> tuple[Stimulus, ...]:
        """The clips without their names."""
        return tuple(self.clips.values())

    @property
    def people(self) -> int:
        """How many people come."""
        return int(self.person.max(initial=-1)) + 1

    def first(self, people: int) -> Plan:
        """Return the plan of those who come first; raises ValueError if fewer come at all."""
        if people > self.people:
            raise ValueError(f"plan: {people} people wanted, {self.people} come")
        own = self.table[self.table["participant"] < people].reset_index(drop=True)
        return Plan(self.clips, own)
