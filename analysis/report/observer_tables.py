"""The report's sections on observers and on their reliability."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

import pandas as pd

from analysis.report.tables import ReportTable
from analysis.screening.flags import FLAGS, typical_slope
from analysis.words.wording import interval, number, people, percent

_MOST: Final = 60
_CLEAR: Final = math.log(1000.0)
_HEAD: Final = (
    *("participant", "flags", "weight", "ratings", "bias", "inconsistency", "slope"),
    *("same rating", "ends", "side", "looking", "false alarms", "certified"),
    "BT.500 would reject",
)


def observers_table(
    signals: pd.DataFrame,
    flags: Mapping[str, Sequence[str]],
    weights: Mapping[str, float],
) -> ReportTable:
    """Return what each person's answers show, flagged people first."""
    order = sorted(signals.index, key=lambda i: str(signals["participant"][i]) not in flags)
    records: list[dict[str, Any]] = [dict(signals.loc[i]) for i in order[:_MOST]]
    rows = tuple(_person(row, flags, weights) for row in records)
    note = (
        "Bias and inconsistency (points): ITU-T P.910 Annex E by alternating projection. Slope: of "
        "the person's ratings on the others' means; here a typical one is "
        f"{number(typical_slope(signals))}, 0 has nothing to do with what was shown, a negative "
        "one turns the scale round. Side: share of comparisons that name one side. Looking: how "
        "many times likelier the answers are from someone who looked than from someone who did "
        "not. False alarms: "
        "yes to pairs of equal LoDs. Certified: presentations that passed the study's rule. BT.500 "
        "would reject: ITU-R BT.500 A1-2.3.1; too strict for few ratings, shown only. Nobody was "
        "excluded: flags and great inconsistency lower a person's weight in the models."
    )
    if len(signals) > _MOST:
        note += f" The first {_MOST} of {len(signals)}; all stand in observer-signals.csv."
    return ReportTable("What each person's answers show.", _HEAD, rows, text_columns=2, note=note)


def flag_sentences(flags: Mapping[str, Sequence[str]], count: int) -> list[str]:
    """Say who is flagged for what."""
    if not flags:
        return [f"Nobody of {count} was flagged." if count > 1 else "Nobody was flagged."]
    text = []
    for flag in FLAGS:
        named = [who for who, own in flags.items() if flag.name in own]
        if named:
            known = ", ".join(named[:12]) + (" and others" if len(named) > 12 else "")
            text.append(f"{flag.name} ({flag.meaning}), {people(len(named))}: {known}.")
    return text


def sensitivity_table(sensitivity: pd.DataFrame) -> ReportTable:
    """Return each verdict with and without flagged people; a changed one is marked."""
    cells = list(dict.fromkeys(zip(sensitivity["distance"], sensitivity["lod"], strict=True)))
    rows = []
    for (who, flags), own in sensitivity.groupby(["people", "flags"], sort=False):
        by_cell = own.set_index(["distance", "lod"])
        verdicts = []
        for cell in cells:
            row: Any = by_cell.loc[cell]
            verdicts.append((row["verdict"] or "nothing left") + (" *" if row["is_moved"] else ""))
        rows.append((f"{who} ({flags})" if flags else str(who), *verdicts))
    moved = int(sensitivity["is_moved"].sum())
    note = "* Differs from the first row." if moved else "No verdict hangs on a flagged person."
    return ReportTable(
        "Verdicts with and without flagged people.",
        ("counted", *(f"{distance}: {lod}" for distance, lod in cells)),
        tuple(rows),
        text_columns=1 + len(cells),
        note=note,
    )


def reliability_table(found: pd.DataFrame) -> ReportTable:
    """Return the coefficients of agreement with their intervals."""
    rows = tuple(
        (
            str(row["coefficient"]),
            str(row["bias"]),
            number(row["value"]),
            interval(row["low"], row["high"]),
            str(row["interval"]),
            f"{row['people']}",
            f"{row['stimuli']}",
        )
        for row in (dict(own) for _, own in found.iterrows())
        if pd.notna(row["value"])
    )
    note = (
        "A stimulus is one eye as it was shown. ICC (two-way random, absolute agreement) rests on "
        "the people who rated every stimulus: (2,1) of one person, (2,k) of their mean. "
        "Krippendorff's alpha takes everyone; its interval generalises to other people or to other "
        "stimuli. Leniency lowers agreement although it spoils no comparison of LoDs, so each "
        "stands again with each person's bias removed."
    )
    head = ("coefficient", "ratings", "value", "95 % CI", "its interval", "people", "stimuli")
    return ReportTable("How well people agree.", head, rows, text_columns=2, note=note)


def _person(
    row: Mapping[str, Any], flags: Mapping[str, Sequence[str]], weights: Mapping[str, float]
) -> tuple[str, ...]:
    who = str(row["participant"])
    side = f"{row['side']} {percent(row['side_share'])}" if row["compared"] else "–"
    alarms = f"{percent(row['false_alarms'])} of {row['catch_pairs']}"
    return (
        who,
        ", ".join(flags.get(who, ())) or "–",
        number(weights.get(who, 1.0)),
        f"{row['ratings']}",
        number(row["bias"]),
        number(row["inconsistency"]),
        number(row["slope"]),
        percent(row["same_share"]),
        percent(row["ends_share"]),
        side,
        _looking(row["looking"]),
        alarms if row["catch_pairs"] else "–",
        percent(row["certified_share"]),
        "yes" if row["bt500"] else "no",
    )


def _looking(log_odds: float) -> str:
    """Write odds for a reader: as "12 : 1", beyond a thousand only that."""
    if pd.isna(log_odds):
        return "–"
    if abs(log_odds) > _CLEAR:
        return "> 1000 : 1" if log_odds > 0 else "< 1 : 1000"
    odds = math.exp(abs(log_odds))
    return f"{odds:.0f} : 1" if log_odds > 0 else f"1 : {odds:.0f}"
