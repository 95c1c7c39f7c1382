"""The thesis's claims: our numbers beside its words, and nothing made up."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from analysis.descriptive.means import mean_ratings
from analysis.tables.reading import Tables, tables_from
from analysis.thesis.claims import COLUMNS, claims_table
from analysis.thesis.findings import CLAIMS


@pytest.fixture(scope="module")
def claims(thesis_tables: Tables) -> pd.DataFrame:
    return claims_table(thesis_tables).set_index("claim")


def test_every_claim_says_what_the_thesis_said_and_where(claims: pd.DataFrame) -> None:
    assert tuple(claims.reset_index().columns) == COLUMNS
    assert len(claims) == len(CLAIMS) == claims.index.nunique()
    assert claims["section"].isin(["5.2.1", "5.3", "6.1", "6.2"]).all()


def test_numbers_are_those_of_the_data(claims: pd.DataFrame, thesis_tables: Tables) -> None:
    means = mean_ratings(thesis_tables.ratings, ["distance", "lod"]).set_index(["distance", "lod"])
    row = claims.loc["Low at far is rated 2.5"]
    assert row["value"] == pytest.approx(means.loc[("far", "low"), "mean"])
    assert (row["low"], row["high"]) == pytest.approx(
        tuple(means.loc[("far", "low"), ["low", "high"]])
    )
    rated = thesis_tables.ratings["rating"].dropna()
    perfect = claims.loc["Hardly anything is perfect", "found"]
    assert perfect.startswith(f"a 5 in {int((rated == 5).sum())} of {len(rated)} ratings, at most ")
    assert claims.loc["Low is rated highest at far", "found"].startswith("far minus macroscopic, ")


def test_what_the_study_did_not_show_was_not_asked(claims: pd.DataFrame) -> None:
    row = claims.loc["Ultra at near is no better than high there"]
    assert row["found"] == "not asked here"
    assert np.isnan(row["value"])
    asked = claims[claims["found"] != "not asked here"]
    assert len(asked) == len(claims) - 1
    assert asked["value"].notna().all()


def test_a_study_without_texts_says_nothing_of_mentions(thesis_tables: Tables) -> None:
    silent = thesis_tables.comparisons.assign(what_differed=pd.NA, comments=pd.NA)
    frames = {"ratings": thesis_tables.ratings, "comparisons": silent}
    found = claims_table(tables_from(frames)).set_index("claim")["found"]
    assert found["Nobody notices tessellation"] == "not asked here"
    assert found["Nearly everyone notices refraction"] != "not asked here"


def test_people_count_once_and_only_where_they_were_shown_it() -> None:
    names = ["participant", "trial", "distance", "left_lod", "right_lod", "noticed"]
    rows = [
        ("A", "1", "macroscopic", "high", "ultra", "no"),
        ("A", "2", "macroscopic", "ultra", "high", "yes"),
        ("B", "1", "macroscopic", "high", "ultra", "unsure"),
        ("C", "1", "far", "high", "ultra", "yes"),
    ]
    ratings = pd.DataFrame({"participant": ["A"], "lod": ["low"], "rating": [1]})
    comparisons = pd.DataFrame(rows, columns=names)
    tables = tables_from({"ratings": ratings, "comparisons": comparisons})
    row = (
        claims_table(tables).set_index("claim").loc["High and ultra differ for few at macroscopic"]
    )
    assert row["found"] == "1 of 2 people noticed a difference (9\xa0% to 91\xa0%)"


@pytest.mark.parametrize("given", [[], [("A", "low", None)], [("A", "low", 3)] * 2])
def test_hardly_any_data_give_no_number_out_of_nothing(given: list[tuple[str, str, int]]) -> None:
    frame = pd.DataFrame(given, columns=["participant", "lod", "rating"])
    found = claims_table(tables_from({"ratings": frame}))
    assert (found["found"] == "not asked here").sum() >= len(CLAIMS) - 2
    assert not found["found"].str.contains("nan").any()


def test_who_notices_refraction_is_asked_of_pairs_that_differ_in_it() -> None:
    levels = [("low", "low"), ("medium", "high"), ("ultra", "ultra")]  # as in lod.toml
    ratings = pd.DataFrame(
        [("A", lod, 3, level) for lod, level in levels],
        columns=["participant", "lod", "rating", "refraction"],
    )
    comparisons = pd.DataFrame(
        [("A", "1", "near", "medium", "ultra", "yes"), ("B", "1", "near", "low", "medium", "no")],
        columns=["participant", "trial", "distance", "left_lod", "right_lod", "noticed"],
    )
    claim = "Nearly everyone notices refraction"
    tables = tables_from({"ratings": ratings, "comparisons": comparisons})
    found = claims_table(tables).set_index("claim").loc[claim, "found"]
    assert found.startswith("0 of 1 people noticed a difference where one eye is refracted")
    named = tables_from({"ratings": ratings.drop(columns="refraction"), "comparisons": comparisons})
    found = claims_table(named).set_index("claim").loc[claim, "found"]
    assert found.startswith("1 of 1 people")
    alike = tables_from({"ratings": ratings[1:], "comparisons": comparisons[:1]})
    assert claims_table(alike).set_index("claim").loc[claim, "found"] == "not asked here"


def test_tau_counts_those_who_have_one() -> None:
    rows = [("A", "low", 1), ("A", "ultra", 4), ("B", "low", 2), ("B", "ultra", 3)]
    rows += [("C", "low", 2), ("C", "ultra", 2)]
    ratings = pd.DataFrame(rows, columns=["participant", "lod", "rating"])
    row = claims_table(tables_from({"ratings": ratings})).set_index("claim").iloc[0]
    assert row["people"] == 2
    assert row["found"].endswith("n\xa0=\xa02)")
