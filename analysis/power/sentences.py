"""What a simulation of power says, in plain sentences and in one table for the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd

from analysis.power.needed import POWER, Needed, needed_people
from analysis.power.outcome import Outcome
from analysis.wording import number, percent

Row = Mapping[str, Any]


def answer_lines(outcome: Outcome) -> list[str]:
    """Return one sentence per distance, then what the design cannot conclude."""
    found = [_distance(rows) for _, rows in outcome.cheapest.groupby("distance", sort=False)]
    return [*found, *_cannot(outcome.verdicts)]


def needed_for(rows: pd.DataFrame, name: str) -> Needed:
    """Return the people that the share ``name`` takes; ``rows`` are one distance's or LoD's."""
    own = rows.sort_values("participants")
    return needed_people(
        own["participants"].astype(int).tolist(),
        own[name].tolist(),
        low=own[f"{name}_low"].tolist(),
        high=own[f"{name}_high"].tolist(),
    )


def share_text(row: Row, name: str) -> str:
    """Write a share with its bounds: "81 % (77 to 85)"."""
    low, high = (f"{100 * row[f'{name}_{end}']:.0f}" for end in ("low", "high"))
    return f"{percent(row[name])} ({low} to {high})"


def needed_text(needed: Needed) -> str:
    """Say how many people the wanted power takes."""
    aim = percent(needed.power)
    if needed.is_at_most:
        return f"{aim} takes {needed.people} people or fewer"
    if needed.people is None:
        return f"{aim} takes more people than were simulated"
    if needed.low is not None and needed.high is not None:
        return f"{aim} takes about {needed.people} people ({needed.low} to {needed.high})"
    return f"{aim} takes about {needed.people} people"


def _distance(rows: pd.DataFrame) -> str:
    listed = [dict(row) for _, row in rows.sort_values("participants").iterrows()]
    distance, right = listed[0]["distance"], listed[0]["right_lod"]
    if not right:
        return f"{distance}: no decision can be made; fewer than two LoDs are shown there."
    reached = [row for row in listed if row["right"] >= POWER]
    row = reached[0] if reached else listed[-1]
    people, wrong = f"With {row['participants']} people", share_text(row, "too_cheap")
    if row["too_dear"] == 0 and all(other["too_dear"] == 0 for other in listed):
        return (
            f"{distance}: nothing below {right} is enough here. {people}, {wrong} of studies name "
            "a cheaper LoD all the same."
        )
    text = (
        f"{distance}: {people.lower()}, {share_text(row, 'right')} of studies name {right}, the "
        f"cheapest LoD that is enough here; {needed_text(needed_for(rows, 'right'))}."
    )
    if row["too_cheap"] > 0:
        text += f" A cheaper one is named in {wrong}."
    return text


def _cannot(verdicts: pd.DataFrame) -> list[str]:
    rows = verdicts[verdicts["cannot_conclude"] != ""].drop_duplicates(["distance", "lod"])
    found: dict[tuple[str, bool], list[str]] = {}
    for _, row in rows.iterrows():
        is_whole = bool(pd.isna(row["different"]))
        place = f"{row['lod']} at {row['distance']}"
        found.setdefault((str(row["cannot_conclude"]), is_whole), []).append(place)
    return [
        f"Cannot be concluded, however many take part: {'anything' if is_whole else 'equivalence'} "
        f"of {', '.join(places)} ({reason})."
        for (reason, is_whole), places in found.items()
    ]


def table_lines(outcome: Outcome) -> Iterator[str]:
    """Yield the share of right verdicts for each distance, LoD and number of people."""
    people = sorted(set(outcome.verdicts["participants"].astype(int)))
    head = [f"{count} people" for count in people]
    yield _line("distance", "LoD", "assumed", "right verdict", head)
    for _, rows in outcome.verdicts.groupby(["distance", "lod"], sort=False):
        listed = [dict(row) for _, row in rows.sort_values("participants").iterrows()]
        first = listed[0]
        name = str(first["right_verdict"])
        shares = [_cell(row, name) for row in listed]
        yield _line(first["distance"], first["lod"], _assumed(first), name or "(none)", shares)
    yield ""
    yield _line("distance", "cheapest that is enough", "", "named", head)
    for _, rows in outcome.cheapest.groupby("distance", sort=False):
        listed = [dict(row) for _, row in rows.sort_values("participants").iterrows()]
        own = [_cell(row, "right") for row in listed]
        yield _line(listed[0]["distance"], listed[0]["right_lod"] or "-", "", "right", own)


def _cell(row: Row, name: str) -> str:
    """Write the share of the right verdict; of "equivalent" where there is no right one."""
    shown = name or "equivalent"
    return "cannot" if pd.isna(row[shown]) else percent(float(row[shown]))


def _assumed(row: Row) -> str:
    if pd.isna(row["true_loss"]):
        return "not shown"
    seen = "?" if pd.isna(row["true_noticed"]) else percent(row["true_noticed"])
    return f"-{number(row['true_loss'])} points, {seen}"


def _line(distance: str, lod: str, assumed: str, verdict: str, cells: list[str]) -> str:
    start = f"{distance:13}{lod:24}" if not assumed else f"{distance:13}{lod:8}{assumed:20}"
    return (f"{start:41}{verdict:15}" + "".join(f"{cell:>11}" for cell in cells)).rstrip()
