"""A study file as it was parsed, before anything in it is known to be right."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from study.design.faults import Fault, Place, dotted

Data = Mapping[str, Any]


def table_of(data: Data, key: str) -> Data:
    """Return a table of the file; an empty one where there is none."""
    found = data.get(key)
    return found if isinstance(found, Mapping) else {}


def rows_of(data: Data, key: str) -> list[tuple[int, Data]]:
    """Return the tables of an array with their places, without what is no table."""
    found = data.get(key)
    listed = found if isinstance(found, list) else []
    return [(index, row) for index, row in enumerate(listed) if isinstance(row, Mapping)]


def repeated(named: list[tuple[Place, str]]) -> Iterator[Fault]:
    """Yield a fault for every id that an earlier place has taken."""
    first: dict[str, Place] = {}
    for place, name in named:
        if name in first:
            yield Fault(
                dotted(place), f'id "{name}" is taken by {dotted(first[name])}; ids must differ'
            )
        first.setdefault(name, place)
