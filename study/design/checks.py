"""Faults that lie between the parts of a study file: names that lead nowhere, ids used twice.

The checks read the raw tables and pass over whatever has the wrong type (pydantic reports that), so
that these faults and pydantic's are told in one go.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Final

from pydantic import ValidationError

from renderer.detail import EFFECTS
from study.design.approach import check_approaches, check_switching
from study.design.attention import check_attention
from study.design.completion import check_completion
from study.design.decision import check_decision
from study.design.faults import Fault, Place, dotted, unknown
from study.design.gold import check_gold
from study.design.irises import check_irises
from study.design.pairings import CatchClip, Factors
from study.design.pauses import check_breaks
from study.design.question_checks import check_questions
from study.design.raw import Data, repeated, rows_of, table_of
from study.design.recruiting import check_recruiting
from study.design.texts import check_consent


def cross_faults(data: Data) -> list[Fault]:
    """Return every fault that no single value shows."""
    return [fault for check in _CHECKS for fault in check(data)]


def _check_lods(data: Data) -> Iterator[Fault]:
    lods = table_of(data, "lods")
    for name, row in lods.items():
        if not isinstance(row, Mapping):
            continue
        if row.get("switching") is not None:
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
        elif not isinstance(base, str) or base not in lods:
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
    lods = list(table_of(data, "lods"))
    listed = data.get("distances")
    distances = [d for d in listed if isinstance(d, str)] if isinstance(listed, list) else []
    accepted = {"LoD": lods, "distance": distances}
    for table, key, noun in _REFERENCES:
        for index, row in rows_of(data, table):
            found = row.get(key)
            values = found if isinstance(found, list) else [found]
            for value in values:
                if isinstance(value, str) and value not in accepted[noun]:
                    yield Fault(dotted((table, index, key)), unknown(noun, value, accepted[noun]))


_REFERENCES: Final = (
    *((table, key, "LoD") for table in ("practice", "clips", "gold") for key in ("left", "right")),
    *((table, "distance", "distance") for table in ("practice", "clips", "catch", "gold")),
    ("catch", "lod", "LoD"),
    ("factors", "lods", "LoD"),
    ("factors", "against", "LoD"),
    ("factors", "distances", "distance"),
)


def _check_clips(data: Data) -> Iterator[Fault]:
    if not any(rows_of(data, table) for table in ("clips", "factors")):
        yield Fault("clips", "no clip; write [[clips]] tables or [[factors]] that generate them")
    yield from repeated(list(_named_clips(data)))


def _named_clips(data: Data) -> Iterator[tuple[Place, str]]:
    """Return the place and id of every clip, generated ones included where they can be read."""
    for table in ("practice", "clips", "gold"):
        for index, row in rows_of(data, table):
            if isinstance(row.get("id"), str):
                yield (table, index, "id"), row["id"]
    for index, row in rows_of(data, "factors"):
        try:
            yield from ((("factors", index), clip.id) for clip in Factors(**row).clips())
        except (ValidationError, TypeError):
            continue
    for index, row in rows_of(data, "catch"):
        try:
            yield ("catch", index), CatchClip(**row).clip().id
        except (ValidationError, TypeError):
            continue


def _check_repeats(data: Data) -> Iterator[Fault]:
    orbit = table_of(data, "orbit").get("directions")
    for place, values in (
        ("sizes", data.get("sizes")),
        ("distances", data.get("distances")),
        ("orbit.directions", orbit),
    ):
        listed = [v for v in values if isinstance(v, str)] if isinstance(values, list) else []
        for value in dict.fromkeys(v for v in listed if listed.count(v) > 1):
            yield Fault(place, f'"{value}" is listed twice')


_CHECKS: Final[tuple[Callable[[Data], Iterator[Fault]], ...]] = (
    _check_lods,
    check_switching,
    check_approaches,
    _check_references,
    check_irises,
    _check_clips,
    check_gold,
    check_attention,
    check_breaks,
    check_questions,
    check_consent,
    check_completion,
    check_decision,
    check_recruiting,
    _check_repeats,
)
