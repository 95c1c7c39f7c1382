"""What a simulation of power says, in plain sentences and in one table for the terminal."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

import pandas as pd

from analysis.power.needed import POWER, Needed, needed_people
from analysis.power.outcome import Outcome
from analysis.wording import listed, number, percent

Row = Mapping[str, Any]


def answer_lines(outcome: Outcome) -> list[str]:
    """Return one sentence per distance, then what the design cannot conclude."""
    rows = outcome.cheapest[outcome.cheapest["best"] != ""]
    found = [_distance(own) for _, own in rows.groupby("distance", sort=False)]
    single = _one_by_one(outcome.verdicts, outcome.ranked)
    return [*found, *single, *_cannot(outcome.verdicts)]


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


def needed_text(needed: Needed, *, short: bool = False) -> str:
    """Say how many people the wanted power takes; ``short`` leaves the power out."""
    start = "" if short else f"{percent(needed.power)} takes "
    if needed.is_at_most:
        return f"{start}{needed.people} people or fewer"
    if needed.people is None:
        return f"{start}more people than were simulated"
    if needed.low is not None and needed.high is not None:
        return f"{start}about {needed.people} people ({needed.low} to {needed.high})"
    return f"{start}about {needed.people} people"


def _distance(rows: pd.DataFrame) -> str:
    own = _records(rows)
    distance, right, reason = (own[0][key] for key in ("distance", "right_lod", "cannot_conclude"))
    if reason:
        return f"{distance}: no LoD can be named as the cheapest that is enough: {reason}."
    stays = [i for i in range(len(own)) if all(row["right"] >= POWER for row in own[i:])]
    row = own[stays[0]] if stays else own[-1]
    wrong = share_text(own[-1] if right == own[-1]["best"] else row, "too_cheap")
    if right == row["best"]:
        return (
            f"{distance}: nothing below {right} is enough here; with {own[-1]['participants']} "
            f"people, {wrong} of studies name a cheaper LoD all the same."
        )
    text = (
        f"{distance}: with {row['participants']} people, {share_text(row, 'right')} of studies "
        f"name {right}, the cheapest LoD that is enough here; "
        f"{needed_text(needed_for(rows, 'right'))}."
    )
    return f"{text} A cheaper one is named in {wrong}." if row["too_cheap"] > 0 else text


def _one_by_one(verdicts: pd.DataFrame, ranked: Collection[str]) -> Iterator[str]:
    """Yield how many people LoDs without a rank take, which are decided on one by one."""
    own = verdicts[~verdicts["lod"].isin(ranked) & (verdicts["cannot_conclude"] == "")]
    for distance, rows in own.groupby("distance", sort=False):
        needed = {
            str(lod): needed_for(each, name)
            for lod, each in rows.groupby("lod", sort=False)
            if (name := str(each["right_verdict"].iloc[0]))
        }
        reached = [f"{lod} {needed_text(n, short=True)}" for lod, n in needed.items() if n.people]
        beyond = [lod for lod, own_needed in needed.items() if own_needed.people is None]
        if beyond:
            reached.append(f"{listed(beyond)} more people than were simulated")
        if needed:
            aim = f"the right verdict in {percent(POWER)} of studies"
            yield f"{distance}: {aim} takes {', '.join(reached)}."


def _cannot(verdicts: pd.DataFrame) -> list[str]:
    rows = verdicts[verdicts["cannot_conclude"] != ""].drop_duplicates(["distance", "lod"])
    found: dict[tuple[str, bool], list[str]] = {}
    for _, row in rows.iterrows():
        is_whole = bool(pd.isna(row["different"]))
        place = f"{row['lod']} at {row['distance']}"
        found.setdefault((str(row["cannot_conclude"]), is_whole), []).append(place)
    return [
        f"Cannot be concluded, however many take part: {'anything' if is_whole else 'equivalence'} "
        f"of {listed(places)} ({reason})."
        for (reason, is_whole), places in found.items()
    ]


def table_lines(outcome: Outcome) -> Iterator[str]:
    """Yield the share of right verdicts for each distance, LoD and number of people."""
    head = [f"{n} people" for n in sorted(set(outcome.verdicts["participants"].astype(int)))]
    lines = [["distance", "LoD", "assumed", "right verdict", *head]]
    for _, rows in outcome.verdicts.groupby(["distance", "lod"], sort=False):
        own = _records(rows)
        name = str(own[0]["right_verdict"])
        start = [own[0]["distance"], own[0]["lod"], _assumed(own[0]), name or "none"]
        lines.append([*start, *(_cell(row, name) for row in own)])
    yield from _aligned(lines)
    rows = outcome.cheapest[outcome.cheapest["best"] != ""]
    if rows.empty:  # no LoD has a place in an order
        return
    yield ""
    lines = [["distance", "cheapest that is enough", *(f"named by {words}" for words in head)]]
    for _, each in rows.groupby("distance", sort=False):
        own = _records(each)
        start = [own[0]["distance"], own[0]["right_lod"] or "–"]
        lines.append([*start, *(_cell(row, "right") for row in own)])
    yield from _aligned(lines, left=2)


def _records(rows: pd.DataFrame) -> list[dict[str, Any]]:
    """Return rows by rising number of people."""
    return [
        {str(k): v for k, v in row.items()}
        for _, row in rows.sort_values("participants").iterrows()
    ]


def _cell(row: Row, name: str) -> str:
    """Write the share of the right verdict; of "equivalent" where there is no right one."""
    shown = name or "equivalent"
    return "cannot" if pd.isna(row[shown]) else percent(float(row[shown]))


def _assumed(row: Row) -> str:
    if pd.isna(row["true_loss"]):
        return "not shown"
    seen = "?" if pd.isna(row["true_noticed"]) else percent(row["true_noticed"])
    return f"{number(-row['true_loss'])} points, {seen}"


def _aligned(lines: list[list[str]], *, left: int = 4) -> Iterator[str]:
    """Yield rows with their columns under each other, the first ones to the left."""
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    for line in lines:
        cells = [
            f"{cell:<{width}}" if i < left else f"{cell:>{width}}"
            for i, (cell, width) in enumerate(zip(line, widths, strict=True))
        ]
        yield "  ".join(cells).rstrip()
