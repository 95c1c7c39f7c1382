"""The page of one trial: its clip and its questions."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Mapping

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, Response

from study.data import answers, events, jobs, participants, trials
from study.data.progress import Step
from study.data.refusals import NotReachedError, NotWatchedError
from study.design.questions import AnswerError
from study.site.access import AVisitor, Visitor, VisitorsForm, step_of, to_current
from study.site.forms import answers_in, first, question_rows
from study.site.frame import shared
from study.site.media import clip_url
from study.site.place import Here
from study.site.problems import problem_page
from study.site.time_left import minutes_left

router = APIRouter(default_response_class=HTMLResponse)
Say = Callable[..., str]
LONGEST_MS = 24 * 3600 * 1000


@router.get("/trial/{position}")
def trial(request: Request, here: Here, visitor: AVisitor, position: int) -> Response:
    """Show the participant's current trial; any other leads there."""
    step = step_of(here, visitor, "practice", "trial")
    if step.trial is None or step.trial.position != position:
        return to_current(here, visitor)
    participants.seen(here.db, visitor.participant)
    return _trial_page(request, here, visitor, step)


def _trial_page(
    request: Request,
    here: Here,
    visitor: Visitor,
    step: Step,
    *,
    given: Mapping[str, object] | None = None,
    error: AnswerError | None = None,
    note: str = "",
) -> Response:
    if step.trial is None:
        return to_current(here, visitor)
    found = step.trial
    record = here.clips.record(found.clip_id)
    if record is None:
        return _missing(request, here, visitor, found)
    definition = visitor.study.definition
    every = trials.all_trials(here.db, visitor.participant, open_only=True)
    is_last = found.position == every[-1].position
    frame = shared(visitor.study, visitor, "trial")
    text = frame["text"]
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
        minutes_left=minutes_left(definition, every),
        rows=question_rows(definition.questions),
        answers={**found.answers, **(given or {})},
        faults=error.said(text) if error else {},
        note=text(note) if note else "",
        key=secrets.token_hex(16),
        button=text("trial.finish" if is_last else "trial.next"),
    )


def _views_allowed(most: int | None, found: trials.Trial) -> int | None:
    """Return how many more plays the study allows, None for any number."""
    return None if most is None else max(0, most - found.views)


def _heading(step: Step, text: Say) -> str:
    if step.name == "practice" and step.total == 1:
        return text("trial.practice")
    key = "trial.practice_number" if step.name == "practice" else "trial.clip_number"
    return text(key, number=step.number, total=step.total)


def _steps(every: tuple[trials.Trial, ...], current: trials.Trial) -> list[str]:
    """Return the marks of the progress bar: one per trial of the current kind."""
    alike = [one for one in every if one.is_practice == current.is_practice]
    return [
        "now" if one.position == current.position else "done" if one.is_complete else "ahead"
        for one in alike
    ]


def _to_come(here: Here, every: tuple[trials.Trial, ...], current: trials.Trial) -> list[str]:
    """Return address and length of the clips that come later, for the preloader."""
    records = (here.clips.record(one.clip_id) for one in every if one.position > current.position)
    return [f"{clip_url(record)} {record.file_bytes}" for record in records if record is not None]


def _missing(request: Request, here: Here, visitor: Visitor, found: trials.Trial) -> Response:
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
def finish(
    request: Request, here: Here, visitor: AVisitor, fields: VisitorsForm, position: int
) -> Response:
    """Store the whole questionnaire and go on; a trial that is over changes no more."""
    step = step_of(here, visitor)
    if step.trial is None or step.trial.position != position:
        return to_current(here, visitor)
    given = answers_in(fields, visitor.study.definition.questions)
    try:
        answers.store(
            here.db,
            visitor.participant,
            position,
            given,
            key=first(fields, "key") or f"finish-{position}",
            is_final=True,
            response_ms=_milliseconds(first(fields, "response_ms")),
            clock_ms=_step_ms(first(fields, "clock_ms")),
        )
    except AnswerError as error:
        return _trial_page(request, here, visitor, step, given=given, error=error)
    except NotWatchedError:
        note = "trial.locked_kept"
        return _trial_page(request, here, visitor, step, given=given, note=note)
    except NotReachedError:
        return to_current(here, visitor)
    return to_current(here, visitor)


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
