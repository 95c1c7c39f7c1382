"""Who saw what: how many people rated each LoD at each distance, and which of them people link.

Two groups of cells that no person saw both of can only be compared over people: then a difference
between LoDs cannot be told from one between people. Pure.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import TypeVar

import pandas as pd

from analysis.descriptive.means import answered
from analysis.words.wording import listed

Cell = tuple[str, str]
T = TypeVar("T")


def counted(people: int) -> str:
    """Write a number of people in a sentence."""
    return f"{people} {'person' if people == 1 else 'people'}"


@dataclass(frozen=True)
class Coverage:
    """How many people saw each cell (distance, LoD), and the groups of cells that people link.

    ``directions`` counts the people who saw the camera turn each way.
    """

    people: int
    seen_by: dict[Cell, int]
    groups: tuple[tuple[Cell, ...], ...]
    directions: dict[str, int]

    def facts(self) -> list[str]:
        """Say in sentences how many people saw each cell, and how directions are balanced."""
        if not self.seen_by:
            return []
        least, most = min(self.seen_by.values()), max(self.seen_by.values())
        text = [f"Each of these combinations was rated by {counted(least)}."]
        if least != most:
            rare = [f"{lod} at distance={d}" for (d, lod), n in self.seen_by.items() if n == least]
            named = listed(rare) if len(rare) <= 3 else f"{len(rare)} of them"
            text = [
                f"Each of these combinations was rated by {least} to {most} of "
                f"{counted(self.people)}; {named} by {least} only."
            ]
        if len(self.directions) > 1:
            ways = [f"{way} for {counted(n)}" for way, n in self.directions.items()]
            text.append(f"The camera turned {' and '.join(ways)}.")
        return text

    def limits(self) -> list[str]:
        """Say in sentences what cannot be told apart from people."""
        if len(self.groups) < 2:
            return []
        named = "; ".join(
            listed([f"{lod} at distance={d}" for d, lod in group]) for group in self.groups
        )
        return [
            f"Nobody rated eyes of more than one of these groups: {named}. Differences between "
            "the groups cannot be told from differences between people."
        ]


def coverage_of(ratings: pd.DataFrame) -> Coverage:
    """Return who rated what, practice left out."""
    rows = answered(ratings)
    keys = ["participant", "distance", "lod"]
    seen: dict[str, list[Cell]] = {}
    for who, distance, lod in rows[keys].drop_duplicates().astype(str).itertuples(index=False):
        seen.setdefault(who, []).append((distance, lod))
    turned = rows.drop_duplicates(["participant", "orbit_direction"])["orbit_direction"].dropna()
    return coverage(seen, directions=Counter(turned.astype(str).tolist()))


def coverage(
    seen: Mapping[str, Collection[Cell]], *, directions: Mapping[str, int] | None = None
) -> Coverage:
    """Return how often the cells were seen that each person saw."""
    counts = Counter(cell for cells in seen.values() for cell in dict.fromkeys(cells))
    order = list(counts)
    return Coverage(
        people=len(seen),
        seen_by=dict(counts),
        groups=linked_groups(seen.values(), order),
        directions=dict(sorted((directions or {}).items(), reverse=True)),
    )


def linked_groups(together: Iterable[Collection[T]], order: list[T]) -> tuple[tuple[T, ...], ...]:
    """Return the connected components of things of which some stand together, each in ``order``."""
    groups: list[set[T]] = []
    for own in map(set, together):
        if not own:
            continue
        touching = [group for group in groups if group & own]
        groups = [group for group in groups if not group & own]
        groups.append(own.union(*touching))
    place = {thing: i for i, thing in enumerate(order)}
    return tuple(tuple(sorted(group, key=place.__getitem__)) for group in groups)
