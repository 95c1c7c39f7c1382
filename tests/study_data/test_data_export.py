"""Export and overview: the tables say what was stored, no more and no less."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from analysis import column_names
from renderer.camera import iris_px
from study.data import answers, dashboard, erasure, events, export, jobs
from study.data.database import Database
from study.data.export import Tables, csv_of
from study.data.studies import Study
from study.design.parts import read_size

DEVICE = {
    "screen_width": 1280,
    "screen_height": 800,
    "pixel_ratio": 1.5,
    "user_agent_family": "Firefox",
}


@pytest.fixture
def walked(enrol_walk: Any, clock: Any) -> Any:
    """Lead one participant to the end."""
    walk = enrol_walk(1, device=DEVICE)
    walk.consent()
    walk.about(age="41", gender="other", pet="a “cat”, two\ndogs; =1+1")
    clock.move(minutes=1)
    walk.begin()
    walk.finish()
    return walk


def of(frame: pd.DataFrame, **where: Any) -> pd.DataFrame:
    for name, value in where.items():
        frame = frame[frame[name] == value]
    return frame


def test_the_columns_are_those_of_the_analysis_and_the_studys_own(
    db: Database, study: Study, walked: Any
) -> None:
    assert walked
    found = export.tables(db, study)
    assert tuple(found.ratings.columns) == column_names("ratings")
    assert tuple(found.comparisons.columns) == (*column_names("comparisons"), "uncanny")
    assert tuple(found.participants.columns) == (*column_names("participants"), "pet")


def test_a_rating_row_says_what_was_seen_and_answered(
    db: Database, study: Study, walked: Any
) -> None:
    row = of(export.tables(db, study).ratings, clip="b", eye="left").iloc[0].to_dict()
    person = walked.participant
    trial = next(t for t in study.definition.trial_clips if t.id == "b")
    spec = study.definition.clip_spec(
        trial, size=read_size(person.size), orbit_direction=person.orbit_direction
    )
    assert row["study"] == "small"
    assert row["study_version"] == "1"
    assert row["participant"] == person.public_id
    assert row["session"] == f"{person.public_id}-1"
    assert row["trial"].startswith(f"{person.public_id}-0")
    assert (row["lod"], row["other_lod"], row["distance"]) == ("own", "low", "far")
    assert pd.isna(row["lod_rank"])
    assert (row["caustics"], row["texture"]) == ("off", "ultra")
    assert (row["rating"], row["response_ms"], row["views"]) == (2, 1500, 1)
    assert row["orbit_direction"] == person.orbit_direction
    assert 0.8 * iris_px(spec, 0)[0] < row["iris_px"] <= iris_px(spec, 0)[0]
    assert (row["shown_scale"], row["dropped_frames"]) == (1.0, 0)
    assert row["certified"]
    assert pd.isna(row["iris_deg"])
    assert not row["is_practice"]
    assert not row["is_catch"]
    assert row["started_at"] == "2026-11-22T09:01:00.000+00:00"


def test_every_trial_has_two_ratings_and_one_comparison(
    db: Database, study: Study, walked: Any
) -> None:
    found = export.tables(db, study)
    assert len(found.ratings) == 2 * len(found.comparisons) == 8
    assert sorted(of(found.ratings, is_practice=False)["position"]) == [1, 1, 2, 2, 3, 3]
    assert list(of(found.ratings, is_catch=True)["clip"].unique()) == ["catch-far-low"]
    assert list(of(found.ratings, is_practice=True)["clip"].unique()) == ["p"]
    assert set(found.comparisons["comparison"]) == {1}
    assert walked.participant.public_id == found.ratings["participant"].unique()[0]


def test_skipped_questions_are_missing_and_never_zero(
    db: Database, study: Study, walk: Any
) -> None:
    walk.begin()
    walk.answer(1)
    found = export.tables(db, study)
    assert found.ratings["rating"].isna().all()
    line = csv_of(found.comparisons).splitlines()[1]
    assert pd.isna(found.comparisons["comparison"].iloc[0])
    assert ",,,," in line


def test_an_unfinished_trial_is_exported_with_what_was_given(
    db: Database, study: Study, walk: Any
) -> None:
    walk.begin()
    walk.watch(1)
    answers.store(db, walk.participant, 1, {"rating_left": "3"}, key="draft")
    found = export.tables(db, study)
    assert of(found.ratings, eye="left")["rating"].tolist() == [3]
    assert found.ratings["response_ms"].isna().all()
    assert found.participants["status"].tolist() == ["0 trials"]


def test_amendments_do_not_reach_the_tables(db: Database, study: Study, walk: Any) -> None:
    walk.begin()
    walk.answer(1, rating_left="2")
    answers.store(db, walk.participant, 1, {"rating_left": "5"}, key="late")
    assert of(export.tables(db, study).ratings, eye="left")["rating"].tolist() == [2]


def test_participants_are_described_as_they_described_themselves(
    db: Database, study: Study, walked: Any
) -> None:
    row = export.tables(db, study).participants.iloc[0].to_dict()
    assert row["participant"] == walked.participant.public_id
    assert (row["age"], row["gender"]) == (41, "other")
    assert row["pet"] == "a “cat”, two\ndogs; =1+1"
    assert (row["screen_width"], row["pixel_ratio"]) == (1280, 1.5)
    assert row["user_agent_family"] == "Firefox"
    assert row["status"] == "completed"
    assert row["started_at"] == "2026-11-22T09:00:00.000+00:00"
    assert row["completed_at"] == "2026-11-22T09:01:00.000+00:00"
    assert row["arm"] in ("640x360 rightward", "640x360 leftward")


def test_who_withdrew_or_never_agreed_is_in_no_table(
    db: Database, study: Study, walked: Any, enrol_walk: Any
) -> None:
    enrol_walk(2)
    erasure.withdraw(db, walked.participant)
    found = export.tables(db, study)
    assert [len(t) for t in (found.ratings, found.comparisons, found.participants)] == [0, 0, 0]
    assert tuple(found.ratings.columns) == column_names("ratings")


def test_files_can_be_read_back(db: Database, study: Study, walked: Any, tmp_path: Path) -> None:
    assert walked
    paths = export.write(db, study, tmp_path / "out")
    assert [path.name for path in paths] == [
        *("ratings.csv", "comparisons.csv", "participants.csv", "codebook.json", "study.json")
    ]
    found = export.tables(db, study)
    ratings = paths[0].read_text(encoding="utf-8")
    assert ratings.splitlines()[0] == ",".join(column_names("ratings"))
    assert ",false," in ratings
    assert "True" not in ratings
    people = pd.read_csv(io.StringIO(paths[2].read_text(encoding="utf-8")))
    assert people["pet"].tolist() == found.participants["pet"].tolist()
    book = json.loads(paths[3].read_text(encoding="utf-8"))
    assert book == json.loads(json.dumps(found.codebook))
    assert json.loads(paths[4].read_text(encoding="utf-8"))["key"] == "small"


def test_the_codebook_explains_every_column_with_the_studys_values(
    db: Database, study: Study
) -> None:
    book = export.tables(db, study).codebook
    assert book["study"] == "small"
    assert book["definition_hash"] == study.definition.definition_hash
    columns = {
        table: {entry["name"]: entry for entry in entries}
        for table, entries in book["tables"].items()
    }
    assert columns["ratings"]["lod"]["accepted"] == ["low", "ultra", "own"]
    assert columns["ratings"]["distance"]["accepted"] == ["near", "far"]
    assert columns["comparisons"]["uncanny"] == {
        "name": "uncanny",
        "type": "integer",
        "meaning": "Uncanny?",
        "accepted": {"lowest": 1, "highest": 7},
    }
    assert columns["participants"]["gender"]["accepted"] == ["woman", "man", "other"]
    assert columns["participants"]["pet"]["type"] == "text"


def test_plays_that_nobody_counted_are_not_certified_as_anything(
    db: Database, study: Study, walk: Any
) -> None:
    walk.play = {"is_complete": True, "dropped_frames": "lots", "shown_scale": -3}
    walk.begin()
    walk.answer(1)
    row = export.tables(db, study).ratings.iloc[0]
    for name in ("certified", "dropped_frames", "shown_scale"):
        assert pd.isna(row[name]), name


def test_one_good_play_certifies_the_trial(db: Database, study: Study, walk: Any) -> None:
    walk.begin()
    walk.play["dropped_frames"], walk.play["presented_frames"] = 5, 5
    walk.watch(1, number=1)
    first = export.tables(db, study).ratings.iloc[0]
    walk.play["dropped_frames"], walk.play["presented_frames"] = 0, 10
    walk.watch(1, number=2)
    second = export.tables(db, study).ratings.iloc[0]
    assert (bool(first["certified"]), first["dropped_frames"], first["views"]) == (False, 5, 1)
    assert (bool(second["certified"]), second["dropped_frames"], second["views"]) == (True, 5, 2)


def test_the_overview_says_who_is_where(
    db: Database, study: Study, walked: Any, enrol_walk: Any, clock: Any
) -> None:
    jobs.enqueue(db, study.definition.wanted_specs())
    enrol_walk(2)
    midway = enrol_walk(3)
    midway.begin()
    midway.answer(1)
    midway.answer(2)
    enrol_walk(4, simulated=True)
    erasure.withdraw(db, enrol_walk(5).participant)
    events.record(db, midway.participant, key="x", kind="problem", position=3)
    found = dashboard.summary(db, study)
    assert [(p.step, p.number, p.total) for p in found.people] == [
        *(("thanks", 0, 0), ("consent", 0, 0), ("trial", 2, 3), ("consent", 0, 0)),
    ]
    assert [(one.step, one.simulated) for one in found.withdrawals] == [("consent", False)]
    assert found.real.outcomes == {"completed": 1, "screened_out": 0, "failed_checks": 0}
    assert found.people[0].public_id == walked.participant.public_id
    assert (found.real.arrived, found.real.completed, found.real.withdrawn) == (4, 1, 1)
    assert (found.real.here, found.real.trials) == (2, 4)
    assert {step: n for step, n in found.real.steps.items() if n} == {
        **{"consent": 1, "trial": 1, "thanks": 1, "withdrawn": 1},
    }
    assert (found.simulated.arrived, found.simulated.steps["consent"]) == (1, 1)
    assert sum(found.arms.values()) == 2
    assert (found.jobs.total, found.jobs.done) == (16, 0)
    clock.move(minutes=31)
    assert dashboard.summary(db, study).real.here == 0


def test_an_empty_study_exports_and_summarises(db: Database, study: Study) -> None:
    found: Tables = export.tables(db, study)
    assert csv_of(found.ratings) == ",".join(column_names("ratings")) + "\n"
    assert dashboard.summary(db, study).people == []
