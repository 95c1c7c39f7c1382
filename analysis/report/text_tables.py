"""The report's tables of what people wrote and of the thesis's claims."""

from __future__ import annotations

from typing import Final

import pandas as pd

from analysis.report.tables import ReportTable
from analysis.words.wording import counted, percent
from analysis.writing.code_book import CODES
from analysis.writing.coding import ALL, BY_HAND

_RARE: Final = 2  # mentions by fewer people fill the table and say nothing; the CSV has them


def mentions_table(rates: pd.DataFrame) -> ReportTable:
    """Return, over everything shown and per pair, which share of people mentions what."""
    meaning = {code.name: code.meaning for code in CODES}
    overall = rates[rates["distance"] == ALL]
    often = rates[(rates["distance"] != ALL) & (rates["count"] >= _RARE)]
    rows = []
    for row in (dict(own) for _, own in pd.concat([overall, often]).iterrows()):
        is_all = row["distance"] == ALL
        where = (
            ("everything shown", "all")
            if is_all
            else (str(row["distance"]), f"{row['lesser']} – {row['greater']}")
        )
        said = f"{row['code']}: {meaning[row['code']]}" if is_all else str(row["code"])
        known = f"{percent(row['low'])} to {percent(row['high'])}"
        rows.append(
            (*where, said, f"{row['count']}", f"{row['people']}", percent(row["share"]), known)
        )
    return ReportTable(
        "Who mentions what, of the people who were shown the pair (95 % Wilson intervals).",
        ("distance", "LoDs", "mentioned", "by", "of people", "share", "95 % CI"),
        tuple(rows),
        text_columns=3,
        note="A mention says what was spoken of, not whether it was there or missed. Pairs are "
        f"listed where at least {_RARE} people mention the thing; all stand in mention-rates.csv.",
    )


def text_sentences(remarks: pd.DataFrame) -> list[str]:
    """Say how much was written and how it was coded."""
    if remarks.empty:
        return ["Nobody wrote anything, or nobody was asked to."]
    by_hand = int((remarks["coded_by"] == BY_HAND).sum())
    without = int((remarks["codes"] == "").sum())
    nothing = f"{without} of them say" if without else "None says"
    return [
        f"{counted(len(remarks), 'remark', 'remarks')} by "
        f"{counted(remarks['participant'].nunique(), 'person', 'people')}, coded by words of the "
        f"code book in English and Arabic, {by_hand or 'none'} of them by hand. {nothing} nothing "
        "that the book knows.",
        "remark-codes.csv holds every remark with its codes: correct its column codes and give it "
        "back (ocularist analyse --codes) to replace the rules by a reader's judgement.",
    ]


def claims_report(claims: pd.DataFrame) -> ReportTable:
    """Return the thesis's findings beside ours."""
    rows = tuple(
        (row["claim"], f"{row['thesis']} ({row['section']})", row["found"])
        for row in (dict(own) for _, own in claims.iterrows())
    )
    return ReportTable(
        "Findings of the thesis (10 people, 7 clips) and the same quantities here.",
        ("claim", "the thesis (section)", "these data, with 95 % interval"),
        tuple(tuple(map(str, row)) for row in rows),
        text_columns=3,
        is_prose=True,
        note="What the thesis said in words stands in words: the bar heights of its Figure 5.2 are "
        "unknown. Not asked here: this study showed no such clip, or asked no such question.",
    )
