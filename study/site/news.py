"""What a participant's browser reports as it happens: answers, plays, problems.

Every entry carries a key of the browser's making; the same entry again is acknowledged and changes
nothing. "ok" is said only when the entry is on the disk.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter
from pydantic import BaseModel, ConfigDict, Field

from study.data import answers, events, trials, views
from study.design.certificate import judge
from study.design.questions import AnswerError, read_answers
from study.site.about import DRAFTED, questions_about
from study.site.access import Visitor
from study.site.language import language_of
from study.site.media import to_expect
from study.site.place import Here
from study.site.reporter import Reporter
from study.texts import catalogue

router = APIRouter()


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


@router.post("/events")
def report(
    here: Here,
    visitor: Reporter,
    entry: AnyEntry,
) -> dict[str, Any]:
    """Store one entry, and say so only once it is stored: by the entry's own key.

    An answer that cannot be stored is refused kindly: the form says why when it is sent.
    """
    if not visitor.is_simulated:
        here.pace.check(visitor.name)
    if isinstance(entry, AnswerEntry):
        told = _answer(here, visitor, entry)
    elif isinstance(entry, PlayEntry):
        told = _play(here, visitor, entry)
    else:
        stored = events.record(
            here.db,
            visitor.participant,
            key=entry.key,
            kind="problem",
            payload={"code": entry.code},
            position=entry.position,
        )
        told = {"ok": True, "new": stored.new}
    return {**told, "key": entry.key}


def _play(here: Here, visitor: Visitor, entry: PlayEntry) -> dict[str, Any]:
    """Store a play beside what the shelf knows of its clip, and say whether it counts."""
    clip_id = trials.clip_id_at(here.db, visitor.participant, entry.position)
    record = None if clip_id is None else here.clips.record(clip_id)
    play = entry.play if record is None else {**entry.play, **to_expect(record)}
    stored = views.record(here.db, visitor.participant, entry.position, key=entry.key, play=play)
    verdict = judge(play, visitor.study.definition.certificate)
    return {
        "ok": True,
        "new": stored.new,
        "certified": verdict.certified,
        "reasons": verdict.reasons,
    }


def _answer(here: Here, visitor: Visitor, entry: AnswerEntry) -> dict[str, Any]:
    given = {entry.question: entry.value}
    try:
        if entry.position is None:
            read_answers(questions_about(here, visitor), given, is_final=False)
            draft = {"question": entry.question, "value": entry.value}
            stored = events.record(
                here.db, visitor.participant, key=entry.key, kind=DRAFTED, payload=draft
            )
            return {"ok": True, "new": stored.new}
        answer = answers.store(here.db, visitor.participant, entry.position, given, key=entry.key)
    except AnswerError as error:
        words = catalogue(language_of(visitor.study, (visitor.participant.language,)))
        return {"ok": False, "faults": error.said(words.text)}
    return {"ok": True, "new": answer.new, "is_over": answer.trial_complete}
