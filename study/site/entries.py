"""Entries of a browser's outbox: what they may hold, and how one is read.

It knows nothing of people or data.
"""

from __future__ import annotations

from typing import Annotated, Final, Literal

from fastapi import Request
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

# Plain values, and intervals as pairs of times in ms.
Whole = Annotated[int, Field(ge=-(2**53), le=2**53)]
Real = Annotated[float, Field(ge=-1e15, le=1e15, allow_inf_nan=False)]
Interval = tuple[Real, Real]
Fact = bool | Whole | Real | Annotated[str, Field(max_length=300)] | list[Interval] | None

Position = Annotated[int, Field(ge=0, le=100_000)]


class Entry(BaseModel):
    """What all entries have; ``at`` is the browser's clock, for the record."""

    model_config = ConfigDict(extra="forbid")
    key: Annotated[str, Field(min_length=1, max_length=64)]
    at: Annotated[str, Field(max_length=40)] = ""


# What was ticked of several: their values.
Ticked = Annotated[list[Annotated[str, Field(max_length=60)]], Field(max_length=200)]


class AnswerEntry(Entry):
    """An answer to one question of a trial; without a trial, of the page about the participant."""

    kind: Literal["answer"]
    position: Position | None = None
    question: Annotated[str, Field(max_length=60)]
    value: Annotated[str, Field(max_length=20_000)] | Ticked


class PlayEntry(Entry):
    """One play of a trial's clip, finished or not."""

    kind: Literal["play"]
    position: Position
    play: Annotated[dict[str, Fact], Field(max_length=100)]


class ProblemEntry(Entry):
    """Something that stopped the participant, by its code."""

    kind: Literal["problem"]
    position: Position | None = None
    code: Annotated[str, Field(max_length=200)]


AnyEntry = Annotated[AnswerEntry | PlayEntry | ProblemEntry, Field(discriminator="kind")]
ENTRY: Final[TypeAdapter[AnyEntry]] = TypeAdapter(AnyEntry)
# Read here and not by the framework, at a third of its price; this is what it would have declared.
_PLACE: Final = "#/paths/~1events/post/requestBody/content/application~1json/schema/$defs/{model}"
BODY: Final = {
    "content": {"application/json": {"schema": ENTRY.json_schema(ref_template=_PLACE)}},
    "required": True,
}


async def read_entry(request: Request) -> AnyEntry:
    """Read an entry; raises RequestValidationError for anything else."""
    if not request.headers.get("content-type", "").startswith("application/json"):
        raise RequestValidationError([])
    try:
        return ENTRY.validate_json(await request.body())
    except ValidationError as error:
        raise RequestValidationError(error.errors(include_url=False)) from None
