"""Faults between questions: rules that lead nowhere, values that no column can hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from analysis import column_names
from study.design.faults import Fault, Place, dotted, unknown
from study.design.question_kinds import EYES, cell_id
from study.design.questions import STANDARD
from study.design.raw import Data, repeated, rows_of

NUMERIC: Final = ("scale", "number", "analogue")
BOUNDS: Final = (("lowest", "highest"), ("minimum", "maximum"))
# A scale of more steps fits on no line of a page; a line to mark has no steps to be seen.
MOST_STEPS: Final = 11
COLUMNS: Final = frozenset((*column_names("comparisons"), *column_names("ratings")))
TAKEN: Final = COLUMNS - STANDARD.keys()


@dataclass(frozen=True)
class Earlier:
    """A question that a later one's rule may name."""

    kind: str
    values: list[Any]


def check_questions(data: Data) -> Iterator[Fault]:
    """Yield the faults of the questions after a clip and of those about the participant."""
    for table in ("questions", "about"):
        rows = rows_of(data, table)
        yield from repeated([found for i, row in rows for found in _ids(row, (table, i))])
        earlier: dict[str, Earlier] = {}
        for index, row in rows:
            yield from _check_rule(row, (table, index, "shown_if"), earlier)
            yield from check_question(row, (table, index))
            for _, name in _ids(row, (table, index)):
                kind = "scale" if row.get("kind") == "matrix" else str(row.get("kind"))
                earlier[name] = Earlier(kind, _values(row))
    for index, row in rows_of(data, "questions"):
        yield from _check_standard(row, ("questions", index))
        yield from _check_free(row, ("questions", index))


def check_question(row: Data, place: Place) -> Iterator[Fault]:
    """Yield the faults of one question that stands alone."""
    yield from _check_bounds(row, place)
    yield from _check_options(row, place)
    yield from _check_labels(row, place)


def _ids(row: Data, place: Place) -> list[tuple[Place, str]]:
    """Return the ids that a question's answers get, with where each is given."""
    name = row.get("id")
    if not isinstance(name, str):
        return []
    if row.get("kind") != "matrix":
        return [((*place, "id"), name)]
    sides = EYES if row.get("per_eye") is True else ("",)
    return [
        ((*place, "rows", index, "id"), cell_id(name, str(line.get("id")), side))
        for side in sides
        for index, line in rows_of(row, "rows")
    ]


def _check_rule(row: Data, place: Place, earlier: Mapping[str, Earlier]) -> Iterator[Fault]:
    rule = row.get("shown_if")
    if not isinstance(rule, Mapping) or not isinstance(rule.get("question"), str):
        return
    if rule["question"] not in earlier:
        yield Fault(
            dotted((*place, "question")), unknown("earlier question", rule["question"], earlier)
        )
        return
    named = earlier[rule["question"]]
    bounds = [key for key in ("at_least", "at_most") if rule.get(key) is not None]
    if not bounds and not rule.get("values"):
        yield Fault(dotted(place), "says no answer; give values, at_least or at_most")
    if bounds and rule.get("values"):
        yield Fault(dotted(place), f"values and {bounds[0]} exclude each other; use one of them")
    if bounds and named.kind not in NUMERIC:
        found = f"{rule['question']} is answered by no number; use values"
        yield Fault(dotted((*place, bounds[0])), found)
    values = rule.get("values")
    for value in values if isinstance(values, list) else []:
        if value not in named.values:
            yield Fault(
                dotted((*place, "values")), unknown("answer", value, map(str, named.values))
            )


def _check_bounds(row: Data, place: Place) -> Iterator[Fault]:
    for low, high in BOUNDS:
        ends = row.get(low), row.get(high)
        numbers = [end for end in ends if isinstance(end, int | float)]
        if len(numbers) == 2 and numbers[0] >= numbers[1]:
            yield Fault(dotted((*place, high)), f"{numbers[1]} is not above {low} {numbers[0]}")
    steps = len(_values(row))
    if row.get("kind") in ("scale", "matrix") and steps > MOST_STEPS:
        found = f"{steps} steps do not fit on a line; at most {MOST_STEPS}, or use an analogue"
        yield Fault(dotted((*place, "highest")), found)


def _check_options(row: Data, place: Place) -> Iterator[Fault]:
    values = _values(row)
    if row.get("kind") not in ("choice", "multiple"):
        return
    if len(set(map(str, values))) < len(values):
        yield Fault(dotted((*place, "options")), "two options have the same value")
    fewest, most = row.get("fewest", 1), row.get("most")
    for key, number in (("fewest", fewest), ("most", most)):
        if isinstance(number, int) and number > len(values):
            yield Fault(dotted((*place, key)), f"{number} of {len(values)} options")
    if isinstance(fewest, int) and isinstance(most, int) and fewest > most:
        yield Fault(dotted((*place, "most")), f"{most} is fewer than fewest, {fewest}")


def _check_labels(row: Data, place: Place) -> Iterator[Fault]:
    """A scale names its ends, or every step."""
    if row.get("kind") not in ("scale", "matrix"):
        return
    labels = row.get("labels")
    if isinstance(labels, list) and labels:
        steps = len(_values(row))
        if len(labels) != steps:
            yield Fault(dotted((*place, "labels")), f"{len(labels)} labels for {steps} steps")
        return
    for key in ("lowest_label", "highest_label"):
        if not row.get(key):
            yield Fault(dotted((*place, key)), "missing; this key is required without labels")


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


def _check_free(row: Data, place: Place) -> Iterator[Fault]:
    """The id of a study's own question must not be a column that says something else."""
    for here, name in _ids(row, place):
        if name in TAKEN:
            yield Fault(dotted(here), f'"{name}" is a column of the tables already; rename it')


def _values(row: Data) -> list[Any]:
    options = row.get("options")
    if row.get("kind") in ("choice", "multiple") and isinstance(options, list | tuple):
        return [o["value"] for o in options if isinstance(o, Mapping) and "value" in o]
    low, high = row.get("lowest", 1), row.get("highest", 5)
    is_steps = row.get("kind") in ("scale", "matrix")
    if is_steps and isinstance(low, int) and isinstance(high, int):
        return list(range(low, min(high, low + 1000) + 1))
    return []
