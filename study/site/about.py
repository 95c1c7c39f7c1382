"""What a participant tells about themselves, and what they are told to do."""

from __future__ import annotations

import secrets
from collections.abc import Mapping
from functools import partial
from typing import Any

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, Response

from study.data import consents, steps
from study.data.errands import Errand
from study.design.definition import StudyDefinition
from study.design.questions import AnswerError, Question
from study.site.access import Visitor, visitor_or_none
from study.site.asker import nobody
from study.site.casting import Frame
from study.site.forms import answers_in, first, question_rows
from study.site.place import Place
from study.site.way import AtStep, Sent, at_step, go_on, on_the_way, sent_form

router = APIRouter(default_response_class=HTMLResponse)


@router.get("/about-you")
async def about(request: Request) -> Response:
    """Ask about the participant."""
    at = await at_step(request, "about")
    if drafts := await at.here.writer.look(partial(steps.drafting, at.who.id)):
        return await run_in_threadpool(_about_page, at.here, at.visitor, drafts)
    return at.page("about", own={"key": secrets.token_hex(16)}, fixed=partial(_blank, at))


def _blank(at: AtStep, _: Frame) -> dict[str, Any]:
    definition = at.visitor.study.definition
    questions = steps.asked_about(definition, with_health=at.has_health)
    return {
        "about": definition.about_page,
        "rows": question_rows(questions),
        "answers": {},
        "faults": {},
    }


def _about_page(
    here: Place,
    visitor: Visitor,
    answers: Mapping[str, object],
    error: AnswerError | None = None,
) -> Response:
    """Show the page with what was typed into it, and why it was not stored."""
    frame = on_the_way(here, visitor, "about")
    return here.page(
        "participant/about.html",
        status=422 if error else 200,
        **frame,
        about=visitor.study.definition.about_page,
        rows=question_rows(questions_about(here, visitor)),
        answers=answers,
        faults=error.said(frame["text"]) if error else {},
        key=secrets.token_hex(16),
    )


def questions_about(here: Place, visitor: Visitor) -> tuple[Question, ...]:
    """Return the questions about the participant, without those that they did not agree to."""
    with_health = consents.allows_health(here.db, visitor.participant)
    return steps.asked_about(visitor.study.definition, with_health=with_health)


@router.post("/about-you")
async def store_about(request: Request) -> Response:
    """Store the answers about the participant."""
    sent = await sent_form(request)
    try:
        return await go_on(request, sent, partial(_store, sent))
    except AnswerError as error:
        return await run_in_threadpool(_again, request, sent, error)


def _store(sent: Sent, who: Any, definition: StudyDefinition) -> Errand[bool]:
    key = first(sent.fields, "key") or "about"
    given = answers_in(sent.fields, (yield from steps.asking_about(who, definition)))
    return (yield from steps.storing_about(sent.here.db, who, definition, given, key=key))


def _again(request: Request, sent: Sent, error: AnswerError) -> Response:
    """Show the page once more, with what was given and why it was not stored."""
    visitor = visitor_or_none(request, sent.here)
    if visitor is None:
        raise nobody(request)
    given = answers_in(sent.fields, questions_about(sent.here, visitor))
    return _about_page(sent.here, visitor, given, error)


@router.get("/instructions")
async def instructions(request: Request) -> Response:
    """Say what to do."""
    at = await at_step(request, "instructions")
    return at.page(
        "instructions",
        own={"resume_url": at.visitor.resume_url},
        fixed=lambda _: {"instructions": at.visitor.study.definition.instructions},
    )


@router.post("/instructions")
async def read_instructions(request: Request) -> Response:
    """Note that the instructions were read."""
    sent = await sent_form(request)
    read = partial(steps.finishing_instructions, sent.here.db, key="instructions")
    return await go_on(request, sent, read)
