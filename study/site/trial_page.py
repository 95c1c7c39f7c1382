"""The page of one trial: from where somebody stands to HTML.

What is alike for everybody at such a trial is rendered once (``study.site.mould``); a page that
shows answers or faults is rendered whole.
"""

from __future__ import annotations

import secrets
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from types import SimpleNamespace
from typing import Any, Final

from fastapi.responses import HTMLResponse, Response

from renderer.manifest import ClipRecord
from study.data.progress import Step
from study.data.trials import Trial
from study.design.questions import AnswerError
from study.site.access import Visitor
from study.site.casting import blank_visitor, visitors_own
from study.site.frame import shared, words_of
from study.site.media import clip_url
from study.site.mould import place
from study.site.parts import Parts
from study.site.place import Place
from study.site.time_left import minutes_left

Say = Callable[..., str]
TEMPLATE: Final = "participant/trial.html"
_CLIP: Final = ("file_bytes", "width", "height", "frame_count")


@dataclass(frozen=True)
class Shown:
    """What a page is about: who sees it, which trial among all of theirs, and its clip."""

    here: Place
    visitor: Visitor
    step: Step
    trial: Trial
    every: tuple[Trial, ...]
    record: ClipRecord


def trial_page(
    shown: Shown,
    *,
    given: Mapping[str, object] | None = None,
    error: AnswerError | None = None,
    note: str = "",
) -> Response:
    """Return the page; ``given`` was sent and not stored, and ``error`` or ``note`` says why."""
    visitor, found = shown.visitor, shown.trial
    definition = visitor.study.definition
    text = words_of(visitor.study, visitor).markup
    parts = shown.here.parts.of(definition, text)
    rows = parts.rows_of(definition.questions_at(found.number, is_practice=found.is_practice))
    answers = {**found.answers, **(given or {})}
    alike, own = _alike(shown, parts), _own(shown, text)
    if rows is parts.rows and not (answers or error or note):
        mould = parts.moulds.of(
            (*alike.values(), len(own["steps"]), visitor.is_simulated, visitor.is_over),
            partial(_blank_page, shown, parts, alike, steps=len(own["steps"])),
        )
        return HTMLResponse(mould.fill(_filling(own, visitor)))
    rendered = _rendered(
        shown,
        {**alike, **own},
        visitor,
        rows=rows,
        blank=None,
        answers=answers,
        faults=error.said(text) if error else {},
        note=text(note) if note else "",
    )
    return HTMLResponse(rendered, status_code=422 if error or note else 200)


def _rendered(
    shown: Shown, values: Mapping[str, Any], visitor: Visitor, **questionnaire: object
) -> str:
    study = shown.visitor.study
    frame = shared(study, visitor, "trial")
    button = frame["text"]("trial.finish" if values["is_last"] else "trial.next")
    retries = study.definition.certificate.retries
    template = shown.here.pages.get_template(TEMPLATE)
    return template.render(frame, button=button, retries=retries, **values, **questionnaire)


def _alike(shown: Shown, parts: Parts) -> dict[str, Any]:
    """Return what the template asks about or says in a sentence: few values, each with a mould."""
    definition, found, record = shown.visitor.study.definition, shown.trial, shown.record
    least, most = definition.order.min_views, definition.order.max_views
    return {
        "is_practice": found.is_practice,
        "is_watched": found.views >= least,
        "is_last": found.position == shown.every[-1].position,
        "views_left": max(0, least - found.views),
        # How many more plays the study allows, None for any number.
        "views_allowed": None if most is None else max(0, most - found.views),
        "seconds": max(1, round(record.frame_count / record.fps)),
        "minutes_left": minutes_left(definition, shown.every, estimate_s=parts.estimate_s),
    }


def _own(shown: Shown, text: Say) -> dict[str, Any]:
    """Return what is printed as it stands and differs from page to page."""
    found = shown.trial
    return {
        "heading": _heading(shown.step, text),
        "steps": _steps(shown.every, found),
        "position": found.position,
        "clip": shown.record,
        "clip_url": clip_url(shown.record),
        "next_clips": _to_come(shown.here, shown.every, found),
        "code": f"{shown.visitor.name.upper()}-{found.position}",
        "key": secrets.token_hex(16),
    }


def _blank_page(shown: Shown, parts: Parts, alike: Mapping[str, Any], *, steps: int) -> str:
    """Render the page with places for whatever is one trial's and one visitor's own."""
    own = {
        **{name: place(name) for name in ("heading", "position", "clip_url", "code", "key")},
        "steps": [place(f"step-{n}") for n in range(steps)],
        "clip": SimpleNamespace(**{name: place(name) for name in _CLIP}),
        "next_clips": [place("next_clips")],
    }
    blank = {"rows": parts.rows, "blank": parts.blank, "answers": {}, "faults": {}, "note": ""}
    return _rendered(shown, {**alike, **own}, blank_visitor(shown.visitor), **blank)


def _filling(own: Mapping[str, Any], visitor: Visitor) -> dict[str, object]:
    """Return what stands at the places of ``_blank_page``."""
    return {
        **own,
        **{f"step-{n}": step for n, step in enumerate(own["steps"])},
        **{name: getattr(own["clip"], name) for name in _CLIP},
        "next_clips": ",".join(own["next_clips"]),
        **visitors_own(visitor),
    }


def _heading(step: Step, text: Say) -> str:
    if step.name == "practice" and step.total == 1:
        return text("trial.practice")
    key = "trial.practice_number" if step.name == "practice" else "trial.clip_number"
    return text(key, number=step.number, total=step.total)


def _steps(every: tuple[Trial, ...], current: Trial) -> list[str]:
    """Return the marks of the progress bar: one per trial of the current kind."""
    alike = [one for one in every if one.is_practice == current.is_practice]
    return [
        "now" if one.position == current.position else "done" if one.is_complete else "ahead"
        for one in alike
    ]


def _to_come(here: Place, every: tuple[Trial, ...], current: Trial) -> list[str]:
    """Return address and length of the clips that come later, for the preloader."""
    records = here.clips.records(one.clip_id for one in every if one.position > current.position)
    return [f"{clip_url(record)} {record.file_bytes}" for record in records]
