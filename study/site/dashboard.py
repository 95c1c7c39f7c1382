"""The researcher's overview: how many people, is the data good, how far are the clips."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any, Final

from fastapi import APIRouter
from fastapi.responses import HTMLResponse, Response

from study.data import dashboard, jobs
from study.data.quality import quality
from study.data.studies import Study
from study.design.arms import Arm
from study.design.certificate import REASONS
from study.site.access import redirect
from study.site.place import Here
from study.site.signed_in import ResearcherHere, ResearchersForm, SignedIn

router = APIRouter(default_response_class=HTMLResponse)
STEP_WORDS: Final = {
    "consent": "reading the consent",
    "about": "about themselves",
    "device_check": "checking their screen",
    "calibration": "measuring their screen",
    "eyesight": "testing their eyesight",
    "instructions": "reading the instructions",
    "preparing": "waiting for clips",
    "practice": "practice clip",
    "trial": "rating clips",
    "thanks": "at the end",
    "screened_out": "screened out",
    "withdrawn": "withdrawn",
}
OUTCOME_WORDS: Final = {
    "completed": "completed",
    "screened_out": "screened out",
    "failed_checks": "failed checks",
}


def frame(study: Study, researcher: SignedIn, section: str, heading: str) -> dict[str, Any]:
    """Return what every page of the dashboard shows."""
    return {
        "study_title": study.title,
        "study": study,
        "researcher": researcher,
        "section": section,
        "heading": heading,
        "ago": ago,
        "duration": duration,
        "step_words": STEP_WORDS,
        "outcome_words": OUTCOME_WORDS,
    }


def ago(moment: datetime, now: datetime) -> str:
    """Say how long ago something was: "just now", "4 min ago"."""
    seconds = (now - moment).total_seconds()
    return "just now" if seconds < 45 else f"{duration(seconds)} ago"


def duration(seconds: float | None) -> str:
    """Write a duration for a glance: "50 s", "4 min", "3 h", "2 days"."""
    if seconds is None:
        return "not known yet"
    for size, unit in ((86400, "days"), (3600, "h"), (60, "min")):
        if seconds >= 2 * size or (unit == "min" and seconds >= 60):
            return f"{round(seconds / size)} {unit}"
    return f"{round(seconds)} s"


@router.get("/researcher")
def overview(here: Here, researcher: ResearcherHere) -> Response:
    """Show the study at a glance."""
    study = here.study()
    found = dashboard.summary(here.db, study)
    good = quality(here.db, study)
    return here.page(
        "researcher/overview.html",
        **frame(study, researcher, "", "Overview"),
        arm_groups=_by_size_and_direction(found.arms),
        found=found,
        reason_words=REASONS,
        kinds=[
            ("People", found.real, good.real, False),
            *(
                [("Simulated", found.simulated, good.simulated, True)]
                if found.simulated.arrived
                else []
            ),
        ],
        jobs=_interesting(jobs.all_jobs(here.db, wanted_ids(study))),
        clips=_clips_by_id(study),
    )


def _by_size_and_direction(filled: Mapping[Arm, int]) -> dict[tuple[str, str], list[int]]:
    """Return the counts of the arms that differ in their block alone, together."""
    groups: dict[tuple[str, str], list[int]] = {}
    for arm, count in filled.items():
        groups.setdefault((arm.size, arm.orbit_direction), []).append(count)
    return groups


def wanted_ids(study: Study) -> set[str]:
    """Return the ids of every clip that the study wants in any size and direction."""
    return {wanted.spec.clip_id for wanted in study.definition.wanted_specs()}


def _interesting(found: list[jobs.Job]) -> list[jobs.Job]:
    """Return what needs a look: failures, what is being rendered, and what comes next."""
    order = {jobs.FAILED: 0, jobs.CLAIMED: 1, jobs.QUEUED: 2}
    listed = sorted((j for j in found if j.state in order), key=lambda j: order[j.state])
    return listed[:8]


def _clips_by_id(study: Study) -> Mapping[str, str]:
    return {wanted.spec.clip_id: wanted.clip.id for wanted in study.definition.wanted_specs()}


@router.get("/researcher/people")
def people(here: Here, researcher: ResearcherHere) -> Response:
    """Show who is where."""
    study = here.study()
    return here.page(
        "researcher/people.html",
        **frame(study, researcher, "/people", "People"),
        found=dashboard.summary(here.db, study),
    )


@router.post("/researcher/jobs/{clip_id}/again")
def again(here: Here, fields: ResearchersForm, clip_id: str) -> Response:
    """Queue a clip again, whatever became of it."""
    del fields  # the form carries only its proof
    jobs.requeue(here.db, [clip_id])
    return redirect("/researcher")
