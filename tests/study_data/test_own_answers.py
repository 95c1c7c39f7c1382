"""The columns of a study's own questions: typed, tidy, one per option, one per eye."""

from __future__ import annotations

from typing import Any

import pytest

from study.data import answers, export, studies
from study.data.database import Database
from study.data.studies import Study
from study.design.definition import parse_definition

ROWS = [{"id": "iris", "label": "Iris"}]
OPTIONS = [{"value": "iris", "label": "the iris"}, {"value": "lids", "label": "the lids"}]
OWN: list[dict[str, Any]] = [
    {"id": "where", "kind": "multiple", "text": "You saw", "options": OPTIONS},
    {
        "id": "alive",
        "kind": "analogue",
        "text": "Alive?",
        "lowest_label": "no",
        "highest_label": "yes",
    },
    {
        "id": "sure",
        "kind": "number",
        "text": "Sure?",
        "minimum": 0,
        "maximum": 1,
        "decimals": 2,
    },
    {
        "id": "detail",
        "kind": "matrix",
        "text": "Detail",
        "rows": ROWS,
        "per_eye": True,
        "labels": ["poor", "fair", "good"],
        "highest": 3,
    },
]


@pytest.fixture
def study(db: Database, raw: dict[str, Any]) -> Study:
    raw["questions"] += OWN
    raw["about"] += [OWN[0] | {"id": "glasses"}]
    return studies.register(db, parse_definition(raw))


@pytest.fixture
def tables(db: Database, study: Study, enrol_walk: Any) -> export.Tables:
    """One participant who ticks, marks, types and rates at the first trial and then no more."""
    walk = enrol_walk(1)
    walk.consent()
    walk.about(age="41", glasses=["lids"])
    walk.begin()
    given = {
        "where": ["lids"],
        "alive": "63",
        "sure": "0,75",
        "detail_iris_left": "1",
        "detail_iris_right": "3",
    }
    answers.store(db, walk.participant, 1, given, key="own")
    walk.finish()
    return export.tables(db, study)


def test_every_answer_has_its_type_and_column(tables: export.Tables) -> None:
    row = tables.comparisons.iloc[0]
    found = {name: row[name] for name in ("where_iris", "where_lids", "alive", "sure")}
    assert found == {"where_iris": False, "where_lids": True, "alive": 63, "sure": 0.75}
    kinds = {name: str(tables.comparisons[name].dtype) for name in found}
    assert kinds == {
        "where_iris": "boolean",
        "where_lids": "boolean",
        "alive": "Int64",
        "sure": "Float64",
    }
    assert tables.comparisons.iloc[1][list(found)].isna().all()


def test_what_was_asked_of_each_eye_is_a_column_of_ratings(tables: export.Tables) -> None:
    trial = tables.ratings["trial"].iloc[0]
    first = tables.ratings[tables.ratings["trial"] == trial].set_index("eye")
    assert (first.loc["left", "detail_iris"], first.loc["right", "detail_iris"]) == (1, 3)
    assert not any(name.startswith("detail") for name in tables.comparisons.columns)


def test_answers_about_the_participant_stand_with_them(tables: export.Tables) -> None:
    row = tables.participants.iloc[0]
    assert (row["age"], row["glasses_iris"], row["glasses_lids"]) == (41, False, True)


def test_the_codebook_tells_every_own_column(tables: export.Tables) -> None:
    told = {
        (table, column["name"]): column
        for table, columns in tables.codebook["tables"].items()
        for column in columns
    }
    assert told["comparisons", "where_lids"] == {
        "name": "where_lids",
        "type": "boolean",
        "meaning": "You saw the lids",
    }
    assert told["ratings", "detail_iris"]["meaning"] == "Detail – Iris"
    assert told["comparisons", "sure"]["accepted"] == {"lowest": 0, "highest": 1}
