"""Calibration: the pixels' size by a card, the viewing distance by the blind spot."""

from __future__ import annotations

import secrets
from functools import partial
from typing import Any, Final

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, Response
from pydantic import ValidationError

from study.data.errands import Errand
from study.design import viewing
from study.design.calibration import (
    Calibration,
    CalibrationError,
    CalibrationReport,
    calibrated,
    calibration_facts,
)
from study.design.definition import StudyDefinition
from study.site.access import Visitor
from study.site.before_clips import Facts, is_at, keeping, once_more
from study.site.forms import first
from study.site.place import Place
from study.site.way import Sent, at_step, go_on, on_the_way, sent_form

router = APIRouter(default_response_class=HTMLResponse)
STEP: Final = "calibration"
_IMPOSSIBLE: Final = {
    "scale": "calibration.scale_impossible",
    "distance": "calibration.distance_impossible",
}


@router.get("/calibration")
async def show(request: Request) -> Response:
    """Measure the screen and the distance."""
    at = await at_step(request, STEP)
    content = partial(_content, at.visitor.study.definition)
    return at.page(STEP, own={"key": secrets.token_hex(16)}, fixed=lambda _: content())


def _content(definition: StudyDefinition, *, fault: str = "") -> dict[str, Any]:
    return {
        "wanted": definition.calibration or Calibration(),
        "card_mm": (viewing.CARD_WIDTH_MM, viewing.CARD_HEIGHT_MM),
        "blind_spot_deg": viewing.BLIND_SPOT_DEG,
        "eye_mm": viewing.LEFT_EYE_MM,
        "fault": fault,
    }


def _with_fault(fault: str, here: Place, visitor: Visitor) -> Response:
    return here.page(
        "participant/calibration.html",
        status=422,
        **on_the_way(here, visitor, STEP),
        **_content(visitor.study.definition, fault=fault),
        key=secrets.token_hex(16),
    )


@router.post("/calibration")
async def store(request: Request) -> Response:
    """Store what was measured, or why it was not; measures that cannot be are asked for again."""
    sent = await sent_form(request)
    try:
        report = CalibrationReport.model_validate_json(first(sent.fields, "report"))
        facts = calibration_facts(report, calibrated(report))
    except ValidationError:
        return await once_more(request, sent, STEP, partial(_with_fault, "calibration.unreadable"))
    except CalibrationError as error:
        page = partial(_with_fault, _IMPOSSIBLE[error.what])
        return await once_more(request, sent, STEP, page)
    return await go_on(request, sent, partial(_store, sent, report, facts))


def _store(
    sent: Sent, report: CalibrationReport, facts: Facts, who: Any, definition: StudyDefinition
) -> Errand[None]:
    if (yield from is_at(who, definition, STEP)):
        kept = report.model_dump(mode="json")
        yield from keeping(sent, who, definition, STEP, report=kept, facts=facts)
