"""CSV files as spreadsheets and programs write them: the same ratings come out of every one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from analysis.tables.parsing import TableError
from analysis.tables.reading import Tables, read_source

HEADER = ["participant", "lod", "rating", "iris_px", "comment"]
ROWS = [
    ["anna", "low", "2", "12.5", 'a "soft" eye'],
    ["anna", "ultra", "5", "40", "first line\nsecond line"],
    ["ben", "low", "", "12.5", "ab; c, d"],
    ["ben", "ultra", "4", "", "é"],
]


def quoted(cell: str, separator: str) -> str:
    needs = any(sign in cell for sign in (separator, '"', "\n"))
    return '"' + cell.replace('"', '""') + '"' if needs else cell


def csv_of(separator: str = ",", *, end: str = "\n", comma: bool = False) -> str:
    lines = [
        separator.join(
            quoted(c.replace(".", ",") if comma and c == "12.5" else c, separator) for c in row
        )
        for row in [HEADER, *ROWS]
    ]
    return end.join(lines) + end


def read(tmp_path: Path, content: bytes) -> Tables:
    path = tmp_path / "mine.csv"
    path.write_bytes(content)
    return read_source(path)


@pytest.mark.parametrize(
    "content",
    [
        csv_of().encode(),
        csv_of().encode("utf-8-sig"),
        csv_of(end="\r\n").encode(),
        csv_of(";").encode(),
        csv_of(";", comma=True).encode("utf-8-sig"),
        csv_of("\t", comma=True, end="\r\n").encode("utf-16"),  # Excel's "Unicode text"
        csv_of("\t").encode("utf-16-be").join([b"\xfe\xff", b""]),
        ("sep=;\r\n" + csv_of(";", comma=True, end="\r\n")).encode("utf-8-sig"),
        ("\n ,\n\n" + csv_of()).encode(),
        (csv_of() + ",,,,\n\n,,,,\n").encode(),  # rows that were cleared, not deleted
        csv_of().replace("\n", ",\n").replace("first line,", "first line").encode(),
        csv_of().rstrip("\n").encode(),
        csv_of().replace("participant,lod", "Participant , LOD").encode(),
        csv_of().replace("low,,", "low,NA,").encode(),  # as R writes what is missing
    ],
    ids=[
        *("plain", "bom", "windows", "semicolon", "german", "excel-unicode", "utf16-be", "sep"),
        *("blank-first", "blank-rows", "trailing-separator", "no-last-end", "capitals", "NA"),
    ],
)
def test_the_same_ratings_come_out(tmp_path: Path, content: bytes) -> None:
    ratings = read(tmp_path, content).ratings
    assert ratings["participant"].tolist() == ["anna", "anna", "ben", "ben"]
    assert ratings["lod"].tolist() == ["low", "ultra"] * 2
    assert ratings["rating"].fillna(0).tolist() == [2, 5, 0, 4]
    assert ratings["iris_px"].fillna(0).tolist() == [12.5, 40, 12.5, 0]


def test_what_was_read_otherwise_than_it_stands_is_said(tmp_path: Path) -> None:
    content = "Participant,LOD,rating,Other LoD,colour\na,low,NA,ultra,blue\na,low,NA,NA,blue\n"
    assert read(tmp_path, content.encode()).notes == (
        'mine.csv: column "Participant" was read as participant.',
        'mine.csv: column "LOD" was read as lod.',
        'mine.csv: column "Other LoD" was read as other_lod.',
        'mine.csv: "NA" in 3 cells was read as missing.',
        "mine.csv: not analysed: colour.",
    )


def test_columns_may_stand_in_any_order_with_others_between(tmp_path: Path) -> None:
    content = b"note,rating,x,lod,participant\n,3,1,low,a\n,4,2,high,b\n"
    ratings = read(tmp_path, content).ratings
    assert ratings["rating"].tolist() == [3, 4]
    assert ratings["participant"].tolist() == ["a", "b"]


TWICE = "participant,lod,rating\n"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (TWICE + "a,low,3\nb,low\n", "row 3: found 2 cells; accepted 3, as many as the header has"),
        (TWICE + "a,low,3,4\n", "row 2: found 4 cells; accepted 3"),
        (
            TWICE + 'a,low,3\n"b,low,3\nc,low,2\n',
            "row 3: unexpected end of data; accepted: a quote",
        ),
        (TWICE + "a,low,6\n", 'row 2, rating: found "6"; accepted a whole number from 1 to 5'),
        (TWICE + 'a,low,"3,5"\n', 'row 2, rating: found "3,5"; accepted a whole number'),
        (TWICE.replace(",", ";") + "a;low;3,5\n", 'row 2, rating: found "3,5"; accepted a whole'),
        (TWICE + ",low,3\n", 'row 2, participant: found ""; accepted some text'),
        ("participant,lod,score\na,low,3\n", 'row 1: column "rating" is missing; found'),
        ("", "row 1: column"),
        ("\n\n" + TWICE + "a,low,6\n", 'row 4, rating: found "6"'),
        (TWICE + "a,l\0w,3\n", "row 2: byte 0x00 is not text; accepted: CSV text in UTF-8, or in"),
        (
            "PK\x03\x04" + TWICE,
            "a spreadsheet's own file; accepted: CSV text (in a spreadsheet, sa",
        ),
        ("participant,lod,rating,rating\na,low,3,4\n", 'row 1: column "rating" occurs 2 times'),
    ],
)
def test_faults_name_row_column_and_what_is_accepted(tmp_path: Path, text: str, told: str) -> None:
    with pytest.raises(TableError) as caught:
        read(tmp_path, text.encode())
    assert f"mine.csv: {told}" in str(caught.value)


def test_all_faults_come_at_once_and_the_first_fifty_are_shown(tmp_path: Path) -> None:
    wrong = "".join(f"p{i},low,{i + 6}\n" for i in range(80))
    with pytest.raises(TableError) as caught:
        read(tmp_path, (TWICE + wrong + "a\n").encode())
    assert len(caught.value.faults) == 81
    assert str(caught.value).endswith("and 31 more faults")


@pytest.mark.parametrize("damage", [lambda b: b[:-1], lambda b: b[:2] + b"\x00\xd8" + b[2:]])
def test_broken_utf16_is_refused(tmp_path: Path, damage: Callable[[bytes], bytes]) -> None:
    with pytest.raises(TableError, match=r"mine\.csv: row \d+: byte 0x\w+ is not UTF-16; accepted"):
        read(tmp_path, damage(csv_of().encode("utf-16")))
