"""Faults between questions: rules that lead nowhere, values that no column can hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from study.design.faults import Fault, Place, dotted, unknown
from study.design.questions import STANDARD
from study.design.raw import Data, repeated, rows_of


def check_questions(data: Data) -> Iterator[Fault]:
    """Yield the faults of the questions after a clip and of those about the participant."""
    for table in ("questions", "about"):
        rows = rows_of(data, table)
        yield from repeated(
            [((table, i, "id"), row["id"]) for i, row in rows if isinstance(row.get("id"), str)]
        )
        earlier: dict[str, list[Any]] = {}
        for index, row in rows:
            yield from _check_rule(row, (table, index, "shown_if"), earlier)
            yield from _check_values(row, (table, index))
            if isinstance(row.get("id"), str):
                earlier[row["id"]] = _values(row)
    for index, row in rows_of(data, "questions"):
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
