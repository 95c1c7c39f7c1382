"""The check of screen, browser and connection: a page that measures, and the study's gate.

The browser measures and asks; what it reports is judged here again, and stored either way.
"""

from __future__ import annotations

import secrets
from functools import partial

from fastapi import APIRouter, Request
from fastapi.responses import FileResponse, HTMLResponse, Response
from pydantic import ValidationError
from starlette.exceptions import HTTPException

from study.data import before, completion, progress
from study.data.before import DEVICE_FAILED
from study.data.errands import Errand
from study.design import patches
from study.design.device_check import DeviceReport, findings
from study.design.device_facts import device_facts
from study.site.access import (
    AVisitor,
    VisitorsForm,
    redirect,
    step_of,
    step_url,
    to_current,
)
from study.site.asker import locked, study_of
from study.site.before_clips import is_at, keeping, once_more
from study.site.device_page import (
    STEP,
    STRIPS,
    check_of,
    clip_urls_of,
    content_of,
    has_self_test,
    page_with_faults,
    self_test_url,
)
from study.site.forms import first
from study.site.mould import place
from study.site.place import Here
from study.site.way import Sent, at_step, sent_form

router = APIRouter()


@router.get("/device-check", response_class=HTMLResponse)
async def show(request: Request) -> Response:
    """Check the screen item by item."""
    at = await at_step(request, STEP)
    visitor, definition = at.visitor, at.visitor.study.definition
    tried = await at.here.writer.look(partial(before.counting, at.who.id, DEVICE_FAILED))
    strips = {strip: patches.strip_levels(at.who.seed, strip) for strip in STRIPS}
    clips = clip_urls_of(at.here, visitor)
    # Everybody's levels are their own; how many there are shapes the page.
    squares = {f"{strip}_{n}": grey for strip in STRIPS for n, grey in enumerate(strips[strip])}
    places = {strip: [place(f"{strip}_{n}") for n in range(len(strips[strip]))] for strip in STRIPS}
    may_leave = tried >= check_of(definition).tries
    return at.page(
        STEP,
        own={"key": secrets.token_hex(16), **squares},
        asked=(*map(len, strips.values()), tuple(clips), self_test_url(at.here), may_leave),
        fixed=partial(
            content_of, at.here, definition, strips=places, clips=clips, may_leave=may_leave
        ),
    )


@router.get("/self-test/{name}")
def self_test(here: Here, name: str) -> Response:
    """Send the clip of known colours."""
    if name != patches.self_test_name() or not has_self_test(here):
        raise HTTPException(404)
    return FileResponse(here.settings.media_folder / name, media_type="video/mp4")


@router.post("/device-check", response_class=HTMLResponse)
async def store(request: Request) -> Response:
    """Judge and store a report; where something required is missing, say what to do."""
    sent = await sent_form(request)
    try:
        report = DeviceReport.model_validate_json(first(sent.fields, "report"))
    except ValidationError:
        return await once_more(request, sent, STEP, partial(page_with_faults, None, ()))
    judged = partial(_judge, request, sent, report)
    stopping, step = await sent.here.writer.write(judged)
    if not stopping:
        return redirect(step_url(step))
    return await once_more(request, sent, STEP, partial(page_with_faults, report, stopping))


def _judge(
    request: Request, sent: Sent, report: DeviceReport
) -> Errand[tuple[tuple[str, ...], progress.Step]]:
    """Store a report; returns what stops its sender, and where they are then."""
    who = yield from locked(request, sent.asker)
    definition = study_of(sent.here, who).definition
    stopping: tuple[str, ...] = ()
    if (yield from is_at(who, definition, STEP)):
        sizes = definition.sizes
        found = findings(check_of(definition), report, sizes=sizes, seed=who.seed)
        stopping = tuple(finding.item for finding in found if finding.stops)
        kept = report.model_dump(mode="json")
        if stopping:
            payload = {"report": kept, "stopping": list(stopping)}
            yield from before.jotting(
                who,
                DEVICE_FAILED,
                key=first(sent.fields, "key") or STEP,
                payload=payload,
                now=sent.here.db.now(),
            )
        else:
            facts = device_facts(report, found, seed=who.seed)
            yield from keeping(sent, who, definition, STEP, report=kept, facts=facts)
    return stopping, (yield from progress.stepping_on(who.id, definition))


@router.post("/device-check/leave", response_class=HTMLResponse)
def leave(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """End for somebody whose screen cannot be helped, once they have tried."""
    del fields  # the form carries only its proof
    step = step_of(here, visitor)
    tried = before.times(here.db, visitor.participant, DEVICE_FAILED)
    if step.name == STEP and tried >= check_of(visitor.study.definition).tries:
        completion.screen_out(here.db, visitor.participant, reason=STEP)
    return to_current(here, visitor)
