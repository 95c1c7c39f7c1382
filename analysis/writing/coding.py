"""What people wrote, coded by the code book's rules or by hand, and how many people mention what.

A person counts once per pair of LoDs, however often they mention a thing and see the pair.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import pandas as pd

from analysis.descriptive.shares import paired, wilson
from analysis.tables.ordering import in_order
from analysis.tables.parsing import TableError
from analysis.writing.code_book import CODE_NAMES, codes_in

ManualCodes = Mapping[tuple[str, str], frozenset[str]]
BY_RULE, BY_HAND = "rule", "hand"
ALL: Final = "all"
_NEEDED: Final = ("participant", "trial", "codes")
_REMARK: Final = ("participant", "trial", "clip", "distance", "left_lod", "right_lod")
_TEXTS: Final = ("what_differed", "comments")


def read_codes(path: str | Path) -> dict[tuple[str, str], frozenset[str]]:
    """Read codes given by hand: a CSV file with participant, trial and codes apart by semicolons.

    Other columns are passed over, so remark-codes.csv of a report can be corrected and given back;
    no codes mean that nothing was mentioned. Raises TableError with every fault.
    """
    where = Path(path)
    try:
        text = where.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise TableError([f"{where}: not found; accepted: a CSV file of codes"]) from None
    except UnicodeDecodeError as error:
        raise TableError(
            [f"{where.name}: byte {error.start} is not UTF-8; accepted: CSV text in UTF-8"]
        ) from None
    rows = csv.DictReader(io.StringIO(text))
    missing = [name for name in _NEEDED if name not in (rows.fieldnames or ())]
    if missing:
        found = ", ".join(rows.fieldnames or ()) or "no columns"
        raise TableError(
            [f'{where.name}: row 1: column "{name}" is missing; found {found}' for name in missing]
        )
    faults: list[str] = []
    codes: dict[tuple[str, str], frozenset[str]] = {}
    for row, cells in enumerate(rows, start=2):
        named = [name.strip() for name in (cells["codes"] or "").split(";") if name.strip()]
        faults += [
            f'{where.name}: row {row}: codes: found "{name}"; accepted: {", ".join(CODE_NAMES)}'
            for name in named
            if name not in CODE_NAMES
        ]
        key = (cells["participant"] or "", cells["trial"] or "")
        if key in codes:
            faults.append(f"{where.name}: row {row}: {' '.join(key)} occurs twice; accepted: once")
        codes[key] = frozenset(named)
    if faults:
        raise TableError(faults)
    return codes


def code_remarks(comparisons: pd.DataFrame, manual: ManualCodes | None = None) -> pd.DataFrame:
    """Return every remark with its codes.

    Columns: participant, trial, clip, distance, left_lod, right_lod, what_differed, comments,
    codes (names apart by semicolons), coded_by (rule or hand).
    """
    given = manual or {}
    rows = comparisons[~comparisons["is_practice"]].dropna(subset=list(_TEXTS), how="all")
    rows = rows[[*_REMARK, *_TEXTS]].reset_index(drop=True)
    codes, by = [], []
    for who, trial, *texts in rows[["participant", "trial", *_TEXTS]].itertuples(
        index=False, name=None
    ):
        key = (str(who), "" if pd.isna(trial) else str(trial))
        text = "\n".join(str(part) for part in texts if pd.notna(part))
        own = [name for name in CODE_NAMES if name in given[key]] if key in given else None
        codes.append(";".join(codes_in(text) if own is None else own))
        by.append(BY_RULE if own is None else BY_HAND)
    return rows.assign(codes=pd.Series(codes, dtype="string"), coded_by=by)


def unused_codes(comparisons: pd.DataFrame, manual: ManualCodes) -> list[str]:
    """Say in sentences which codes given by hand belong to no remark."""
    remarks = code_remarks(comparisons)
    known = set(zip(remarks["participant"].astype(str), remarks["trial"].astype(str), strict=True))
    lost = sorted(" ".join(key) for key in manual if key not in known)
    if not lost:
        return []
    return [f"Codes given by hand for remarks that are not there, not used: {', '.join(lost)}."]


def mentions(comparisons: pd.DataFrame, manual: ManualCodes | None = None) -> pd.DataFrame:
    """Return who, shown which pair, mentioned what.

    One row per person, distance and pair: distance, lesser, greater, participant, and one column
    of booleans per code. People who wrote nothing are there, with nothing mentioned.
    """
    shown = paired(comparisons[~comparisons["is_practice"]], with_equal=True)
    coded = code_remarks(comparisons, manual)
    keys = [*_REMARK]
    said = coded.groupby(keys, dropna=False, sort=False)["codes"].agg(";".join).reset_index()
    rows = shown.merge(said, on=keys, how="left")
    own = [set(str(codes).split(";")) if pd.notna(codes) else set() for codes in rows["codes"]]
    flags = {name: [name in codes for codes in own] for name in CODE_NAMES}
    by = ["distance", "lesser", "greater", "participant"]
    table = rows[by].reset_index(drop=True).assign(**flags)
    found = table.groupby(by, sort=False, observed=True)[list(CODE_NAMES)].any().reset_index()
    return found.reindex(columns=[*by, *CODE_NAMES])


def mention_rates(comparisons: pd.DataFrame, manual: ManualCodes | None = None) -> pd.DataFrame:
    """Return how many of the people who were shown a pair mention each thing, and over all pairs.

    Columns: distance, lesser, greater ("all" in the rows over everything shown), code, count,
    people, share, low, high (Wilson's 95 %).
    """
    table = mentions(comparisons, manual)
    names = list(CODE_NAMES)
    parts = [
        (key, group) for key, group in table.groupby(["distance", "lesser", "greater"], sort=False)
    ]
    rows = []
    for key, group in parts:
        rows += _rates((str(key[0]), str(key[1]), str(key[2])), group)
    columns = ["distance", "lesser", "greater", "code", "count", "people", "share", "low", "high"]
    by_pair = in_order(pd.DataFrame(rows, columns=columns), comparisons)
    anyone = table.groupby("participant", sort=False)[names].any()
    if anyone.empty:
        return by_pair
    overall = pd.DataFrame(_rates((ALL, ALL, ALL), anyone), columns=columns)
    return pd.concat([by_pair, overall], ignore_index=True)


def _rates(key: tuple[str, str, str], people: pd.DataFrame) -> list[tuple[object, ...]]:
    total = len(people)
    rows: list[tuple[object, ...]] = []
    for name in CODE_NAMES:
        count = int(people[name].sum())
        rows.append((*key, name, count, total, count / total, *wilson(count, total)))
    return rows
