"""What links the eyes of a study on one scale: comparisons, and people who rated several of them.

Two eyes are linked where a chain of comparisons, or of people who rated both, leads from the one to
the other. Between groups without a link only the assumption holds that their people are alike.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import pandas as pd

from analysis.descriptive.means import answered
from analysis.estimates.stimuli import Cell
from analysis.tables.ordering import distance_order, lod_ranks
from analysis.words.wording import listed


@dataclass(frozen=True)
class Linkage:
    """Groups of linked cells (distance, LoD): by comparisons alone, and by ratings too.

    ``unrated`` were compared but never rated: they have no place on the joint scale.
    """

    compared: tuple[tuple[Cell, ...], ...]
    linked: tuple[tuple[Cell, ...], ...]
    unrated: tuple[Cell, ...]

    @property
    def is_one(self) -> bool:
        """Whether everything that was rated is linked."""
        return len(self.linked) == 1

    def sentences(self) -> tuple[str, ...]:
        """Say what is linked, by what, and what is not."""
        told = []
        if len({cell[0] for group in self.compared for cell in group}) > 1:
            told.append(
                "Comparisons link LoDs within a distance; distances are linked by the people who "
                "rated eyes at several of them."
                if self.is_one
                else "Comparisons link LoDs within a distance alone."
            )
        if len(self.linked) > 1:
            groups = "; ".join(map(_named, self.linked))
            told.append(
                f"Not everything is linked: nobody rated eyes of two of these groups ({groups}), "
                "so between them the joint scale rests on the assumption that their people are "
                "alike."
            )
        if self.unrated:
            told.append(
                f"Compared but never rated, so without a place on the joint scale: "
                f"{_named(self.unrated)}."
            )
        return tuple(told)


def linkage_of(ratings: pd.DataFrame, comparisons: pd.DataFrame) -> Linkage:
    """Find what links the cells that were rated or compared."""
    rated = answered(ratings)[["participant", "distance", "lod"]].drop_duplicates()
    rows = comparisons[comparisons["comparison"].notna() & ~comparisons["is_practice"]]
    keys = ["distance", "left_lod", "right_lod"]
    pairs = [
        ((str(where), str(left)), (str(where), str(right)))
        for where, left, right in rows[keys].drop_duplicates().itertuples(index=False, name=None)
        if left != right
    ]
    by_person = [
        list(zip(own["distance"].astype(str), own["lod"].astype(str), strict=True))
        for _, own in rated.groupby("participant", sort=False)
    ]
    known = {cell for cells in by_person for cell in cells}
    order = _order(ratings, rows)
    compared = _groups(pairs, order)
    linked = _groups([*by_person, *pairs], order)
    return Linkage(
        compared=compared,
        linked=tuple(group for group in linked if any(cell in known for cell in group)),
        unrated=tuple(cell for group in compared for cell in group if cell not in known),
    )


def _groups(
    chains: Iterable[Iterable[Cell]], order: Mapping[Cell, int]
) -> tuple[tuple[Cell, ...], ...]:
    """Join chains that share a cell; groups and cells in order."""
    home: dict[Cell, set[Cell]] = {}
    for chain in chains:
        joined = set(chain)
        for cell in list(joined):
            joined |= home.get(cell, set())
        for cell in joined:
            home[cell] = joined
    groups = {id(group): group for group in home.values()}.values()
    ordered = [tuple(sorted(group, key=lambda cell: order.get(cell, -1))) for group in groups]
    return tuple(sorted(ordered, key=lambda group: order.get(group[0], -1)))


def _order(ratings: pd.DataFrame, compared: pd.DataFrame) -> dict[Cell, int]:
    ranks = lod_ranks(ratings)
    distances = distance_order(pd.concat([ratings, compared]))
    lods = {*ratings["lod"], *compared["left_lod"], *compared["right_lod"]}
    names = sorted(map(str, lods), key=lambda lod: (ranks.get(lod, -1.0), lod))
    return {cell: i for i, cell in enumerate((where, lod) for where in distances for lod in names)}


def _named(cells: Iterable[Cell]) -> str:
    """Write cells by distance: "near: low and ultra"."""
    by_distance: dict[str, list[str]] = {}
    for distance, lod in cells:
        by_distance.setdefault(distance, []).append(lod)
    return ", ".join(f"{where}: {listed(lods)}" for where, lods in by_distance.items())
