"""The page of one trial: its clip and its questions."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, Response

from renderer.manifest import ClipRecord
from study.data import answers, events, jobs, participants, progress
from study.data.errands import Errand
from study.data.progress import Step
from study.data.refusals import NotWatchedError
from study.data.trials import Trial
from study.design.definition import StudyDefinition
from study.design.questions import AnswerError, Question
from study.site.access import Visitor, as_visitor, check_csrf, redirect, step_url, to_current
from study.site.asker import Asker, by_cookie, found, locked, study_of
from study.site.forms import Fields, answers_in, first, read_form
from study.site.frame import shared
from study.site.media import clip_url
from study.site.place import Place, place_in
from study.site.problems import problem_page
from study.site.time_left import minutes_left

router = APIRouter(default_response_class=HTMLResponse)
Say = Callable[..., str]
LONGEST_MS = 24 * 3600 * 1000


@router.get("/trial/{position}")
async def trial(request: Request, position: int) -> Response:
    """Show the participant's current trial; any other leads there."""
    here = place_in(request)
    asker = by_cookie(request, here)
    who, stood = await here.writer.look(partial(_look, request, here, asker))
    visitor = as_visitor(request, here, participants.record_of(who), asker.token)
    if stood is None:
        return await run_in_threadpool(to_current, here, visitor)
    step, every = stood
    if step.trial is None or step.trial.position != position:
        return redirect(step_url(step))
    if here.db.now() - who.last_seen_at >= participants.SEEN_AGAIN:
        await run_in_threadpool(participants.seen, here.db, visitor.participant)
    record = here.clips.record(step.trial.clip_id)
    if record is None:
        return await run_in_threadpool(_missing, request, here, visitor, step.trial)
    return _trial_page(here, visitor, step, every, record)


def _look(
    request: Request, here: Place, asker: Asker
) -> Errand[tuple[Any, tuple[Step, tuple[Trial, ...]] | None]]:
    who = yield from found(request, here, asker)
    stood = yield from progress.standing(who, study_of(here, who).definition)
    return who, stood


def _trial_page(
    here: Place,
    visitor: Visitor,
    step: Step,
    every: tuple[Trial, ...],
    record: ClipRecord,
    *,
    given: Mapping[str, object] | None = None,
    error: AnswerError | None = None,
    note: str = "",
) -> Response:
    found = step.trial
    if found is None:
        return redirect(step_url(step))
    definition = visitor.study.definition
    is_last = found.position == every[-1].position
    frame = shared(visitor.study, visitor, "trial")
    text = frame["text"]
    answers_so_far = {**found.answers, **(given or {})}
    parts = here.parts.of(definition, text)
    rows = parts.rows_of(_asked_in(definition, found))
    is_blank = not (answers_so_far or error) and rows is parts.rows
    return here.page(
        "participant/trial.html",
        status=422 if error or note else 200,
        **frame,
        heading=_heading(step, text),
        steps=_steps(every, found),
        position=found.position,
        clip=record,
        clip_url=clip_url(record),
        next_clips=_to_come(here, every, found),
        is_practice=found.is_practice,
        is_watched=found.views >= definition.order.min_views,
        views_left=max(0, definition.order.min_views - found.views),
        views_allowed=_views_allowed(definition.order.max_views, found),
        retries=definition.certificate.retries,
        code=f"{visitor.name.upper()}-{found.position}",
        seconds=max(1, round(record.frame_count / record.fps)),
        minutes_left=minutes_left(definition, every, estimate_s=parts.estimate_s),
        rows=rows,
        blank=parts.blank if is_blank else None,
        answers=answers_so_far,
        faults=error.said(text) if error else {},
        note=text(note) if note else "",
        key=secrets.token_hex(16),
        button=text("trial.finish" if is_last else "trial.next"),
    )


def _asked_in(definition: StudyDefinition, found: Trial) -> tuple[Question, ...]:
    return definition.questions_at(found.number, is_practice=found.is_practice)


def _views_allowed(most: int | None, found: Trial) -> int | None:
    """Return how many more plays the study allows, None for any number."""
    return None if most is None else max(0, most - found.views)


def _heading(step: Step, text: Say) -> str:
    if step.name == "practice" and step.total == 1:
        return text("trial.practice")
    key = "trial.practice_number" if step.name == "practice" else "trial.clip_number"
    return text(key, number=step.number, total=step.total)


def _steps(every: tuple[Trial, ...], current: Trial) -> list[str]:
    """Return the marks of the progress bar: one per trial of the current kind."""
    alike = [one for one in every if one.is_practice == current.is_practice]
    return [
        "now" if one.position == current.position else "done" if one.is_complete else "ahead"
        for one in alike
    ]


def _to_come(here: Place, every: tuple[Trial, ...], current: Trial) -> list[str]:
    """Return address and length of the clips that come later, for the preloader."""
    records = here.clips.records(one.clip_id for one in every if one.position > current.position)
    return [f"{clip_url(record)} {record.file_bytes}" for record in records]


def _missing(request: Request, here: Place, visitor: Visitor, found: Trial) -> Response:
    """Stop visibly where a clip is not there: the dashboard shows it, a worker makes it again."""
    jobs.requeue(here.db, [found.clip_id])
    events.record(
        here.db,
        visitor.participant,
        key=f"missing-{secrets.token_hex(8)}",
        kind="problem",
        payload={"code": "CLIP-MISSING"},
        position=found.position,
    )
    code = f"CLIP-MISSING {visitor.name.upper()}-{found.position}"
    return problem_page(request, status=503, code=code)


@router.post("/trial/{position}")
async def finish(request: Request, position: int) -> Response:
    """Store the whole questionnaire and go on; a trial that is over changes no more."""
    here = place_in(request)
    asker = by_cookie(request, here)
    fields = await read_form(request)
    check_csrf(here.secret, asker.token, first(fields, "csrf"))
    try:
        step = await here.writer.write(partial(_finish, request, here, asker, fields, position))
    except (AnswerError, NotWatchedError) as refused:
        return await run_in_threadpool(_again, request, here, asker, fields, refused)
    if step is not None:
        return redirect(step_url(step))
    return await run_in_threadpool(_lead, request, here, asker)


def _finish(
    request: Request, here: Place, asker: Asker, fields: Fields, position: int
) -> Errand[Step | None]:
    """Store the questionnaire if this is the trial that is open; returns where they are now."""
    who = yield from locked(request, asker)
    definition = study_of(here, who).definition
    stood = yield from progress.standing(who, definition)
    if stood is None or stood[0].trial is None or stood[0].trial.position != position:
        return None if stood is None else stood[0]
    yield from answers.storing(
        here.db,
        definition,
        who,
        position,
        answers_in(fields, _asked_in(definition, stood[0].trial)),
        key=first(fields, "key") or f"finish-{position}",
        is_final=True,
        response_ms=_milliseconds(first(fields, "response_ms")),
        clock_ms=_step_ms(first(fields, "clock_ms")),
    )
    now = yield from progress.standing(who, definition)
    return None if now is None else now[0]


def _again(
    request: Request, here: Place, asker: Asker, fields: Fields, refused: Exception
) -> Response:
    """Show the page once more, with what was given and why it was not stored."""
    who, stood = here.db.look(partial(_look, request, here, asker))
    visitor = as_visitor(request, here, participants.record_of(who), asker.token)
    if stood is None or stood[0].trial is None:
        return to_current(here, visitor)
    (step, every), current = stood, stood[0].trial
    record = here.clips.record(current.clip_id)
    if record is None:
        return _missing(request, here, visitor, current)
    given = answers_in(fields, _asked_in(visitor.study.definition, current))
    if isinstance(refused, AnswerError):
        return _trial_page(here, visitor, step, every, record, given=given, error=refused)
    return _trial_page(here, visitor, step, every, record, given=given, note="trial.locked_kept")


def _lead(request: Request, here: Place, asker: Asker) -> Response:
    """Lead to where they are somebody who is not among the trials."""
    who, _ = here.db.look(partial(_look, request, here, asker))
    return to_current(here, as_visitor(request, here, participants.record_of(who), asker.token))


def _milliseconds(text: str) -> int | None:
    """Read a time that a browser reports; None for anything that cannot be one."""
    return int(text) if text.isdecimal() and 0 < int(text[:12]) <= LONGEST_MS else None


def _step_ms(text: str) -> float | None:
    """Read how coarse a browser's clock is; None for anything that cannot be it."""
    try:
        value = float(text[:12])
    except ValueError:
        return None
    return value if 0 < value <= LONGEST_MS else None
