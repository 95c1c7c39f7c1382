"""What a simulation of power says, in plain sentences."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

import pandas as pd

from analysis.power.needed import POWER, Needed, needed_people
from analysis.power.outcome import Outcome
from analysis.power.replicates import Scene
from analysis.power.text_table import Row, by_people
from analysis.tables.records import records
from analysis.words.wording import listed, percent


def opening_lines(scene: Scene, outcome: Outcome, study: str) -> list[str]:
    """Return what was simulated, what the verdicts mean, and how to read the table."""
    margins = scene.margins
    sentences = [
        f"{study}: {outcome.replicates} simulated studies of each number of people, who see what "
        f'"{scene.truth.name}" assumes.',
        f"Equivalent: shown, with {percent(margins.confidence)} confidence in each, to be rated at "
        f"most {margins.realism_points:g} points below the best LoD and to be noticed beside it by "
        f"at most {percent(margins.noticed_share)} of people beyond false alarms.",
        "The table: how far below the best LoD each is assumed to be and who notices it beyond "
        "false alarms (? where it never stands beside the best), the verdict that is right then "
        "(– where none is), and how many studies come to it.",
    ]
    own = outcome.verdicts[~outcome.verdicts["lod"].isin(outcome.ranked)]
    alike = own.groupby("distance")[["true_loss", "true_noticed"]].nunique().max().max()
    if own["lod"].nunique() > 1 and alike <= 1:
        sentences.append(
            f"All {own['lod'].nunique()} LoDs without a rank are assumed to be alike at a "
            "distance; a file for --truth can tell them apart."
        )
    return sentences


def answer_lines(outcome: Outcome) -> list[str]:
    """Return one sentence per distance, then what the design cannot conclude."""
    rows = outcome.cheapest[outcome.cheapest["best"] != ""]
    barred = rows["cannot_conclude"] != ""
    found = [_distance(own) for _, own in rows[~barred].groupby("distance", sort=False)]
    for reason, own in rows[barred].groupby("cannot_conclude", sort=False):
        where = listed(list(dict.fromkeys(own["distance"])))
        found.append(f"{where}: no LoD can be named as the cheapest that is enough: {reason}.")
    single = _one_by_one(outcome.verdicts, outcome.ranked)
    return [*found, *single, *_cannot(outcome.verdicts)]


def takes_more(outcome: Outcome) -> bool:
    """Say whether some LoD that could be named takes more people than were simulated."""
    rows = outcome.cheapest[outcome.cheapest["right"].notna()]
    rows = rows[rows["right_lod"] != rows["best"]]
    every = [needed_for(own, "right") for _, own in rows.groupby("distance", sort=False)]
    return any(needed.people is None for needed in every)


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
        return f"{start}more than {needed.most} people"
    if needed.low is not None and needed.high is not None:
        return f"{start}about {needed.people} people ({needed.low} to {needed.high})"
    return f"{start}about {needed.people} people"


def _distance(rows: pd.DataFrame) -> str:
    own = by_people(rows)
    distance, right = own[0]["distance"], own[0]["right_lod"]
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
        if needed:
            aim = f"the right verdict in {percent(POWER)} of studies"
            yield f"{distance}: {aim} takes {', '.join(_needs(needed))}."


def _needs(needed: Mapping[str, Needed]) -> list[str]:
    """Say what each LoD takes, those together that take more than was simulated."""
    told = [
        f"{needed_text(own, short=True)} for {lod}" for lod, own in needed.items() if own.people
    ]
    beyond = [lod for lod, own in needed.items() if own.people is None]
    if beyond:
        every = len(beyond) == len(needed) > 2
        whom = f"each of the {len(beyond)} LoDs" if every else listed(beyond)
        told.append(f"{needed_text(needed[beyond[0]], short=True)} for {whom}")
    return told


def _cannot(verdicts: pd.DataFrame) -> Iterator[str]:
    """Yield what more people do not help: first what nobody sees, then what is not comparable."""
    rows = verdicts[verdicts["cannot_conclude"] != ""].drop_duplicates(["distance", "lod"])
    is_unseen = rows["true_loss"].isna()
    unseen = [f"{row['lod']} at {row['distance']}" for row in records(rows[is_unseen])]
    if unseen:
        yield f"Nothing can be concluded of {listed(unseen)}, which nobody sees."
    found: dict[tuple[str, bool], list[str]] = {}
    for row in records(rows[~is_unseen]):
        place = f"{row['lod']} at {row['distance']}"
        is_whole = bool(pd.isna(row["different"]))
        found.setdefault((str(row["cannot_conclude"]), is_whole), []).append(place)
    for (reason, is_whole), places in found.items():
        what = "anything" if is_whole else "equivalence"
        yield (
            f"Cannot be concluded, however many take part: {what} of {listed(places)} ({reason})."
        )
