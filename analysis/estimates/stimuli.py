"""From rows of ratings to a model's stimuli: what differs between them and who saw each.

A stimulus is a LoD at a distance, the LoD beside it, the side, the orbit's direction and the
observer's group: all that the model lets a rating depend on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.descriptive.means import answered
from analysis.models.counts import Counts, count_answers
from analysis.models.predictors import Contrasted, Linear, Predictor
from analysis.tables.ordering import distance_order, lod_order

Floats = NDArray[np.float64]
Cell = tuple[str, str]
RIGHT, LEFTWARD, EXPERT = "right", "leftward", "expert"
NUISANCES: Final = (RIGHT, LEFTWARD, EXPERT)
_COLUMNS: Final = ("distance", "lod", "other_lod", *NUISANCES)
_SIDES: Final = {"right": 0.5, "left": -0.5}
_DIRECTIONS: Final = {"leftward": 0.5, "rightward": -0.5}


@dataclass(frozen=True)
class Stimuli:
    """The stimuli of a ratings table, one row each, and the counts of what they were given.

    ``cells`` are the LoDs at each distance in order; the first is the reference. ``nuisances`` are
    the columns beside the cells (side, direction, expertise), coded +-1/2, so that 0 is between.
    """

    table: pd.DataFrame
    counts: Counts
    cells: tuple[Cell, ...]
    nuisances: tuple[str, ...]
    people: tuple[str, ...]
    scale: tuple[int, int]

    @property
    def terms(self) -> tuple[str, ...]:
        """The predictor's terms: every cell but the first, then the nuisances."""
        return (*(f"{distance}: {lod}" for distance, lod in self.cells[1:]), *self.nuisances)

    def predictor(self, *, with_contrast: bool) -> Predictor:
        """Return the model's predictor, with the contrast from the partner eye or without."""
        own = self._design("lod")
        if not with_contrast:
            return Linear(own, self.terms)
        beside = self._design("other_lod")
        beside[:, len(self.cells) - 1 :] = own[:, len(self.cells) - 1 :]  # nuisances do not differ
        return Contrasted(own, beside, self.terms)

    def can_tell_contrast(self) -> bool:
        """Say whether some cell was seen beside partners that differ: else contrast is a cell's."""
        partners = self.table.groupby(["distance", "lod"])["other_lod"].nunique()
        return bool((partners > 1).any())

    def _design(self, lod: str) -> Floats:
        place = {cell: i for i, cell in enumerate(self.cells)}
        columns = np.zeros((len(self.table), len(self.cells)))
        for row, cell in enumerate(zip(self.table["distance"], self.table[lod], strict=True)):
            if cell in place:
                columns[row, place[cell]] = 1.0
        return np.column_stack([columns[:, 1:], self.table[list(self.nuisances)]]).astype(float)


def stimuli_of(
    ratings: pd.DataFrame, *, scale: tuple[int, int], experts: dict[str, bool] | None = None
) -> Stimuli:
    """Collect the stimuli of the ratings that count.

    ``experts`` says of a participant whether they are one; people without an entry stand between.
    A partner that nobody rated counts as the eye itself. Raises ValueError without any rating.
    """
    rows = answered(ratings)
    if rows.empty:
        raise ValueError("ratings: no rating was given")
    rows, _ = with_nuisances(rows.assign(other_lod=_known_partners(rows)), experts or {})
    own = rows.groupby(list(_COLUMNS), sort=True, observed=True).ngroup().to_numpy()
    coded = rows.assign(stimulus=own).drop_duplicates("stimulus").sort_values("stimulus")
    coded = coded[list(_COLUMNS)].reset_index(drop=True)
    who, people = pd.factorize(rows["participant"])
    low, high = scale
    shape = (len(people), len(coded), high - low + 1)
    counts = count_answers(who, own, rows["rating"].astype(int) - low, shape=shape)
    return Stimuli(
        table=coded,
        counts=counts,
        cells=tuple(_cells(ratings, coded)),
        nuisances=tuple(name for name in NUISANCES if coded[name].nunique() > 1),
        people=tuple(str(name) for name in people),
        scale=scale,
    )


def with_nuisances(
    rows: pd.DataFrame, experts: Mapping[str, bool]
) -> tuple[pd.DataFrame, list[str]]:
    """Add side, direction and expertise, coded +-1/2 and 0 between; name those that vary."""
    around = rows["orbit_direction"] if "orbit_direction" in rows else rows["eye"].iloc[:0]
    group = {who: 0.5 if is_expert else -0.5 for who, is_expert in experts.items()}
    coded = rows.assign(
        **{
            RIGHT: rows["eye"].map(_SIDES).astype(float).fillna(0.0),
            LEFTWARD: around.map(_DIRECTIONS).astype(float).reindex(rows.index).fillna(0.0),
            EXPERT: rows["participant"].map(group).astype(float).fillna(0.0),
        }
    )
    return coded, [name for name in NUISANCES if coded[name].nunique() > 1]


def _cells(ratings: pd.DataFrame, table: pd.DataFrame) -> list[Cell]:
    shown = set(zip(table["distance"], table["lod"], strict=True))
    return [
        (distance, lod)
        for distance in distance_order(ratings)
        for lod in lod_order(ratings)
        if (distance, lod) in shown
    ]


def _known_partners(rows: pd.DataFrame) -> pd.Series:
    rated = set(zip(rows["distance"], rows["lod"], strict=True))
    pairs = zip(rows["distance"], rows["other_lod"], strict=True)
    is_rated = pd.Series([pair in rated for pair in pairs], index=rows.index)
    return rows["other_lod"].where(is_rated, rows["lod"])
