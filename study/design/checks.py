"""Faults that lie between the parts of a study file: names that lead nowhere, ids used twice.

The checks read the raw tables and pass over whatever has the wrong type (pydantic reports that), so
that these faults and pydantic's are told in one go.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

from pydantic import ValidationError

from renderer.detail import EFFECTS
from study.design.faults import Fault, Place, dotted, unknown
from study.design.pairings import CatchClip, Factors
from study.design.questions import STANDARD

Data = Mapping[str, Any]


def cross_faults(data: Data) -> list[Fault]:
    """Return every fault that no single value shows."""
    return [fault for check in _CHECKS for fault in check(data)]


def _check_lods(data: Data) -> Iterator[Fault]:
    lods = _table(data, "lods")
    for name, row in lods.items():
        if not isinstance(row, Mapping):
            continue
        base = row.get("base")
        if base is None:
            absent = [effect for effect in EFFECTS if effect not in row]
            if absent:
                yield Fault(
                    dotted(("lods", name)),
                    f"no level for {', '.join(absent)}; give every effect a level, or name a "
                    'LoD to start from: base = "ultra"',
                )
        elif base not in lods:
            others = [other for other in lods if other != name]
            yield Fault(dotted(("lods", name, "base")), unknown("LoD", base, others))
        elif _has_circle(lods, name):
            yield Fault(dotted(("lods", name, "base")), f'"{base}" leads back to "{name}"')


def _has_circle(lods: Data, name: str) -> bool:
    seen = {name}
    current = lods[name].get("base")
    while isinstance(current, str) and isinstance(lods.get(current), Mapping):
        if current in seen:
            return True
        seen.add(current)
        current = lods[current].get("base")
    return False


def _check_references(data: Data) -> Iterator[Fault]:
    """Clips, factors and catch clips may only use LoDs and distances that the file names."""
    lods = list(_table(data, "lods"))
    listed = data.get("distances")
    distances = [d for d in listed if isinstance(d, str)] if isinstance(listed, list) else []
    accepted = {"LoD": lods, "distance": distances}
    for table, key, noun in _REFERENCES:
        for index, row in _rows(data, table):
            found = row.get(key)
            values = found if isinstance(found, list) else [found]
            for value in values:
                if isinstance(value, str) and value not in accepted[noun]:
                    yield Fault(dotted((table, index, key)), unknown(noun, value, accepted[noun]))


_REFERENCES: Final = (
    *((table, key, "LoD") for table in ("practice", "clips") for key in ("left", "right")),
    *((table, "distance", "distance") for table in ("practice", "clips", "catch")),
    ("catch", "lod", "LoD"),
    ("factors", "lods", "LoD"),
    ("factors", "against", "LoD"),
    ("factors", "distances", "distance"),
)


def _check_clips(data: Data) -> Iterator[Fault]:
    if not any(_rows(data, table) for table in ("clips", "factors")):
        yield Fault("clips", "no clip; write [[clips]] tables or [[factors]] that generate them")
    yield from _repeated(list(_named_clips(data)))


def _named_clips(data: Data) -> Iterator[tuple[Place, str]]:
    """Return the place and id of every clip, generated ones included where they can be read."""
    for table in ("practice", "clips"):
        for index, row in _rows(data, table):
            if isinstance(row.get("id"), str):
                yield (table, index, "id"), row["id"]
    for index, row in _rows(data, "factors"):
        try:
            yield from ((("factors", index), clip.id) for clip in Factors(**row).clips())
        except (ValidationError, TypeError):
            continue
    for index, row in _rows(data, "catch"):
        try:
            yield ("catch", index), CatchClip(**row).clip().id
        except (ValidationError, TypeError):
            continue


def _repeated(named: list[tuple[Place, str]]) -> Iterator[Fault]:
    first: dict[str, Place] = {}
    for place, name in named:
        if name in first:
            yield Fault(
                dotted(place), f'id "{name}" is taken by {dotted(first[name])}; ids must differ'
            )
        first.setdefault(name, place)


def _check_questions(data: Data) -> Iterator[Fault]:
    for table in ("questions", "about"):
        rows = _rows(data, table)
        yield from _repeated(
            [((table, i, "id"), row["id"]) for i, row in rows if isinstance(row.get("id"), str)]
        )
        earlier: dict[str, list[Any]] = {}
        for index, row in rows:
            yield from _check_rule(row, (table, index, "shown_if"), earlier)
            yield from _check_values(row, (table, index))
            if isinstance(row.get("id"), str):
                earlier[row["id"]] = _values(row)
    for index, row in _rows(data, "questions"):
        yield from _check_standard(row, ("questions", index))


def _check_rule(row: Data, place: Place, earlier: Mapping[str, list[Any]]) -> Iterator[Fault]:
    rule = row.get("shown_if")
    if not isinstance(rule, Mapping) or not isinstance(rule.get("question"), str):
        return
    if rule["question"] not in earlier:
        yield Fault(
            dotted((*place, "question")), unknown("earlier question", rule["question"], earlier)
        )
        return
    accepted = earlier[rule["question"]]
    values = rule.get("values")
    for value in values if isinstance(values, list) else []:
        if value not in accepted:
            yield Fault(dotted((*place, "values")), unknown("answer", value, map(str, accepted)))


def _check_values(row: Data, place: Place) -> Iterator[Fault]:
    values = _values(row)
    if row.get("kind") == "choice" and len(set(map(str, values))) < len(values):
        yield Fault(dotted((*place, "options")), "two options have the same value")
    for low, high in (("lowest", "highest"), ("minimum", "maximum")):
        ends = row.get(low), row.get(high)
        if isinstance(ends[0], int) and isinstance(ends[1], int) and ends[0] >= ends[1]:
            yield Fault(dotted((*place, high)), f"{ends[1]} is not above {low} {ends[0]}")


def _check_standard(row: Data, place: Place) -> Iterator[Fault]:
    """A question whose id is a column of the tables has to fit that column."""
    standard = STANDARD.get(str(row.get("id")))
    if standard is None or not isinstance(row.get("kind"), str):
        return
    if row["kind"] != standard.kind:
        yield Fault(
            dotted((*place, "kind")),
            f'"{row["kind"]}" does not fit the column {row["id"]}; make it "{standard.kind}" or '
            "give the question another id",
        )
        return
    odd = [str(value) for value in _values(row) if value not in standard.values]
    if standard.values and odd:
        yield Fault(
            dotted(place),
            f"{', '.join(odd)} cannot be stored in the column {row['id']}; its values are "
            f"{', '.join(map(str, standard.values))}",
        )


def _values(row: Data) -> list[Any]:
    if row.get("kind") == "choice" and isinstance(row.get("options"), list):
        return [o["value"] for o in row["options"] if isinstance(o, Mapping) and "value" in o]
    low, high = row.get("lowest", 1), row.get("highest", 5)
    if row.get("kind") == "scale" and isinstance(low, int) and isinstance(high, int):
        return list(range(low, min(high, low + 1000) + 1))
    return []


def _check_repeats(data: Data) -> Iterator[Fault]:
    orbit = _table(data, "orbit").get("directions")
    for place, values in (
        ("sizes", data.get("sizes")),
        ("distances", data.get("distances")),
        ("orbit.directions", orbit),
    ):
        listed = [v for v in values if isinstance(v, str)] if isinstance(values, list) else []
        for value in dict.fromkeys(v for v in listed if listed.count(v) > 1):
            yield Fault(place, f'"{value}" is listed twice')


def _table(data: Data, key: str) -> Data:
    found = data.get(key)
    return found if isinstance(found, Mapping) else {}


def _rows(data: Data, key: str) -> list[tuple[int, Data]]:
    found = data.get(key)
    listed = found if isinstance(found, list) else []
    return [(index, row) for index, row in enumerate(listed) if isinstance(row, Mapping)]


_CHECKS: Final[tuple[Callable[[Data], Iterator[Fault]], ...]] = (
    _check_lods,
    _check_references,
    _check_clips,
    _check_questions,
    _check_repeats,
)
