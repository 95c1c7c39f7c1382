"""Eyesight: its own consent, Landolt rings, colour-vision plates. Recorded, and never a gate."""

from __future__ import annotations

import secrets
from typing import Final

from fastapi import APIRouter
from fastapi.responses import HTMLResponse, Response
from pydantic import ValidationError
from starlette.exceptions import HTTPException

from study.data import before
from study.data.before import EYESIGHT_AGREED
from study.design.eyesight import LEAST_GAP_PX, NEEDED, Eyesight, EyesightReport, eyesight_facts
from study.design.plates import Plate, plate_svg, plates
from study.site.access import AVisitor, Visitor, VisitorsForm, step_of, to_current
from study.site.forms import first
from study.site.place import Here
from study.site.way import on_the_way

router = APIRouter(default_response_class=HTMLResponse)
STEP: Final = "eyesight"


@router.get("/eyesight")
def show(here: Here, visitor: AVisitor) -> Response:
    """Ask whether eyesight may be tested, then test it."""
    step_of(here, visitor, STEP)
    return _page(here, visitor)


def _page(here: Here, visitor: Visitor, *, fault: str = "") -> Response:
    frame = on_the_way(here, visitor, STEP)
    if not _has_agreed(here, visitor):
        return here.page(
            "participant/eyesight_consent.html", status=422 if fault else 200, **frame, fault=fault
        )
    calibration = before.facts_of(here.db, visitor.participant, "calibration")
    return here.page(
        "participant/eyesight.html",
        status=422 if fault else 200,
        **frame,
        named=lambda number: frame["text"](f"eyesight.direction.{number}"),
        wanted=_wanted(visitor),
        plate_count=len(_plates(visitor)),
        least_gap_px=LEAST_GAP_PX,
        needed=NEEDED,
        distance_cm=calibration.get("view_dist_cm"),
        fault=fault,
        key=secrets.token_hex(16),
    )


def _wanted(visitor: Visitor) -> Eyesight:
    return visitor.study.definition.eyesight or Eyesight()


def _has_agreed(here: Here, visitor: Visitor) -> bool:
    """Say whether eyesight may be tested: agreed to on this page, or with the study's consent."""
    if visitor.study.definition.consent.health is not None:
        return True  # who did not agree there never comes here
    return before.times(here.db, visitor.participant, EYESIGHT_AGREED) > 0


def _plates(visitor: Visitor) -> tuple[Plate, ...]:
    return plates(visitor.participant.seed) if _wanted(visitor).plates else ()


@router.post("/eyesight/consent")
def consent(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """Note the agreement, or leave the tests out."""
    step = step_of(here, visitor)
    if step.name != STEP or _has_agreed(here, visitor):
        return to_current(here, visitor)
    if first(fields, "choice") == "no":
        before.record(
            here.db,
            visitor.participant,
            STEP,
            key=STEP,
            report={"is_refused": True},
            facts={"eyesight_test": "refused"},
        )
        return to_current(here, visitor)
    if first(fields, "agree") != "yes":
        return _page(here, visitor, fault="eyesight.tick")
    before.note(here.db, visitor.participant, EYESIGHT_AGREED, key=EYESIGHT_AGREED, payload={})
    return to_current(here, visitor)


@router.get("/eyesight/plates/{number}.svg")
def plate(here: Here, visitor: AVisitor, number: int) -> Response:
    """Draw one of the participant's plates, counted from 1; its address says nothing of it."""
    step_of(here, visitor, STEP)
    mine = _plates(visitor)
    if not 1 <= number <= len(mine) or not _has_agreed(here, visitor):
        raise HTTPException(404)
    # Kept, so that a plate loaded ahead is there at once; its address names the participant.
    kept = {"Cache-Control": "private, max-age=600"}
    return Response(plate_svg(mine[number - 1]), media_type="image/svg+xml", headers=kept)


@router.post("/eyesight")
def store(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """Store what was told of the rings and read off the plates."""
    step = step_of(here, visitor)
    if step.name != STEP or not _has_agreed(here, visitor):
        return to_current(here, visitor)
    try:
        report = EyesightReport.model_validate_json(first(fields, "report"))
    except ValidationError:
        return _page(here, visitor, fault="eyesight.unreadable")
    calibration = before.facts_of(here.db, visitor.participant, "calibration")
    found = eyesight_facts(report, _plates(visitor), calibration=calibration)
    before.record(
        here.db,
        visitor.participant,
        STEP,
        key=first(fields, "key") or STEP,
        report=report.model_dump(mode="json"),
        facts=found,
    )
    return to_current(here, visitor)
