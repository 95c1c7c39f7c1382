"""The check of screen, browser and connection: a page that measures, and the study's gate.

The browser measures and asks; what it reports is judged here again, and stored either way.
"""

from __future__ import annotations

import secrets
from typing import Final

from fastapi import APIRouter
from fastapi.responses import FileResponse, HTMLResponse, Response
from pydantic import ValidationError
from starlette.exceptions import HTTPException

from study.data import before, completion
from study.data.before import DEVICE_FAILED
from study.design import patches
from study.design.device_check import DeviceCheck, DeviceReport, findings
from study.design.device_facts import device_facts
from study.site.access import AVisitor, Visitor, VisitorsForm, step_of, to_current
from study.site.forms import first
from study.site.media import clip_url
from study.site.place import Here
from study.site.way import on_the_way

router = APIRouter()
STEP: Final = "device_check"
MOST_CLIPS: Final = 3  # of the study's own, to measure the connection


def _check(visitor: Visitor) -> DeviceCheck:
    return visitor.study.definition.device_check or DeviceCheck()


@router.get("/device-check", response_class=HTMLResponse)
def show(here: Here, visitor: AVisitor) -> Response:
    """Check the screen item by item."""
    step_of(here, visitor, STEP)
    return _page(here, visitor)


def _page(
    here: Here,
    visitor: Visitor,
    *,
    report: DeviceReport | None = None,
    stopping: tuple[str, ...] = (),
    fault: str = "",
) -> Response:
    definition, seed = visitor.study.definition, visitor.participant.seed
    frame = on_the_way(here, visitor, STEP)

    def named(item: str, part: str, **values: object) -> object:
        return frame["text"](f"device_check.{item}.{part}", **values)

    check = _check(visitor)
    tried = before.times(here.db, visitor.participant, DEVICE_FAILED)
    return here.page(
        "participant/device_check.html",
        status=422 if stopping or fault else 200,
        **frame,
        named=named,
        check=check,
        sizes=sorted(definition.sizes, key=lambda size: size.width * size.height),
        squares=[len(patches.strip_levels(seed, strip)) for strip in ("dark", "light")],
        strips={strip: patches.strip_levels(seed, strip) for strip in ("dark", "light")},
        self_test=f"/self-test/{patches.self_test_name()}" if _has_self_test(here) else "",
        patches=[list(patch) for patch in patches.PATCHES],
        patch_px=patches.PATCH_PX,
        columns=patches.COLUMNS,
        clips=_clip_urls(here, visitor),
        given=report,
        stopping=stopping,
        fault=fault,
        may_leave=tried >= check.tries,
        key=secrets.token_hex(16),
    )


def _has_self_test(here: Here) -> bool:
    return (here.settings.media_folder / patches.self_test_name()).is_file()


def _clip_urls(here: Here, visitor: Visitor) -> list[str]:
    """Return some of the study's clips that are rendered: the connection is measured by them."""
    wanted = visitor.study.definition.wanted_specs()
    records = (here.clips.record(one.spec.clip_id) for one in wanted)
    urls = dict.fromkeys(clip_url(record) for record in records if record is not None)
    return list(urls)[:MOST_CLIPS]


@router.get("/self-test/{name}")
def self_test(here: Here, name: str) -> Response:
    """Send the clip of known colours."""
    if name != patches.self_test_name() or not _has_self_test(here):
        raise HTTPException(404)
    return FileResponse(here.settings.media_folder / name, media_type="video/mp4")


@router.post("/device-check", response_class=HTMLResponse)
def store(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """Judge and store a report; where something required is missing, say what to do."""
    step = step_of(here, visitor)
    if step.name != STEP:
        return to_current(here, visitor)
    try:
        report = DeviceReport.model_validate_json(first(fields, "report"))
    except ValidationError:
        return _page(here, visitor, fault="device_check.unreadable")
    found = findings(
        _check(visitor),
        report,
        sizes=visitor.study.definition.sizes,
        seed=visitor.participant.seed,
    )
    key, kept = first(fields, "key") or STEP, report.model_dump(mode="json")
    stopping = tuple(finding.item for finding in found if finding.stops)
    if stopping:
        payload = {"report": kept, "stopping": list(stopping)}
        before.note(here.db, visitor.participant, DEVICE_FAILED, key=key, payload=payload)
        return _page(here, visitor, report=report, stopping=stopping)
    facts = device_facts(report, found, seed=visitor.participant.seed)
    before.record(here.db, visitor.participant, STEP, key=key, report=kept, facts=facts)
    return to_current(here, visitor)


@router.post("/device-check/leave", response_class=HTMLResponse)
def leave(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """End for somebody whose screen cannot be helped, once they have tried."""
    del fields  # the form carries only its proof
    step = step_of(here, visitor)
    tried = before.times(here.db, visitor.participant, DEVICE_FAILED)
    if step.name == STEP and tried >= _check(visitor).tries:
        completion.screen_out(here.db, visitor.participant, reason=STEP)
    return to_current(here, visitor)
