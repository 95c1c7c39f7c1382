"""Between trials: a page to rest at, or a question that says itself what to answer."""

from __future__ import annotations

from collections.abc import Mapping

from fastapi import APIRouter
from fastapi.responses import HTMLResponse, Response

from study.data import participants, pauses
from study.data.progress import Step
from study.data.refusals import NotReachedError
from study.design.questions import AnswerError
from study.site.access import AVisitor, Visitor, VisitorsForm, step_of, to_current
from study.site.forms import answers_in, first
from study.site.frame import shared
from study.site.place import Here

router = APIRouter(default_response_class=HTMLResponse)


@router.get("/pause")
def pause(here: Here, visitor: AVisitor) -> Response:
    """Show the break or the question that is due."""
    step = step_of(here, visitor, "pause")
    participants.seen(here.db, visitor.participant)
    return _page(here, visitor, step, {})


def _page(
    here: Here,
    visitor: Visitor,
    step: Step,
    answers: Mapping[str, object],
    error: AnswerError | None = None,
) -> Response:
    if step.pause is None:
        return to_current(here, visitor)
    frame = shared(visitor.study, visitor, "pause")
    return here.page(
        f"participant/{step.pause.kind}.html",
        status=422 if error else 200,
        **frame,
        pause=step.pause,
        question=_question(visitor, step),
        breaks=visitor.study.definition.breaks,
        done=step.number,
        total=step.total,
        answers=answers,
        faults=error.said(frame["text"]) if error else {},
    )


def _question(visitor: Visitor, step: Step) -> object:
    """Return the question of the pause in the visitor's language, or None at a break."""
    mine = [p for p in visitor.study.definition.pauses if step.pause and p.key == step.pause.key]
    return mine[0].attention.question if mine and mine[0].attention else None


@router.post("/pause")
def go_on(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """Note that the pause is over, and go on."""
    step = step_of(here, visitor)
    name = first(fields, "pause")
    if step.pause is None or step.pause.key != name:
        return to_current(here, visitor)
    asked = step.pause.attention
    given = answers_in(fields, [asked.question]) if asked else {}
    try:
        pauses.finish(here.db, visitor.participant, name, given)
    except AnswerError as error:
        return _page(here, visitor, step, given, error)
    except NotReachedError:  # sent twice at once: the other one was faster
        pass
    return to_current(here, visitor)
