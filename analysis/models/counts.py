"""From answers to counts: how often each person gave each category to each stimulus.

Stimuli are few however many answers there are, so a model's cost does not grow with the answers of
a person.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Counts:
    """Counts (n_people, n_stimuli, n_categories); categories are numbered from 0."""

    table: Floats

    @property
    def people(self) -> int:
        """How many people there are."""
        return int(self.table.shape[0])

    @property
    def stimuli(self) -> int:
        """How many stimuli there are."""
        return int(self.table.shape[1])

    @property
    def categories(self) -> int:
        """How many categories an answer can have."""
        return int(self.table.shape[2])

    @property
    def total(self) -> float:
        """How many answers there are, or their weights' sum."""
        return float(self.table.sum())

    @property
    def most_per_person(self) -> float:
        """How many answers the busiest person gave."""
        return float(self.table.sum(axis=(1, 2)).max(initial=0.0))


def count_answers(
    person: ArrayLike,
    stimulus: ArrayLike,
    category: ArrayLike,
    *,
    shape: tuple[int, int, int],
) -> Counts:
    """Count answers given as three arrays of equal length, each numbered from 0.

    ``shape`` is (n_people, n_stimuli, n_categories). Raises ValueError for a number outside it.
    """
    columns = [np.asarray(column, dtype=np.intp) for column in (person, stimulus, category)]
    for name, column, size in zip(("person", "stimulus", "category"), columns, shape, strict=True):
        if column.size and not 0 <= column.min() <= column.max() < size:
            raise ValueError(
                f"{name}: numbers go from 0 to {size - 1}; found {column.min()} to {column.max()}"
            )
    place = np.ravel_multi_index(tuple(columns), shape)
    table = np.bincount(place, minlength=int(np.prod(shape))).reshape(shape)
    return Counts(table.astype(float))
