"""Simulated people go the way of real ones, are marked as simulated, and can be repeated."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from study.data import completion, dashboard, export, participants
from study.data.database import Database, open_database
from study.data.export import Tables
from study.design.definition import StudyDefinition, parse_definition, read_definition
from study.simulate import simulate


def tables(path: Path, definition: StudyDefinition, clock: Any, *, seed: int, n: int) -> Tables:
    db = open_database(str(path), clock=clock)
    found = export.tables(db, simulate(db, definition, participants=n, seed=seed))
    db.close()
    return found


@pytest.fixture(scope="module")
def thesis() -> StudyDefinition:
    return read_definition("thesis")


def test_everybody_completes_the_thesis_study(db: Database, thesis: StudyDefinition) -> None:
    heard: list[int] = []
    study = simulate(db, thesis, participants=4, seed=1, progress=heard.append)
    found = export.tables(db, study)
    assert heard == [1, 2, 3, 4]
    assert len(found.ratings) == 4 * 8 * 2
    assert found.ratings["simulated"].all()
    assert found.comparisons["simulated"].all()
    assert found.participants["simulated"].all()
    assert found.participants["status"].tolist() == ["completed"] * 4
    assert sorted(found.participants["arm"]) == [
        *["1920x1080 leftward"] * 2,
        *["1920x1080 rightward"] * 2,
    ]
    overview = dashboard.summary(db, study)
    assert (overview.simulated.completed, overview.real.arrived) == (4, 0)
    person = participants.by_public_id(db, study, overview.people[0].public_id)
    assert person is not None
    assert completion.code(db, person) is not None


def test_their_answers_fit_the_columns(db: Database, thesis: StudyDefinition) -> None:
    found = export.tables(db, simulate(db, thesis, participants=6, seed=2))
    assert set(found.ratings["rating"].dropna()) <= {1, 2, 3, 4, 5}
    assert set(found.comparisons["comparison"].dropna()) <= {-1, 0, 1}
    assert set(found.comparisons["noticed"].dropna()) <= {"yes", "unsure", "no"}
    assert found.participants["age"].between(18, 120).all()
    assert set(found.participants["works_with_graphics"].dropna()) <= {"yes", "no"}
    assert found.ratings["certified"].all()
    assert (found.ratings["response_ms"] > 5000).all()


def test_better_eyes_are_rated_higher_up_close(db: Database, thesis: StudyDefinition) -> None:
    ratings = export.tables(db, simulate(db, thesis, participants=12, seed=3)).ratings
    near = ratings[(ratings["distance"] == "macroscopic") & ~ratings["is_practice"]]
    means = near.groupby("lod")["rating"].mean()
    assert means["low"] + 0.5 < means["ultra"]


def test_simulated_people_take_the_recommended_study_whole(db: Database) -> None:
    study = simulate(db, read_definition("lod"), participants=2, seed=4)
    found = export.tables(db, study)
    rows = found.comparisons
    assert len(rows) == 2 * (3 + 16 + 4 + 1)
    assert rows.groupby("is_catch").size().tolist() == [2 * 19, 2 * 5]  # one is for practice
    assert rows["is_warm_up"].sum() == 2 * 2
    assert found.participants["attention_passed"].notna().all()
    assert found.participants["block"].nunique() == found.participants["order_row"].nunique() == 2
    assert found.participants["outcome"].tolist() == ["completed"] * 2


def test_the_same_seed_gives_the_same_people_and_answers(
    tmp_path: Path, definition: StudyDefinition, clock: Any
) -> None:
    first = tables(tmp_path / "a.sqlite3", definition, clock, seed=5, n=3)
    again = tables(tmp_path / "b.sqlite3", definition, clock, seed=5, n=3)
    longer = tables(tmp_path / "c.sqlite3", definition, clock, seed=5, n=4)
    other = tables(tmp_path / "d.sqlite3", definition, clock, seed=6, n=3)
    pd.testing.assert_frame_equal(first.ratings, again.ratings)
    pd.testing.assert_frame_equal(first.participants, again.participants)
    pd.testing.assert_frame_equal(first.ratings, longer.ratings.head(len(first.ratings)))
    assert not first.ratings["rating"].equals(other.ratings["rating"])


def test_any_study_can_be_simulated(db: Database, raw: dict[str, Any]) -> None:
    raw["order"] = {"min_views": 2}
    for question in (*raw["questions"], *raw["about"]):
        question["is_required"] = question["kind"] != "text"
    study = simulate(db, parse_definition(raw), participants=10, seed=1)
    found = export.tables(db, study)
    done = found.participants["status"] == "completed"
    assert done.all()
    assert (found.ratings["views"] >= 2).all()
    assert found.comparisons["uncanny"].between(1, 7).all()
    assert found.participants["gender"].isin(["woman", "man", "other"]).all()
