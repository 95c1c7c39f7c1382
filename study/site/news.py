"""What a participant's browser reports as it happens: answers, plays, problems.

Every entry carries a key of the browser's making; the same entry again is acknowledged and changes
nothing. "ok" is said only when the entry is on the disk.
"""

from __future__ import annotations

from functools import partial
from typing import Any

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse

from study.data import answers, events, participants, views
from study.data.errands import Errand, Make
from study.data.steps import DRAFTED
from study.data.studies import Study
from study.design.certificate import judge
from study.design.questions import AnswerError, read_answers
from study.site.about import questions_about
from study.site.access import as_visitor
from study.site.asker import Asker, by_outbox, locked, study_of
from study.site.entries import BODY, AnswerEntry, AnyEntry, PlayEntry, ProblemEntry, read_entry
from study.site.language import language_of
from study.site.media import to_expect
from study.site.place import Place, place_in
from study.texts import catalogue

router = APIRouter()


@router.post("/events", openapi_extra={"requestBody": BODY})
async def report(request: Request) -> JSONResponse:
    """Store one entry, and say so only once it is stored: by the entry's own key.

    An answer that cannot be stored is refused kindly: the form says why when it is sent.
    """
    here, entry = place_in(request), await read_entry(request)
    sender = partial(_sender, request, here, by_outbox(request, here))
    try:
        told = await _stored(request, here, entry, sender)
    except LotFullError as full:
        await run_in_threadpool(here.pace.settle, full.name)
        told = await _stored(request, here, entry, partial(sender, is_counted=True))
    return JSONResponse({**told, "key": entry.key})


async def _stored(
    request: Request, here: Place, entry: AnyEntry, sender: Make[Any]
) -> dict[str, Any]:
    if isinstance(entry, PlayEntry):
        return await here.writer.write(partial(_play, here, entry, sender))
    if isinstance(entry, AnswerEntry) and entry.position is not None:
        return await here.writer.write(partial(_answer, here, entry, entry.position, sender))
    return await run_in_threadpool(_rare, request, here, entry, sender)


class LotFullError(Exception):
    """Before this entry is stored, the database is to be told how many came by this name."""

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(name)


def _sender(
    request: Request, here: Place, asker: Asker, *, is_counted: bool = False
) -> Errand[Any]:
    who = yield from locked(request, asker)
    if not (who.simulated or is_counted) and here.pace.count(who.public_id):
        raise LotFullError(who.public_id)
    return who


def _play(here: Place, entry: PlayEntry, sender: Make[Any]) -> Errand[dict[str, Any]]:
    """Store a play beside what the shelf knows of its clip, and say whether it counts."""
    who = yield from sender()

    def known(clip_id: str) -> dict[str, Any]:
        record = here.clips.record(clip_id)
        return entry.play if record is None else {**entry.play, **to_expect(record)}

    stored, play = yield from views.recording(
        here.db, who, entry.position, key=entry.key, play=known
    )
    verdict = judge(play, study_of(here, who).definition.certificate)
    return {
        "ok": True,
        "new": stored.new,
        "certified": verdict.certified,
        "reasons": verdict.reasons,
    }


def _answer(
    here: Place, entry: AnswerEntry, position: int, sender: Make[Any]
) -> Errand[dict[str, Any]]:
    who = yield from sender()
    study, given = study_of(here, who), {entry.question: entry.value}
    try:
        stored = yield from answers.storing(
            here.db, study.definition, who, position, given, key=entry.key
        )
    except AnswerError as error:
        return {"ok": False, "faults": _said(study, who.language, error)}
    return {"ok": True, "new": stored.new, "is_over": stored.trial_complete}


def _said(study: Study, language: str, error: AnswerError) -> Any:
    return error.said(catalogue(language_of(study, (language,))).text)


def _rare(
    request: Request, here: Place, entry: AnswerEntry | ProblemEntry, sender: Make[Any]
) -> dict[str, Any]:
    """Store a draft about the participant, or a problem."""
    participant = participants.record_of(here.db.run(sender))
    payload: dict[str, Any]
    if isinstance(entry, ProblemEntry):
        kind, payload = "problem", {"code": entry.code}
    else:
        visitor = as_visitor(request, here, participant, "")
        try:
            given = {entry.question: entry.value}
            read_answers(questions_about(here, visitor), given, is_final=False)
        except AnswerError as error:
            return {"ok": False, "faults": _said(visitor.study, participant.language, error)}
        kind, payload = DRAFTED, {"question": entry.question, "value": entry.value}
    stored = events.record(
        here.db,
        participant,
        key=entry.key,
        kind=kind,
        payload=payload,
        position=entry.position,
    )
    return {"ok": True, "new": stored.new}
