"""What a participant tells about themselves, and what they are told to do."""

from __future__ import annotations

import secrets
from typing import Final

from fastapi import APIRouter
from fastapi.responses import HTMLResponse, Response

from study.data import consents, events, steps
from study.design.questions import AnswerError, Question
from study.site.access import AVisitor, Visitor, VisitorsForm, step_of, to_current
from study.site.forms import answers_in, first, question_rows
from study.site.place import Here
from study.site.way import on_the_way

router = APIRouter(default_response_class=HTMLResponse)
DRAFTED: Final = "drafted"


@router.get("/about-you")
def about(here: Here, visitor: AVisitor) -> Response:
    """Ask about the participant."""
    step_of(here, visitor, "about")
    return _about_page(here, visitor, _drafts(here, visitor))


def questions_about(here: Here, visitor: Visitor) -> tuple[Question, ...]:
    """Return the questions about the participant, without those that they did not agree to."""
    with_health = consents.allows_health(here.db, visitor.participant)
    return steps.asked_about(visitor.study.definition, with_health=with_health)


def _drafts(here: Here, visitor: Visitor) -> dict[str, object]:
    """Return what was typed into this page before, in case it was left in the middle."""
    drafted: dict[str, object] = {}
    for event in events.history(here.db, visitor.participant):
        if event.kind == DRAFTED:
            drafted[str(event.payload["question"])] = event.payload["value"]
    return drafted


def _about_page(
    here: Here, visitor: Visitor, answers: dict[str, object], error: AnswerError | None = None
) -> Response:
    definition = visitor.study.definition
    frame = on_the_way(here, visitor, "about")
    return here.page(
        "participant/about.html",
        status=422 if error else 200,
        **frame,
        about=definition.about_page,
        rows=question_rows(questions_about(here, visitor)),
        answers=answers,
        faults=error.said(frame["text"]) if error else {},
        key=secrets.token_hex(16),
    )


@router.post("/about-you")
def store_about(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """Store the answers about the participant."""
    answers = answers_in(fields, questions_about(here, visitor))
    try:
        steps.store_about(
            here.db, visitor.participant, answers, key=first(fields, "key") or "about"
        )
    except AnswerError as error:
        return _about_page(here, visitor, answers, error)
    return to_current(here, visitor)


@router.get("/instructions")
def instructions(here: Here, visitor: AVisitor) -> Response:
    """Say what to do."""
    step_of(here, visitor, "instructions")
    return here.page(
        "participant/instructions.html",
        **on_the_way(here, visitor, "instructions"),
        instructions=visitor.study.definition.instructions,
    )


@router.post("/instructions")
def read_instructions(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """Note that the instructions were read."""
    del fields  # the form carries only its proof
    steps.finish_instructions(here.db, visitor.participant, key="instructions")
    return to_current(here, visitor)
