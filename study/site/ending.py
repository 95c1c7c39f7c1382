"""The last pages: one for each way in which taking part ends, with its code and the way back."""

from __future__ import annotations

from functools import partial
from typing import Any

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, Response

from study.data import completion, own_data
from study.design.completion import GENERATED, filled, names_in
from study.design.definition import StudyDefinition
from study.design.texts import Paragraph
from study.site.access import AVisitor, Visitor
from study.site.casting import Frame, cast_page
from study.site.place import Here
from study.site.way import AtStep, at_step

router = APIRouter()


@router.get("/thanks", response_class=HTMLResponse)
async def thanks(request: Request) -> Response:
    """Thank, with the code that proves that every answer is stored."""
    return _last_page(await at_step(request, "thanks"))


@router.get("/screened-out", response_class=HTMLResponse)
async def screened_out(request: Request) -> Response:
    """Say that taking part is not possible here, with the code for that."""
    return _last_page(await at_step(request, "screened_out"))


def _last_page(at: AtStep) -> Response:
    visitor = at.visitor
    outcome, definition = at.who.outcome or completion.COMPLETED, visitor.study.definition
    code = completion.code_of(at.who, definition)
    redirect = way_back(visitor, definition.endings.ending(outcome).redirect, code)
    own = {"completion_code": code, "redirect": redirect, "resume_url": visitor.resume_url}
    own = {name: value for name, value in own.items() if value is not None}
    return cast_page(
        at.here,
        visitor.study,
        visitor,
        "thanks",
        own=own,
        asked=(outcome, *own),
        fixed=partial(_said, definition, outcome),
    )


def _said(definition: StudyDefinition, outcome: str, frame: Frame) -> dict[str, Any]:
    """Return what the page says in the study's words, or the catalogue's."""
    text, ending = frame["text"], definition.endings.ending(outcome)
    title, paragraphs = ending.title, ending.paragraphs
    if outcome == completion.COMPLETED:
        title = title or definition.thanks.title
        paragraphs = paragraphs or definition.thanks.paragraphs
    else:
        title = title or text(f"ending.{outcome}.title")
        paragraphs = paragraphs or (Paragraph(text=text(f"ending.{outcome}.text")),)
    is_done = outcome == completion.COMPLETED
    return {
        "outcome": outcome,
        "title": title,
        "paragraphs": paragraphs,
        "code_is": text("thanks.code" if is_done else f"ending.{outcome}.code"),
        "completion_code": None,
        "is_own_code": definition.endings.code_of(outcome) == GENERATED,
        "redirect": None,
        "redirect_label": ending.redirect_label or text("thanks.way_back"),
    }


def way_back(visitor: Visitor, template: str | None, code: str | None) -> str | None:
    """Return the address that leads back to where a participant came from; None without one.

    None too for somebody who came without what the address needs: half an address helps nobody.
    """
    if template is None:
        return None
    values = {**(visitor.participant.arrival or {}), **({"code": code} if code else {})}
    return filled(template, values) if names_in(template) <= values.keys() else None


@router.get("/my-data")
def my_data(here: Here, visitor: AVisitor) -> Response:
    """Hand out everything that is stored about whoever asks."""
    body = own_data.as_json(here.db, visitor.participant)
    disposition = f'attachment; filename="my-data-{visitor.name}.json"'
    return Response(
        body, media_type="application/json", headers={"Content-Disposition": disposition}
    )
