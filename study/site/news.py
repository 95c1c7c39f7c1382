"""What a participant's browser reports as it happens: answers, plays, problems.

Every entry carries a key of the browser's making; the same entry again is acknowledged and changes
nothing. "ok" is said only when the entry is on the disk.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Header
from pydantic import BaseModel, ConfigDict, Field

from study.data import answers, events, views
from study.design.questions import AnswerError, read_answers
from study.site.about import DRAFTED
from study.site.access import AVisitor, Visitor, check_csrf
from study.site.place import Here

router = APIRouter()


class Entry(BaseModel):
    """What all entries have; ``at`` is the browser's clock, for the record."""

    model_config = ConfigDict(extra="forbid")
    key: Annotated[str, Field(min_length=1, max_length=64)]
    at: Annotated[str, Field(max_length=40)] = ""


class AnswerEntry(Entry):
    """An answer to one question of a trial; without a trial, of the page about the participant."""

    kind: Literal["answer"]
    position: int | None = None
    question: Annotated[str, Field(max_length=60)]
    value: Annotated[str, Field(max_length=20_000)]


class PlayEntry(Entry):
    """One play of a trial's clip, finished or not."""

    kind: Literal["play"]
    position: int
    play: dict[str, bool | int | float | str | None]


class ProblemEntry(Entry):
    """Something that stopped the participant, by its code."""

    kind: Literal["problem"]
    position: int | None = None
    code: Annotated[str, Field(max_length=200)]


AnyEntry = Annotated[AnswerEntry | PlayEntry | ProblemEntry, Field(discriminator="kind")]


@router.post("/events")
def report(
    here: Here,
    visitor: AVisitor,
    entry: AnyEntry,
    x_csrf_token: Annotated[str, Header()] = "",
) -> dict[str, Any]:
    """Store one entry, and say so only once it is stored.

    An answer that cannot be stored is refused kindly: the form says why when it is sent.
    """
    check_csrf(here.secret, visitor.token, x_csrf_token)
    if isinstance(entry, AnswerEntry):
        return _answer(here, visitor, entry)
    if isinstance(entry, PlayEntry):
        stored = views.record(
            here.db, visitor.participant, entry.position, key=entry.key, play=entry.play
        )
    else:
        stored = events.record(
            here.db,
            visitor.participant,
            key=entry.key,
            kind="problem",
            payload={"code": entry.code},
            position=entry.position,
        )
    return {"ok": True, "new": stored.new}


def _answer(here: Here, visitor: Visitor, entry: AnswerEntry) -> dict[str, Any]:
    given = {entry.question: entry.value}
    try:
        if entry.position is None:
            read_answers(visitor.study.definition.about, given, is_final=False)
            draft = {"question": entry.question, "value": entry.value}
            stored = events.record(
                here.db, visitor.participant, key=entry.key, kind=DRAFTED, payload=draft
            )
            return {"ok": True, "new": stored.new}
        answer = answers.store(here.db, visitor.participant, entry.position, given, key=entry.key)
    except AnswerError as error:
        return {"ok": False, "faults": error.faults}
    return {"ok": True, "new": answer.new, "is_over": answer.trial_complete}
