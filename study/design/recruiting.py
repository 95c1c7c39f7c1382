"""Where people come from: what their links bring, and how a browser goes from one to the next."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Annotated, Final, Literal

from pydantic import AfterValidator

from analysis import column_names
from study.design.faults import Fault, refuse
from study.design.parts import Flag, Part
from study.design.raw import Data, rows_of, table_of

MAX_VALUE_CHARS: Final = 200


def _check_parameter(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,39}", name):
        raise refuse(
            f'"{name}" is no parameter; use 1 to 40 letters, digits and "_", a letter first, like '
            "PROLIFIC_PID"
        )
    return name


class Parameter(Part):
    """One parameter of the address by which people come, such as ``PROLIFIC_PID``.

    ``hashed`` stores a keyed hash: equal values are known again, and nobody can compute them
    without the site's secret. ``is_person`` says that the value stands for a person: whoever comes
    with it again goes on with their own session.
    """

    name: Annotated[str, AfterValidator(_check_parameter)]
    store: Literal["hashed", "plain"] = "hashed"
    is_person: Flag = False
    is_exported: Flag = False
    is_required: Flag = False


class Recruiting(Part):
    """How people are let in.

    ``shared_computers`` is for laboratories: a browser forgets its participant when they finish,
    withdraw, or have done nothing for half an hour. ``links_only`` lets in personal links alone.
    """

    parameters: tuple[Parameter, ...] = ()
    links_only: Flag = False
    shared_computers: Flag = False

    @property
    def required(self) -> tuple[str, ...]:
        """The parameters without which nobody is let in."""
        return tuple(one.name for one in self.parameters if one.is_required)


def readable(value: str) -> str:
    """Return what a parameter brings, or nothing for what no recruiter sends.

    Anybody can write an address: too long, control characters and broken characters are out.
    """
    value = value.strip(" ")
    is_sound = 0 < len(value) <= MAX_VALUE_CHARS and value.isprintable() and "\ufffd" not in value
    return value if is_sound else ""


def check_recruiting(data: Data) -> Iterator[Fault]:
    """Yield parameters that are named twice, or whose column would be another's."""
    taken = {
        **dict.fromkeys(column_names("participants"), "a column of participants.csv"),
        **{
            str(row.get("id")): f"about.{index}"
            for index, row in rows_of(data, "about")
            if isinstance(row.get("id"), str)
        },
    }
    for index, row in rows_of(table_of(data, "recruiting"), "parameters"):
        place, name = f"recruiting.parameters.{index}", row.get("name")
        if not isinstance(name, str):
            continue
        if name in taken:
            yield Fault(f"{place}.name", f'"{name}" is taken by {taken[name]}; names must differ')
        taken.setdefault(name, place)
