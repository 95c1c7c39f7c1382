"""Every clip of the study to look at, with all that is known of it."""

from __future__ import annotations

import statistics
from dataclasses import dataclass
from typing import Any

from fastapi import APIRouter, HTTPException
from fastapi.responses import HTMLResponse, Response

from renderer.clip import ClipSpec
from renderer.detail import EFFECTS
from renderer.manifest import ClipRecord
from study.data import jobs
from study.data.jobs import Job
from study.design.definition import WantedClip
from study.site.dashboard import frame
from study.site.media import clip_url
from study.site.place import Here
from study.site.signed_in import ResearcherHere

router = APIRouter(default_response_class=HTMLResponse)


@dataclass(frozen=True)
class Shown:
    """One clip of the gallery: wanted, and there or not."""

    wanted: WantedClip
    is_practice: bool
    job: Job | None
    record: ClipRecord | None

    @property
    def id(self) -> str:
        """The name of the clip's frames."""
        return self.wanted.spec.clip_id

    @property
    def url(self) -> str:
        """Where the video is."""
        return clip_url(self.record) if self.record else ""


@router.get("/researcher/clips")
def gallery(
    here: Here, researcher: ResearcherHere, size: str = "", direction: str = ""
) -> Response:
    """Show the clips of one size and one direction; the others are a link away."""
    study = here.study()
    definition = study.definition
    sizes = [str(one) for one in definition.sizes]
    directions = list(definition.orbit.directions)
    size = size if size in sizes else sizes[0]
    direction = direction if direction in directions else directions[0]
    return here.page(
        "researcher/clips.html",
        **frame(study, researcher, "/clips", "Clips"),
        clips=[
            shown
            for shown in _all_shown(here)
            if (str(shown.wanted.size), shown.wanted.orbit_direction) == (size, direction)
        ],
        sizes=sizes,
        directions=directions,
        size=size,
        direction=direction,
    )


def _all_shown(here: Here) -> list[Shown]:
    definition = here.study().definition
    found = {job.clip_id: job for job in jobs.all_jobs(here.db)}
    practice = {clip.id for clip in definition.practice}
    return [
        Shown(
            wanted,
            wanted.clip.id in practice,
            found.get(wanted.spec.clip_id),
            here.clips.record(wanted.spec.clip_id),
        )
        for wanted in definition.wanted_specs()
    ]


@router.get("/researcher/clips/{clip_id}")
def one(here: Here, researcher: ResearcherHere, clip_id: str) -> Response:
    """Show one clip with its specification, its manifest entry and its job."""
    shown = next((shown for shown in _all_shown(here) if shown.id == clip_id), None)
    if shown is None:
        raise HTTPException(404)
    study = here.study()
    name = shown.wanted.clip.id
    heading = name.capitalize() if shown.is_practice else f"Clip {name}"
    return here.page(
        "researcher/clip.html",
        **frame(study, researcher, "/clips", heading),
        shown=shown,
        levels=levels_of(shown.wanted.spec),
        facts=facts_of(shown.wanted.spec),
        measured=_measured(shown.record) if shown.record else [],
    )


def levels_of(spec: ClipSpec) -> list[tuple[str, str, str]]:
    """Return effect, level on the left and on the right; eyes that switch have theirs by size."""
    left, right = (
        detail.levels() if switching == "fixed" else dict.fromkeys(EFFECTS, "by size")
        for detail, switching in (
            (spec.left, spec.left_switching),
            (spec.right, spec.right_switching),
        )
    )
    return [(effect, left[effect], right[effect]) for effect in EFFECTS]


def facts_of(spec: ClipSpec) -> list[tuple[str, Any]]:
    """Return what else the frames depend on, by the spec's names."""
    facts = [
        (name, value)
        for name, value in spec.to_dict().items()
        if name not in ("left", "right", "lod_policy")
    ]
    limits = [
        f"{step.lod} up to {step.up_to_iris_px:g} px" if step.up_to_iris_px else step.lod
        for step in (spec.lod_policy.steps if spec.lod_policy else ())
    ]
    return [*facts, ("lod_policy", ", ".join(limits))] if limits else facts


def _measured(record: ClipRecord) -> list[tuple[str, str]]:
    """Return what the manifest says, in words for a glance."""
    diameters = [px for frame in record.iris_px for px in frame]
    return [
        ("file", record.file),
        ("size of the file", f"{record.file_bytes / 1e6:.2f} MB"),
        ("frames", f"{record.frame_count} at {record.fps} per second"),
        ("iris diameter", _range(diameters, "px", 1)),
        *(
            (f"visible pixels, {eye} eye", _range([row[i] for row in record.visible_px], "px", 0))
            for i, eye in enumerate(("left", "right"))
            if record.visible_px
        ),
        ("PSNR inside the eyes", ", ".join(f"{value:.1f} dB" for value in record.psnr_db)),
        ("SSIM inside the eyes", ", ".join(f"{value:.4f}" for value in record.ssim)),
        *_flip(record),
        *(("bound that does not hold", sentence) for sentence in record.missed),
        ("time per frame, median", f"{record.frame_ms_median:.0f} ms"),
        ("time to render", f"{record.render_s:.0f} s"),
        ("drawn by", f"{record.gl_renderer}, {record.gl_version}"),
        ("code version", record.code_version),
        ("SHA-256 of the frames", record.raw_sha256),
        ("SHA-256 of the file", record.file_sha256),
    ]


def _flip(record: ClipRecord) -> list[tuple[str, str]]:
    """Return what encoding changed and what the LoDs change, both by FLIP."""
    both = [("FLIP of the encoding", record.flip_encoding)]
    both += [("FLIP between the LoDs", record.flip_lods)]
    return [
        (name, ", ".join(f"{value:.4f}" for value in values)) for name, values in both if values
    ]


def _range(values: list[Any], unit: str, digits: int) -> str:
    if not values:
        return "not measured"
    low, middle, high = min(values), statistics.median(values), max(values)
    return f"{low:.{digits}f} to {high:.{digits}f} {unit}, median {middle:.{digits}f}"
