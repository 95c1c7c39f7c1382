"""Eyesight: its own consent, Landolt rings, colour-vision plates. Recorded, and never a gate."""

from __future__ import annotations

import secrets
from collections.abc import Mapping
from functools import partial
from typing import Any, Final

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, Response
from pydantic import ValidationError
from starlette.exceptions import HTTPException

from study.data import before
from study.data.before import EYESIGHT_AGREED
from study.data.errands import Errand
from study.design.definition import StudyDefinition
from study.design.eyesight import LEAST_GAP_PX, NEEDED, Eyesight, EyesightReport, eyesight_facts
from study.design.plates import Plate, plate_svg, plates
from study.site.access import AVisitor, Visitor, VisitorsForm, step_of, to_current
from study.site.before_clips import is_at, keeping, once_more
from study.site.forms import first
from study.site.place import Here, Place
from study.site.way import Sent, at_step, go_on, on_the_way, sent_form

router = APIRouter(default_response_class=HTMLResponse)
STEP: Final = "eyesight"


@router.get("/eyesight")
async def show(request: Request) -> Response:
    """Ask whether eyesight may be tested, then test it."""
    at = await at_step(request, STEP)
    visitor = at.visitor
    agreed, measured = await at.here.writer.look(partial(_state, at.who, visitor.study.definition))
    if not agreed:
        return await run_in_threadpool(_page, at.here, visitor)
    distance_cm = _whole(measured.get("view_dist_cm"))
    return at.page(
        STEP,
        own={"key": secrets.token_hex(16)},
        asked=(distance_cm,),
        fixed=partial(_content, visitor, distance_cm, ""),
    )


def _state(who: Any, definition: StudyDefinition) -> Errand[tuple[bool, dict[str, Any]]]:
    """Return whether eyesight may be tested, and what the calibration has found."""
    agreed = yield from _agreeing(who, definition)
    return agreed, (yield from before.finding_facts(who.id, "calibration"))


def _agreeing(who: Any, definition: StudyDefinition) -> Errand[bool]:
    """Say whether eyesight may be tested: agreed to on this page, or with the study's consent."""
    if definition.consent.health is not None:
        return True  # who did not agree there never comes here
    return (yield from before.counting(who.id, EYESIGHT_AGREED)) > 0


def _whole(distance_cm: float | None) -> int | None:
    return None if distance_cm is None else round(distance_cm)


def _content(
    visitor: Visitor, distance_cm: int | None, fault: str, frame: Mapping[str, Any]
) -> dict[str, Any]:
    return {
        "named": lambda number: frame["text"](f"eyesight.direction.{number}"),
        "wanted": _wanted(visitor.study.definition),
        "plate_count": len(_plates(visitor.participant, visitor.study.definition)),
        "least_gap_px": LEAST_GAP_PX,
        "needed": NEEDED,
        "distance_cm": distance_cm,
        "fault": fault,
    }


def _page(here: Place, visitor: Visitor, *, fault: str = "") -> Response:
    frame = on_the_way(here, visitor, STEP)
    if not _has_agreed(here, visitor):
        return here.page(
            "participant/eyesight_consent.html", status=422 if fault else 200, **frame, fault=fault
        )
    calibration = before.facts_of(here.db, visitor.participant, "calibration")
    return here.page(
        "participant/eyesight.html",
        status=422 if fault else 200,
        **{**frame, **_content(visitor, _whole(calibration.get("view_dist_cm")), fault, frame)},
        key=secrets.token_hex(16),
    )


def _wanted(definition: StudyDefinition) -> Eyesight:
    return definition.eyesight or Eyesight()


def _has_agreed(here: Place, visitor: Visitor) -> bool:
    return here.db.look(lambda: _agreeing(visitor.participant, visitor.study.definition))


def _plates(who: Any, definition: StudyDefinition) -> tuple[Plate, ...]:
    return plates(who.seed) if _wanted(definition).plates else ()


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
    mine = _plates(visitor.participant, visitor.study.definition)
    if not 1 <= number <= len(mine) or not _has_agreed(here, visitor):
        raise HTTPException(404)
    # Kept, so that a plate loaded ahead is there at once; its address names the participant.
    kept = {"Cache-Control": "private, max-age=600"}
    return Response(plate_svg(mine[number - 1]), media_type="image/svg+xml", headers=kept)


@router.post("/eyesight")
async def store(request: Request) -> Response:
    """Store what was told of the rings and read off the plates."""
    sent = await sent_form(request)
    try:
        report = EyesightReport.model_validate_json(first(sent.fields, "report"))
    except ValidationError:
        return await once_more(request, sent, STEP, _unreadable)
    return await go_on(request, sent, partial(_store, sent, report))


def _unreadable(here: Place, visitor: Visitor) -> Response:
    if not _has_agreed(here, visitor):
        return to_current(here, visitor)
    return _page(here, visitor, fault="eyesight.unreadable")


def _store(
    sent: Sent, report: EyesightReport, who: Any, definition: StudyDefinition
) -> Errand[None]:
    if not (yield from is_at(who, definition, STEP)):
        return
    agreed, calibration = yield from _state(who, definition)
    if agreed:
        facts = eyesight_facts(report, _plates(who, definition), calibration=calibration)
        kept = report.model_dump(mode="json")
        yield from keeping(sent, who, definition, STEP, report=kept, facts=facts)
