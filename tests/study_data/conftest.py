"""A database of one's own, a clock set by hand, and a participant to lead through a study."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from renderer.manifest import ClipRecord, Manifest, read_manifest, write_manifest
from renderer.sources import code_version
from study.data import answers, arms, consents, enrolment, progress, steps, studies, views
from study.data.database import Database, open_database
from study.data.participants import Participant
from study.data.studies import Study
from study.design.arms import all_arms
from study.design.definition import StudyDefinition, parse_definition

LEVELS = ("texture", "refraction", "reflection", "subsurface", "caustics", "tessellation", "sclera")
PAGE = {"title": "Title", "button": "Go on", "paragraphs": [{"text": "Words."}]}


@dataclass
class HandClock:
    """A clock that stands still until it is moved."""

    now: datetime = datetime(2026, 11, 22, 9, 0, tzinfo=UTC)

    def __call__(self) -> datetime:
        return self.now

    def move(self, **span: float) -> None:
        self.now += timedelta(**span)


@pytest.fixture
def clock() -> HandClock:
    return HandClock()


@pytest.fixture
def db(database_url: str, clock: HandClock) -> Iterator[Database]:
    database = open_database(database_url, clock=clock)
    yield database
    database.close()


@pytest.fixture
def raw() -> dict[str, Any]:
    """Return a study file: a practice clip, three trials (one catch), all kinds of questions."""
    return {
        "key": "small",
        "version": "1",
        "title": "A small study",
        "contact": {"name": "Nobody", "email": "nobody@example.org"},
        "sizes": ["320x180", "640x360"],
        "distances": ["near", "far"],
        "orbit": {"duration_s": 1.0, "fps": 10},
        "lods": {
            "low": dict.fromkeys(LEVELS, "low"),
            "ultra": dict.fromkeys(LEVELS, "ultra"),
            "own": {"base": "ultra", "caustics": "off"},
        },
        "practice": [{"id": "p", "distance": "near", "left": "low", "right": "own"}],
        "clips": [
            {"id": "a", "distance": "near", "left": "low", "right": "ultra"},
            {"id": "b", "distance": "far", "left": "own", "right": "low"},
        ],
        "catch": [{"distance": "far", "lod": "low"}],
        "consent": {**PAGE, "version": "3"},
        "about": [
            {"id": "age", "kind": "number", "text": "Age?", "minimum": 18, "maximum": 99},
            {
                "id": "gender",
                "kind": "choice",
                "text": "Gender?",
                "options": [{"value": v, "label": v} for v in ("woman", "man", "other")],
            },
            {"id": "pet", "kind": "text", "text": "A pet?"},
        ],
        "about_page": PAGE,
        "instructions": PAGE,
        "questions": [
            {
                "id": "comparison",
                "kind": "choice",
                "text": "The right eye is",
                "options": [{"value": v, "label": f"{v} x"} for v in (-1, 0, 1)],
            },
            {
                "id": "rating_left",
                "kind": "scale",
                "text": "Left?",
                "lowest_label": "not",
                "highest_label": "very",
            },
            {
                "id": "rating_right",
                "kind": "scale",
                "text": "Right?",
                "lowest_label": "not",
                "highest_label": "very",
            },
            {"id": "comments", "kind": "text", "text": "Else?", "max_chars": 50},
            {
                "id": "uncanny",
                "kind": "scale",
                "text": "Uncanny?",
                "highest": 7,
                "lowest_label": "not",
                "highest_label": "very",
            },
        ],
        "thanks": {"title": "Thanks", "paragraphs": [{"text": "Bye."}]},
    }


@pytest.fixture
def definition(raw: dict[str, Any]) -> StudyDefinition:
    return parse_definition(raw)


@pytest.fixture
def study(db: Database, definition: StudyDefinition) -> Study:
    return studies.register(db, definition)


PLAY = {
    "is_complete": True,
    "expected_frames": 10,
    "presented_frames": 10,
    "dropped_frames": 0,
    "shown_scale": 1.0,
}


@dataclass
class Walk:
    """Leads one participant through a study, one step at a time."""

    db: Database
    study: Study
    participant: Participant
    token: str
    play: dict[str, Any] = field(default_factory=lambda: dict(PLAY))

    def consent(self) -> None:
        consents.give_consent(self.db, self.participant, key="consent")

    def about(self, **given: object) -> None:
        steps.store_about(self.db, self.participant, given, key="about")

    def to_preparing(self) -> None:
        self.consent()
        self.about()
        steps.finish_instructions(self.db, self.participant, key="instructions")

    def begin(self) -> None:
        self.to_preparing()
        leased = arms.assign(self.db, self.participant, available=all_arms(self.study.definition))
        assert leased is not None
        self.participant = leased
        steps.begin(self.db, self.participant, key="begin")

    def watch(self, position: int, number: int = 1) -> None:
        key = f"play-{position}-{number}"
        views.record(self.db, self.participant, position, key=key, play=self.play)

    def answer(self, position: int, **given: object) -> None:
        self.watch(position)
        answers.store(
            self.db,
            self.participant,
            position,
            given,
            key=f"answer-{position}",
            is_final=True,
            response_ms=1500,
        )

    def finish(self) -> None:
        while (step := progress.current_step(self.db, self.participant)).trial is not None:
            self.answer(step.trial.position, rating_left="2", rating_right="5", comparison="1")


@pytest.fixture
def walk(db: Database, study: Study) -> Walk:
    return new_walk(db, study)


def new_walk(db: Database, study: Study, *, seed: int = 1, **facts: Any) -> Walk:
    new = enrolment.enrol(db, study, rng=np.random.default_rng(seed), **facts)
    return Walk(db, study, new.participant, new.token)


@pytest.fixture
def enrol_walk(db: Database, study: Study) -> Any:
    """Return a function that enrols one more participant."""
    return lambda seed, **facts: new_walk(db, study, seed=seed, **facts)


@pytest.fixture
def enrol_into(db: Database) -> Any:
    """Return a function that enrols somebody into a study of the test's own."""
    return lambda study, seed=1: new_walk(db, study, seed=seed)


def fake_render(spec: Any, folder: Path, progress_: Any) -> ClipRecord:
    """Stand in for the renderer: write a file and its record in the manifest, no picture."""
    folder.mkdir(parents=True, exist_ok=True)
    data = spec.clip_id.encode()
    (folder / f"{spec.clip_id}.mp4").write_bytes(data)
    record = ClipRecord(
        clip_id=spec.clip_id,
        spec=spec.to_dict(),
        file=f"{spec.clip_id}.mp4",
        file_sha256="0",
        file_bytes=len(data),
        raw_sha256="0",
        frame_count=spec.frame_count,
        width=spec.width,
        height=spec.height,
        fps=spec.fps,
        iris_px=[[1.0, 1.0]],
        visible_px=[[1, 1]],
        psnr_db=[50.0, 50.0],
        ssim=[1.0, 1.0],
        frame_ms_median=1.0,
        render_s=0.1,
        gl_renderer="none",
        gl_version="none",
        code_version=code_version(),
    )
    progress_(0.5)
    manifest: Manifest = read_manifest(folder)
    manifest.add(record)
    write_manifest(manifest, folder)
    progress_(1.0)
    return record


@pytest.fixture
def render() -> Any:
    return fake_render
