"""Reading ratings: what is accepted, what is completed, and every fault with its place."""

import json
from pathlib import Path

import pandas as pd
import pytest

from analysis.tables.codebook import codebook
from analysis.tables.parsing import TableError
from analysis.tables.reading import read_source, tables_from


def write(folder: Path, text: str, name: str = "ratings.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def faults_of(path: Path) -> tuple[str, ...]:
    with pytest.raises(TableError) as caught:
        read_source(path)
    return caught.value.faults


def test_three_columns_are_enough(tmp_path: Path) -> None:
    tables = read_source(write(tmp_path, "participant,lod,rating\nA,low,2\nA,ultra,4\n"))
    assert tables.ratings["rating"].tolist() == [2, 4]
    assert tables.ratings["lod_rank"].tolist() == [1, 4]
    assert tables.ratings["clip"].tolist() == ["low", "ultra"]
    assert tables.ratings["distance"].tolist() == ["unstated", "unstated"]
    assert not tables.is_simulated


def test_an_empty_cell_is_missing_and_not_zero(tmp_path: Path) -> None:
    tables = read_source(write(tmp_path, "participant,lod,rating\nA,low,\nA,ultra,4\n"))
    assert tables.ratings["rating"].isna().tolist() == [True, False]


def test_every_fault_is_reported_at_once_with_its_place(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        "participant,lod,rating,eye,simulated\nA,low,9,left,no\n,low,2.5,middle,true\n",
    )
    assert faults_of(path) == (
        'ratings.csv: row 2, simulated: found "no"; accepted true or false or empty',
        'ratings.csv: row 2, rating: found "9"; accepted a whole number from 1 to 5 or empty',
        'ratings.csv: row 3, participant: found ""; accepted some text',
        'ratings.csv: row 3, eye: found "middle"; accepted one of left, right or empty',
        'ratings.csv: row 3, rating: found "2.5"; accepted a whole number from 1 to 5 or empty',
    )


def test_rows_are_counted_past_blank_lines(tmp_path: Path) -> None:
    path = write(tmp_path, "participant,lod,rating\n\nA,low,2\n\nA,low,0\n")
    assert faults_of(path)[0].startswith("ratings.csv: row 5, rating")


def test_a_number_that_no_computer_counts_to_is_refused(tmp_path: Path) -> None:
    text = f"participant,lod,rating,response_ms\nA,low,2,{2**53}\nA,high,2,{10**25}\n"
    assert faults_of(write(tmp_path, text)) == (
        f'ratings.csv: row 3, response_ms: found "{10**25}"; accepted a whole number of at most 15 '
        "digits from 0 on or empty",
    )


def test_a_lod_has_one_rank_and_shares_it_with_none(tmp_path: Path) -> None:
    text = "participant,lod,lod_rank,rating\nA,matt,1,2\nA,gloss,2,2\nA,matt,2,3\nA,low,,3\n"
    assert faults_of(write(tmp_path, text)) == (
        "ratings.csv: row 4, lod_rank: found 2 for matt, which has 1 in an earlier row; accepted: "
        "one rank for each LoD",
        "ratings.csv: row 5, lod_rank: found 1 for matt and low; accepted: a rank for one LoD "
        "alone, 1 for the least",
    )


def test_a_misspelt_column_is_recognised(tmp_path: Path) -> None:
    faults = faults_of(write(tmp_path, "participant,lod,ratng\nA,low,2\n"))
    assert faults == (
        'ratings.csv: row 1: column "rating" is missing; found participant, lod, ratng; '
        'needed at least participant, lod, rating; did you mean it by "ratng"?',
    )


def test_a_column_given_twice_is_a_fault(tmp_path: Path) -> None:
    faults = faults_of(write(tmp_path, "participant,lod,rating,rating\nA,low,2,3\n"))
    assert faults == ('ratings.csv: row 1: column "rating" occurs 2 times; accepted: once',)


def test_a_ragged_row_is_named(tmp_path: Path) -> None:
    faults = faults_of(write(tmp_path, "participant,lod,rating\nA,low\nB,low,3\n"))
    assert faults == ("ratings.csv: row 2: found 2 cells; accepted 3, as many as the header has",)


def test_an_empty_file_says_what_it_needs(tmp_path: Path) -> None:
    faults = faults_of(write(tmp_path, ""))
    assert len(faults) == 3
    assert 'column "participant" is missing; found no columns' in faults[0]


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "ratings.csv"
    path.write_bytes(b"participant,lod,rating\n\xff\xfe")
    assert faults_of(path) == (
        "ratings.csv: row 2: byte 0xff is not UTF-8; accepted: CSV text in UTF-8, or in UTF-16 "
        'with a byte order mark (in a spreadsheet, save as "CSV UTF-8")',
    )


def test_a_missing_source_and_a_folder_without_ratings_are_refused(tmp_path: Path) -> None:
    assert (
        "not found; accepted: a ratings file or an export's folder"
        in faults_of(tmp_path / "nothing.csv")[0]
    )
    write(tmp_path, "x", "notes.txt")
    assert faults_of(tmp_path)[0].endswith("found notes.txt; needed at least ratings.csv")


def test_semicolons_and_a_byte_order_mark_are_read(tmp_path: Path) -> None:
    path = write(tmp_path, "\ufeffparticipant;lod;rating\nA;low;2\n")
    assert read_source(path).ratings["participant"].tolist() == ["A"]


def test_unknown_columns_are_named_and_left_out(tmp_path: Path) -> None:
    tables = read_source(write(tmp_path, "participant,lod,rating,weather\nA,low,2,rain\n"))
    assert tables.notes == ("ratings.csv: not analysed: weather.",)
    assert "weather" not in tables.ratings


def test_a_folders_codebook_narrows_what_is_accepted(tmp_path: Path) -> None:
    write(tmp_path, "participant,lod,rating\nA,low,7\nA,lwo,2\n")
    book = codebook({"lod": ["low", "ultra"], "rating": (1, 7)})
    write(tmp_path, json.dumps(book), "codebook.json")
    assert faults_of(tmp_path) == (
        'ratings.csv: row 3, lod: found "lwo"; accepted one of low, ultra',
    )


def test_the_scale_comes_from_the_codebook(tmp_path: Path) -> None:
    write(tmp_path, "participant,lod,rating\nA,low,7\n")
    write(tmp_path, json.dumps(codebook({"rating": (1, 7)})), "codebook.json")
    assert read_source(tmp_path).scale == (1, 7)


@pytest.mark.parametrize("scale", [(5, 1), (3, 3), (0.5, 5.5), (1, 1_000_000)])
def test_a_scale_that_nobody_can_rate_on_is_refused(
    tmp_path: Path, scale: tuple[float, float]
) -> None:
    write(tmp_path, "participant,lod,rating\nA,low,3\n")
    write(tmp_path, json.dumps(codebook({"rating": scale})), "codebook.json")
    assert faults_of(tmp_path) == (
        f"codebook.json: rating: found {scale[0]:g} to {scale[1]:g}; accepted: whole numbers, the "
        "highest 1 to 100 above the lowest",
    )


def test_a_broken_codebook_is_refused(tmp_path: Path) -> None:
    write(tmp_path, "participant,lod,rating\n")
    write(tmp_path, "{", "codebook.json")
    assert faults_of(tmp_path)[0].startswith("codebook.json: not a codebook (")


def test_repeated_rows_count_once(tmp_path: Path) -> None:
    row = "A,t1,left,low,2\n"
    tables = read_source(write(tmp_path, "participant,trial,eye,lod,rating\n" + 3 * row))
    assert len(tables.ratings) == 1
    assert tables.notes == ("ratings.csv: 2 repeated rows were left out.",)


def test_two_answers_to_one_question_are_a_fault(tmp_path: Path) -> None:
    text = "participant,trial,eye,lod,rating\nA,t1,left,low,2\nA,t1,left,low,3\n"
    assert faults_of(write(tmp_path, text)) == (
        "ratings.csv: row 3: a second, different row for participant A, trial t1, eye left; "
        "accepted: one row each",
    )


def test_equal_rows_without_a_trial_count_and_are_told(tmp_path: Path) -> None:
    text = "participant,lod,rating\n" + "A,low,2\nA,high,3\n" * 2
    tables = read_source(write(tmp_path, text))
    assert len(tables.ratings) == 4
    (told,) = tables.notes
    assert told.startswith(
        "ratings.csv: 2 of 4 rows are like an earlier one in every cell. Without"
    )


def test_repeated_presentations_without_a_trial_are_kept(tmp_path: Path) -> None:
    tables = read_source(write(tmp_path, "participant,lod,rating\nA,low,2\nA,low,2\n"))
    assert len(tables.ratings) == 2


def test_simulated_rows_beside_real_ones_are_left_out_and_said() -> None:
    frame = pd.DataFrame(
        {"participant": ["A", "B"], "lod": "low", "rating": [1, 2], "simulated": [True, False]}
    )
    tables = tables_from({"ratings": frame})
    assert tables.ratings["participant"].tolist() == ["B"]
    assert not tables.is_simulated
    assert "1 simulated ratings were left out" in tables.notes[0]


def test_simulated_may_stand_with_the_participants_alone() -> None:
    ratings = pd.DataFrame({"participant": ["A"], "lod": ["low"], "rating": [1]})
    people = pd.DataFrame({"participant": ["A"], "simulated": ["true"]})
    assert tables_from({"ratings": ratings, "participants": people}).is_simulated


def test_a_long_list_of_faults_is_cut_in_the_text_but_kept() -> None:
    frame = pd.DataFrame({"participant": ["A"] * 80, "lod": "low", "rating": range(8, 88)})
    with pytest.raises(TableError, match="and 30 more faults") as caught:
        tables_from({"ratings": frame})
    assert len(caught.value.faults) == 80


def test_typed_frames_give_the_same_as_text(tmp_path: Path) -> None:
    typed = pd.DataFrame(
        {"participant": ["A", "B"], "lod": ["low", "high"], "rating": [2.0, None], "views": [1, 2]}
    )
    path = tmp_path / "ratings.csv"
    typed.to_csv(path, index=False)
    pd.testing.assert_frame_equal(
        tables_from({"ratings": typed}).ratings, read_source(path).ratings
    )


def test_an_iris_wider_than_any_picture_is_refused() -> None:
    frame = pd.DataFrame({"participant": ["A"], "lod": "low", "rating": 2, "iris_px": [1e9]})
    with pytest.raises(TableError, match=r"iris_px: .*; accepted a number from 0 to 7680 or empty"):
        tables_from({"ratings": frame})


def test_a_fault_of_many_rows_is_told_once() -> None:
    frame = pd.DataFrame({"participant": ["A"] * 9, "lod": "low", "rating": [1, 2, *[0] * 7]})
    with pytest.raises(TableError) as caught:
        tables_from({"ratings": frame})
    assert str(caught.value) == (
        'ratings.csv: row 4, rating: found "0"; accepted a whole number from 1 to 5 or empty '
        "(and so in 6 more rows)"
    )
