"""Irises as a factor of the clips: the study's own names for several of them.

A clip that names none shows the iris of ``[eye]``. Everything else about the eyes stays the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Final, Self

from pydantic import Field, model_validator

from renderer.clip import ClipSpec
from renderer.detail import Detail
from study.design.faults import Fault, dotted, refuse, unknown
from study.design.parts import Part, Whole, clip_value
from study.design.raw import Data, rows_of, table_of


class Iris(Part):
    """One iris that clips may show."""

    iris_seed: Annotated[Whole, Field(ge=0)] = 1
    iris_colour: Annotated[str, clip_value("iris_colour")] = "blue"
    iris_file: str = ""
    iris_sha256: str = ""

    @model_validator(mode="after")
    def _accepted_by_clip(self) -> Self:
        try:
            ClipSpec(left=Detail(), right=Detail(), **self.fields())
        except ValueError as error:
            raise refuse(str(error)) from None
        return self

    def fields(self) -> dict[str, Any]:
        """Return the fields of a clip's spec that this iris decides."""
        return self.model_dump()


def check_irises(data: Data) -> Iterator[Fault]:
    """Yield a fault for every iris that a clip names and the file does not have."""
    names = list(table_of(data, "irises"))
    for table, key in _NAMED:
        for index, row in rows_of(data, table):
            found = row.get(key)
            for name in found if isinstance(found, list) else [found]:
                if isinstance(name, str) and name not in names:
                    yield Fault(dotted((table, index, key)), unknown("iris", name, names))
    for index, row in rows_of(data, "factors"):
        listed = row.get("irises")
        if isinstance(listed, list) and len({str(name) for name in listed}) < len(listed):
            yield Fault(dotted(("factors", index, "irises")), "an iris is listed twice")


_NAMED: Final = (
    *((table, "iris") for table in ("practice", "clips", "catch", "gold")),
    ("factors", "irises"),
)
