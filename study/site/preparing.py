"""Waiting for the clips, and the choice of the size that this screen can show."""

from __future__ import annotations

import math
from typing import Annotated, Any, Final

from fastapi import APIRouter, Query
from fastapi.responses import HTMLResponse, Response

from study.data import arms, jobs, participants, steps, trials
from study.data.participants import Participant
from study.data.readiness import Readiness, readiness
from study.site.access import AVisitor, Visitor, VisitorsForm, redirect, step_of, to_current
from study.site.forms import first
from study.site.language import language_of
from study.site.media import to_preload
from study.site.place import Here
from study.site.way import on_the_way
from study.texts import catalogue

router = APIRouter()
STUCK: Final = "CLIPS-STUCK"
Pixels = Annotated[int, Query(ge=1, le=100_000)]


@router.get("/preparing", response_class=HTMLResponse)
def preparing(here: Here, visitor: AVisitor) -> Response:
    """Show how far the clips are; a script asks ``/preparing/state`` and goes on by itself."""
    step_of(here, visitor, "preparing")
    return here.page(
        "participant/preparing.html",
        **on_the_way(here, visitor, "preparing"),
        smallest=min(visitor.study.definition.sizes, key=lambda size: size.width),
        has_practice=bool(visitor.study.definition.practice),
    )


@router.get("/preparing/state")
def state(
    here: Here, visitor: AVisitor, screen_width_px: Pixels, screen_height_px: Pixels
) -> dict[str, Any]:
    """Say whether the clips for this screen are ready, and if so which to load.

    The arm is leased here, because its clips are what the browser loads.
    """
    participants.seen(here.db, visitor.participant)  # who waits here is at work
    screen = (screen_width_px, screen_height_px)
    ready = readiness(here.db, visitor.participant, screen=screen)
    news = {
        "fits": ready.fits,
        "is_ready": False,
        "progress": round(ready.progress, 4),
        "wait": "",
        "clips": [],
    }
    leased = arms.assign(here.db, visitor.participant, screen=screen) if ready.is_ready else None
    clips = None if leased is None else _clips(here, leased)
    if clips is None:
        return {**news, "wait": _wait(here, visitor, ready)}
    return {**news, "is_ready": True, "clips": clips}


def _clips(here: Here, participant: Participant) -> list[dict[str, Any]] | None:
    """Return what to load, each clip once and in order, or None while a file is missing."""
    ids = dict.fromkeys(trials.clip_ids(here.db, participant))
    records = {clip_id: here.clips.record(clip_id) for clip_id in ids}
    missing = [clip_id for clip_id, record in records.items() if record is None]
    if missing:  # rendered once, and lost since: have them made again
        jobs.requeue(here.db, missing)
        return None
    return [to_preload(record) for record in records.values() if record is not None]


def _wait(here: Here, visitor: Visitor, ready: Readiness) -> str:
    """Say in calm words how long the nearest complete set of clips takes."""
    words = catalogue(language_of(visitor.study, (visitor.participant.language,)))
    if ready.is_stuck:
        return words.text("preparing.stuck", code=STUCK)
    left_s = jobs.summary(here.db, ready.clips).left_s
    if left_s is None:
        return words.text("preparing.time_unknown")
    if left_s < 60:
        return words.text("preparing.seconds_left")
    return words.text("preparing.minutes_left", count=math.ceil(left_s / 60))


@router.post("/preparing")
def begin(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """Begin the trials with the clips that were loaded."""
    facts = {name: _number(first(fields, name)) for name in _FACTS}
    screen = (int(facts["screen_width_px"]), int(facts["screen_height_px"]))
    ratio = facts["pixel_ratio"] or 1.0
    device = {
        "screen_width": round(screen[0] / ratio),
        "screen_height": round(screen[1] / ratio),
        "pixel_ratio": ratio,
    }
    with here.db.writing():  # one wait for the disk, and all of it or nothing
        size = screen if all(screen) else None
        if arms.assign(here.db, visitor.participant, screen=size) is None:
            return redirect("/preparing")
        steps.begin(here.db, visitor.participant, key="begin", payload=facts)
        participants.seen(here.db, visitor.participant, device=device if size else None)
    return to_current(here, visitor)


_FACTS = ("screen_width_px", "screen_height_px", "pixel_ratio")


def _number(text: str) -> float:
    """Read a number that a browser reports; 0 for anything else."""
    try:
        value = float(text)
    except ValueError:
        return 0.0
    return value if math.isfinite(value) and 0 < value <= 100_000 else 0.0
