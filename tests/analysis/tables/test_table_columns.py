"""The tables' columns as data: the contract between the export, the codebook and the reader."""

import json

import pytest

from analysis.tables import codebook, columns
from renderer import clip_values, detail
from renderer.lod import choice


def test_words_are_those_of_the_renderer() -> None:
    assert columns.EFFECTS == detail.EFFECTS
    assert columns.LEVELS == detail.LEVELS
    assert columns.STANDARD_LODS == detail.STANDARD_LODS
    assert columns.DISTANCES == clip_values.DISTANCES
    assert choice.WIDEST_PX == columns.WIDEST_PX == clip_values.RANGES["width"][1]


def test_ratings_have_the_contracts_columns_in_its_order() -> None:
    contract = (
        "study, study_version, simulated, participant, session, trial, position, clip, distance, "
        "iris_px, iris_deg, iris_deg_se, shown_scale, shown_scale_se, orbit_direction, iris, "
        "iris_seed, iris_colour, crowd, eye, lod, lod_rank, other_lod, texture, refraction, "
        "reflection, subsurface, caustics, tessellation, sclera, rating, is_practice, is_catch, "
        "is_warm_up, is_gold, certified, uncertified_because, dropped_frames, views, response_ms, "
        "clock_ms, started_at"
    )
    assert columns.column_names("ratings") == tuple(contract.split(", "))


@pytest.mark.parametrize("name", list(columns.COLUMNS))
def test_every_column_has_one_meaning(name: str) -> None:
    own = columns.COLUMNS[name]
    assert len({column.name for column in own}) == len(own)
    assert all(column.meaning for column in own)


def test_codebook_survives_json_and_gives_back_what_a_study_accepts() -> None:
    own = {"lod": ["low", "ultra-no-caustics"], "rating": (1.0, 7.0)}
    book = json.loads(json.dumps(codebook.codebook(own)))
    accepted = codebook.accepted_in(book, "ratings")
    assert accepted["lod"] == ["low", "ultra-no-caustics"]
    assert accepted["rating"] == (1.0, 7.0)
    assert accepted["eye"] == ["left", "right"]


def test_a_studys_own_columns_enter_its_codebook() -> None:
    own = columns.Column("screen", "text", "which of the two laboratory screens")
    book = codebook.codebook(more={"participants": [own]})
    assert book["tables"]["participants"][-1]["name"] == "screen"
