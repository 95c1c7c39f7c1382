"""Calibration: the pixels' size by a card, the viewing distance by the blind spot."""

from __future__ import annotations

import secrets
from typing import Final

from fastapi import APIRouter
from fastapi.responses import HTMLResponse, Response
from pydantic import ValidationError

from study.data import before
from study.design import viewing
from study.design.calibration import (
    Calibration,
    CalibrationError,
    CalibrationReport,
    calibrated,
    calibration_facts,
)
from study.site.access import AVisitor, Visitor, VisitorsForm, step_of, to_current
from study.site.forms import first
from study.site.place import Here
from study.site.way import on_the_way

router = APIRouter(default_response_class=HTMLResponse)
STEP: Final = "calibration"
_IMPOSSIBLE: Final = {
    "scale": "calibration.scale_impossible",
    "distance": "calibration.distance_impossible",
}


@router.get("/calibration")
def show(here: Here, visitor: AVisitor) -> Response:
    """Measure the screen and the distance."""
    step_of(here, visitor, STEP)
    return _page(here, visitor)


def _page(here: Here, visitor: Visitor, *, fault: str = "") -> Response:
    wanted = visitor.study.definition.calibration or Calibration()
    return here.page(
        "participant/calibration.html",
        status=422 if fault else 200,
        **on_the_way(here, visitor, STEP),
        wanted=wanted,
        card_mm=(viewing.CARD_WIDTH_MM, viewing.CARD_HEIGHT_MM),
        blind_spot_deg=viewing.BLIND_SPOT_DEG,
        eye_mm=viewing.LEFT_EYE_MM,
        fault=fault,
        key=secrets.token_hex(16),
    )


@router.post("/calibration")
def store(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """Store what was measured, or why it was not; measures that cannot be are asked for again."""
    step = step_of(here, visitor)
    if step.name != STEP:
        return to_current(here, visitor)
    try:
        report = CalibrationReport.model_validate_json(first(fields, "report"))
        found = calibrated(report)
    except ValidationError:
        return _page(here, visitor, fault="calibration.unreadable")
    except CalibrationError as error:
        return _page(here, visitor, fault=_IMPOSSIBLE[error.what])
    before.record(
        here.db,
        visitor.participant,
        STEP,
        key=first(fields, "key") or STEP,
        report=report.model_dump(mode="json"),
        facts=calibration_facts(report, found),
    )
    return to_current(here, visitor)
