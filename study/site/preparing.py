"""Waiting for the clips, and the choice of the size that this screen can show."""

from __future__ import annotations

import math
from functools import partial
from typing import Annotated, Any, Final

from fastapi import APIRouter, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.exceptions import RequestValidationError
from fastapi.responses import HTMLResponse, JSONResponse, Response

from study.data import arms, jobs, participants, progress, steps, trials
from study.data.errands import Errand
from study.data.participants import SEEN_AGAIN, Participant
from study.data.readiness import Readiness, Screen, surveying
from study.data.refusals import NotReachedError
from study.data.senders import seeing
from study.data.studies import Study
from study.site.access import redirect, step_url
from study.site.asker import Asker, by_cookie, found, locked, study_of
from study.site.forms import first
from study.site.language import language_of
from study.site.media import to_preload
from study.site.place import Place, place_in
from study.site.way import Sent, at_step, sent_form
from study.texts import catalogue

router = APIRouter()
STUCK: Final = "CLIPS-STUCK"
MOST_PX: Final = 100_000
Pixels = Annotated[int, Query(ge=1, le=MOST_PX)]


@router.get("/preparing", response_class=HTMLResponse)
async def preparing(request: Request) -> Response:
    """Show how far the clips are; a script asks ``/preparing/state`` and goes on by itself."""
    at = await at_step(request, "preparing")
    definition = at.visitor.study.definition
    return at.page(
        "preparing",
        own={"resume_url": at.visitor.resume_url},
        fixed=lambda _: {
            "smallest": min(definition.sizes, key=lambda size: size.width),
            "has_practice": bool(definition.practice),
        },
    )


@router.get("/preparing/state")
async def state(request: Request, screen_width_px: Pixels, screen_height_px: Pixels) -> Response:
    """Say whether the clips for this screen are ready, and if so which to load.

    The arm is leased here, because its clips are what the browser loads.
    """
    here, screen = place_in(request), (screen_width_px, screen_height_px)
    asker = by_cookie(request, here)
    who, ready = await here.writer.look(partial(_survey, request, here, asker, screen))
    if here.db.now() - who.last_seen_at >= SEEN_AGAIN:  # who waits here is at work
        await here.writer.write(partial(_see, request, here, asker))
    study, clips = study_of(here, who), None
    if ready.is_ready:
        leased = await _arm(here, study, who, screen)
        clips = None if leased is None else await _clips(here, study, leased)
    return JSONResponse(
        {
            "fits": ready.fits,
            "is_ready": clips is not None,
            "progress": round(ready.progress, 4),
            "wait": ""
            if clips is not None
            else await run_in_threadpool(_wait, here, study, who, ready),
            "clips": clips or [],
        }
    )


async def asked_state(request: Request) -> Response:
    """Answer the same, reading the query as the framework would."""
    sides = (request.query_params.get(f"screen_{side}_px", "") for side in ("width", "height"))
    read = [int(side) if side.isascii() and side.isdecimal() else 0 for side in sides]
    if not all(1 <= side <= MOST_PX for side in read):
        raise RequestValidationError([])
    return await state(request, *read)


def _survey(
    request: Request, here: Place, asker: Asker, screen: Screen
) -> Errand[tuple[Any, Readiness]]:
    who = yield from found(request, here, asker)
    return who, (yield from surveying(study_of(here, who).definition, screen))


def _see(request: Request, here: Place, asker: Asker) -> Errand[None]:
    who = yield from locked(request, asker)
    yield from seeing(who, here.db.now())


async def _arm(here: Place, study: Study, who: Any, screen: Screen | None) -> Participant | None:
    """Return somebody with the arm that they keep or are given now; None while none is ready."""
    mine = participants.record_of(who)
    if arms.keeps_arm(who, study.definition, screen):
        return mine
    lease = partial(arms.leasing, here.db, mine, study.definition, screen=screen)
    return await here.writer.write(lease, is_gated=True)


async def _clips(here: Place, study: Study, leased: Participant) -> list[dict[str, Any]] | None:
    """Return what to load, each clip once and in order, or None while a file is missing."""
    ids = dict.fromkeys(trials.clips_to_come(leased, study.definition))
    records = {clip_id: here.clips.record(clip_id) for clip_id in ids}
    missing = [clip_id for clip_id, record in records.items() if record is None]
    if missing:  # rendered once, and lost since: have them made again
        await run_in_threadpool(jobs.requeue, here.db, missing)
        return None
    return [to_preload(record) for record in records.values() if record is not None]


def _wait(here: Place, study: Study, who: Any, ready: Readiness) -> str:
    """Say in calm words how long the nearest complete set of clips takes."""
    words = catalogue(language_of(study, (who.language,)))
    if ready.is_stuck:
        return words.text("preparing.stuck", code=STUCK)
    left_s = jobs.summary(here.db, ready.clips).left_s
    if left_s is None:
        return words.text("preparing.time_unknown")
    if left_s < 60:
        return words.text("preparing.seconds_left")
    return words.text("preparing.minutes_left", count=math.ceil(left_s / 60))


@router.post("/preparing")
async def begin(request: Request) -> Response:
    """Begin the trials with the clips that were loaded."""
    sent = await sent_form(request)
    here, facts = sent.here, {name: _number(first(sent.fields, name)) for name in _FACTS}
    sides = (int(facts["screen_width_px"]), int(facts["screen_height_px"]))
    screen = sides if all(sides) else None
    act = partial(_begin, request, sent, facts, screen)
    step, who = await here.writer.write(act)
    if step is None:
        if await _arm(here, study_of(here, who), who, screen) is None:
            return redirect("/preparing")
        step, _ = await here.writer.write(act)
    return redirect("/preparing" if step is None else step_url(step))


def _begin(
    request: Request, sent: Sent, facts: dict[str, float], screen: Screen | None
) -> Errand[tuple[progress.Step | None, Any]]:
    """Begin, and note the screen; returns where they are then, or None without a fitting arm."""
    here = sent.here
    who = yield from locked(request, sent.asker)
    definition = study_of(here, who).definition
    if not arms.keeps_arm(who, definition, screen):
        if (yield from progress.stepping(who, definition)).name != "preparing":
            raise NotReachedError("the clips come after the instructions")
        return None, who
    yield from steps.beginning(here.db, who, definition, facts, key="begin")
    yield from seeing(who, here.db.now(), device=_device(facts) if screen else None)
    return (yield from progress.stepping_on(who.id, definition)), who


def _device(facts: dict[str, float]) -> dict[str, float]:
    """Return the screen in CSS pixels, as sittings have it."""
    ratio = facts["pixel_ratio"] or 1.0
    return {
        "screen_width": round(int(facts["screen_width_px"]) / ratio),
        "screen_height": round(int(facts["screen_height_px"]) / ratio),
        "pixel_ratio": ratio,
    }


_FACTS = ("screen_width_px", "screen_height_px", "pixel_ratio")


def _number(text: str) -> float:
    """Read a number that a browser reports; 0 for anything else."""
    try:
        value = float(text)
    except ValueError:
        return 0.0
    return value if math.isfinite(value) and 0 < value <= 100_000 else 0.0
