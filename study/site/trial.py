"""The page of one trial: its clip and its questions."""

from __future__ import annotations

import secrets
from functools import partial
from typing import Any

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, Response

from study.data import answers, events, jobs, participants, progress
from study.data.errands import Errand
from study.data.progress import Step
from study.data.refusals import NotWatchedError
from study.data.senders import seeing
from study.data.trials import Trial
from study.design.definition import StudyDefinition
from study.design.questions import AnswerError, Question
from study.site.access import Visitor, as_visitor, check_csrf, redirect, step_url, to_current
from study.site.asker import Asker, by_cookie, found, locked, study_of
from study.site.forms import Fields, answers_in, first, read_form
from study.site.place import Place, place_in
from study.site.problems import problem_page
from study.site.trial_page import Shown, trial_page

router = APIRouter(default_response_class=HTMLResponse)
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
        await here.writer.write(partial(_see, request, here, asker))
    record = here.clips.record(step.trial.clip_id)
    if record is None:
        return await run_in_threadpool(_missing, request, here, visitor, step.trial)
    return trial_page(Shown(here, visitor, step, step.trial, every, record))


def _look(
    request: Request, here: Place, asker: Asker
) -> Errand[tuple[Any, tuple[Step, tuple[Trial, ...]] | None]]:
    who = yield from found(request, here, asker)
    stood = yield from progress.standing(who, study_of(here, who).definition)
    return who, stood


def _see(request: Request, here: Place, asker: Asker) -> Errand[None]:
    who = yield from locked(request, asker)
    yield from seeing(who, here.db.now())


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
        answers_in(fields, asked_in(definition, stood[0].trial)),
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
    given = answers_in(fields, asked_in(visitor.study.definition, current))
    shown = Shown(here, visitor, step, current, every, record)
    if isinstance(refused, AnswerError):
        return trial_page(shown, given=given, error=refused)
    return trial_page(shown, given=given, note="trial.locked_kept")


def _lead(request: Request, here: Place, asker: Asker) -> Response:
    """Lead to where they are somebody who is not among the trials."""
    who, _ = here.db.look(partial(_look, request, here, asker))
    return to_current(here, as_visitor(request, here, participants.record_of(who), asker.token))


def asked_in(definition: StudyDefinition, trial: Trial) -> tuple[Question, ...]:
    """Return what a trial asks."""
    return definition.questions_at(trial.number, is_practice=trial.is_practice)


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
