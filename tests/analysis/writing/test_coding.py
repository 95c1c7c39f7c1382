"""Free text: the rules in both languages, codes by hand, rates that count people."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from analysis.tables.parsing import TableError
from analysis.tables.reading import Tables, tables_from
from analysis.writing.code_book import CODE_NAMES, codes_in
from analysis.writing.coding import (
    ALL,
    code_remarks,
    mention_rates,
    mentions,
    read_codes,
    unused_codes,
)


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("The left eye has NO reflection", ("reflection",)),
        ("I can see people moving in the right eye", ("dynamic reflection",)),
        ("reflection of the left eye moves", ("reflection", "dynamic reflection")),
        ("pupil is bigger", ("refraction",)),
        ("light pattern on the iris", ("caustics",)),
        ("veins in the white", ("sclera",)),
        ("blurry, less detailed", ("texture",)),
        ("its edges look angular", ("tessellation",)),
        ("you see fibres, subsurface scattering", ("subsurface",)),
        ("a bit see-through", ("see-through",)),
        ("darker, more brown", ("colour",)),
        ("looks flat and fake", ("flatness",)),
        ("strange to compare two eyes", ("the pair",)),
        ("no difference at all", ()),
        ("الانعكاس أوضح", ("reflection",)),
        ("الاِنْعِكاس يتحرك", ("reflection", "dynamic reflection")),
        ("البؤبؤ أكبر والعروق ظاهرة", ("refraction", "sclera")),
        ("صورة غير واضحة", ("texture",)),
        ("العين شفّافة", ("see-through",)),
        ("اللون أغمق", ("colour",)),
        ("كما يقولون، الفرق واضح", ()),
    ],
)
def test_words_mention_what_they_mean(text: str, codes: tuple[str, ...]) -> None:
    assert codes_in(text) == codes


COLUMNS = ["participant", "trial", "distance", "left_lod", "right_lod", "what_differed"]


def tables(*rows: tuple[object, ...]) -> Tables:
    comparisons = pd.DataFrame(rows, columns=COLUMNS)
    ratings = pd.DataFrame({"participant": ["A"], "lod": ["low"], "rating": [1]})
    return tables_from({"ratings": ratings, "comparisons": comparisons})


REMARKS = (
    ("A", "1", "near", "low", "ultra", "no reflection"),
    ("A", "2", "near", "ultra", "low", "reflection again"),
    ("B", "1", "near", "low", "ultra", None),
    ("C", "1", "near", "low", "ultra", "pupil"),
    ("C", "3", "far", "low", "ultra", "something"),
)


def test_a_person_counts_once_per_pair_whichever_side_and_silence_counts_too() -> None:
    rates = mention_rates(tables(*REMARKS).comparisons).set_index(["distance", "code"])
    row = rates.loc[("near", "reflection")]
    assert (row["lesser"], row["greater"], row["count"], row["people"]) == ("low", "ultra", 1, 3)
    assert (row["low"], row["high"]) == pytest.approx((0.0615, 0.7923), abs=1e-4)
    assert rates.loc[(ALL, "refraction"), "count"] == 1
    assert rates.loc[("far", "reflection"), "people"] == 1


def test_codes_by_hand_replace_the_rules() -> None:
    manual = {("A", "1"): frozenset(("sclera", "caustics")), ("A", "2"): frozenset[str]()}
    coded = code_remarks(tables(*REMARKS).comparisons, manual).set_index(["participant", "trial"])
    assert coded.loc[("A", "1"), "codes"] == "caustics;sclera"
    assert coded.loc[("A", "2"), "codes"] == ""
    assert coded["coded_by"].tolist() == ["hand", "hand", "rule", "rule"]
    table = mentions(tables(*REMARKS).comparisons, manual).set_index(["distance", "participant"])
    assert not table.loc[("near", "A"), "reflection"]
    assert table.loc[("near", "A"), "sclera"]
    lost = unused_codes(tables(*REMARKS).comparisons, {("Z", "9"): frozenset()})
    assert lost == ["Codes given by hand for remarks that are not there, not used: Z 9."]


def test_a_reports_codes_can_be_given_back(tmp_path: Path) -> None:
    path = tmp_path / "remark-codes.csv"
    code_remarks(tables(*REMARKS).comparisons).to_csv(path, index=False)
    assert read_codes(path) == {
        ("A", "1"): {"reflection"},
        ("A", "2"): {"reflection"},
        ("C", "1"): {"refraction"},
        ("C", "3"): set(),
    }


def test_faults_of_codes_by_hand_name_row_and_what_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "codes.csv"
    path.write_text("participant,trial,codes\nA,1,shine;sclera\nA,1,\n", encoding="utf-8")
    with pytest.raises(TableError) as caught:
        read_codes(path)
    assert caught.value.faults == (
        f'codes.csv: row 2: codes: found "shine"; accepted: {", ".join(CODE_NAMES)}',
        "codes.csv: row 3: A 1 occurs twice; accepted: once",
    )
    path.write_text("participant,words\n", encoding="utf-8")
    with pytest.raises(TableError, match='row 1: column "trial" is missing; found participant, w'):
        read_codes(path)
    path.write_bytes(b"participant,trial,codes\n\xff")
    with pytest.raises(TableError, match="byte 24 is not UTF-8"):
        read_codes(path)
    with pytest.raises(TableError, match="not found; accepted: a CSV file of codes"):
        read_codes(tmp_path / "none.csv")


def test_nothing_written_gives_empty_tables() -> None:
    empty = tables().comparisons
    assert code_remarks(empty).empty
    assert mentions(empty).empty
    assert mention_rates(empty).empty
