"""The last pages: one for each way in which taking part ends, with its code and the way back."""

from __future__ import annotations

from fastapi import APIRouter
from fastapi.responses import HTMLResponse, Response

from study.data import completion, own_data
from study.design.completion import GENERATED, filled, names_in
from study.design.texts import Paragraph
from study.site.access import AVisitor, Visitor, step_of
from study.site.frame import shared
from study.site.place import Here

router = APIRouter()


@router.get("/thanks", response_class=HTMLResponse)
def thanks(here: Here, visitor: AVisitor) -> Response:
    """Thank, with the code that proves that every answer is stored."""
    step_of(here, visitor, "thanks")
    return _last_page(here, visitor)


@router.get("/screened-out", response_class=HTMLResponse)
def screened_out(here: Here, visitor: AVisitor) -> Response:
    """Say that taking part is not possible here, with the code for that."""
    step_of(here, visitor, "screened_out")
    return _last_page(here, visitor)


def _last_page(here: Here, visitor: Visitor) -> Response:
    outcome = visitor.participant.outcome or completion.COMPLETED
    frame = shared(visitor.study, visitor, "thanks")
    definition, text = visitor.study.definition, frame["text"]
    ending = definition.endings.ending(outcome)
    title, paragraphs = ending.title, ending.paragraphs
    if outcome == completion.COMPLETED:
        title = title or definition.thanks.title
        paragraphs = paragraphs or definition.thanks.paragraphs
    else:
        title = title or text(f"ending.{outcome}.title")
        paragraphs = paragraphs or (Paragraph(text=text(f"ending.{outcome}.text")),)
    code = completion.code(here.db, visitor.participant)
    return here.page(
        "participant/thanks.html",
        **frame,
        outcome=outcome,
        title=title,
        paragraphs=paragraphs,
        code_is=text(
            "thanks.code" if outcome == completion.COMPLETED else f"ending.{outcome}.code"
        ),
        completion_code=code,
        is_own_code=definition.endings.code_of(outcome) == GENERATED,
        redirect=way_back(visitor, ending.redirect, code),
        redirect_label=ending.redirect_label or text("thanks.way_back"),
    )


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
