"""What these data cannot say, in sentences: printed as prominently as the answer.

It follows from the verdicts, the design and the number of people; knows no models of its own.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import pandas as pd

from analysis.audit import Audit
from analysis.decision.effects import EffectVerdict
from analysis.decision.margins import DECLARED, Margins
from analysis.decision.verdicts import EQUIVALENT, NOT_SHOWN, Verdict
from analysis.descriptive.means import answered, differences_from_best
from analysis.inference.inferring import Inference
from analysis.tables.reading import Tables
from analysis.words.wording import listed, number, percent, place

# ITU-R BT.500-15 (2023) asks for at least 15 observers.
_ENOUGH_PEOPLE: Final = 15


def limits(tables: Tables, audit: Audit, inference: Inference) -> list[str]:
    """Return every limit of verdicts, design and data that a reader of the answer must know."""
    if answered(tables.ratings).empty:
        asked = int((~tables.ratings["is_practice"]).sum())
        reason = "All ratings are missing" if asked else "There are no ratings yet"
        return [f"{reason}, so nothing can be said about realism.", *audit.limits()]
    text = []
    if tables.is_simulated:
        text.append(
            "The answers come from simulated observers. They demonstrate the instrument and say "
            "nothing about eyes or people."
        )
    text += _about_verdicts(inference)
    text += _about_people(tables)
    if tables.ratings["other_lod"].notna().any():
        text.append(
            "Each eye was rated beside another one. Side by side, differences look larger than "
            "they would in use, where both eyes have the same LoD."
        )
    if tables.comparisons.empty:
        text.append(
            "There is no table of comparisons, so preferences and noticed differences are unknown."
        )
    return [*text, *audit.limits()]


def _about_verdicts(inference: Inference) -> list[str]:
    """Say which LoDs are open and why, and what the word equivalent covers."""
    ranked = [verdict for decision in inference.decisions for verdict in decision.verdicts]
    verdicts: list[Verdict | EffectVerdict] = [*ranked, *inference.effects]
    if not verdicts:
        return [
            "There is no verdict on any LoD: nowhere did two people or more rate the highest LoD "
            "and a lower one, with ranks that say which is which (the names low, medium, high and "
            "ultra, or a column lod_rank)."
        ]
    text = [
        *_open(verdicts),
        *_unmeasured(verdicts),
        *_margins(inference.margins, any(v.outcome == EQUIVALENT for v in verdicts)),
    ]
    text.append(
        "Every verdict is against the highest LoD shown; whether that one looks real is not "
        "decided here, only rated."
    )
    return text


def _open(verdicts: Iterable[Verdict | EffectVerdict]) -> list[str]:
    """Name what is neither shown to be enough nor shown not to be, tested or not."""
    unsure = [v for v in verdicts if v.outcome == NOT_SHOWN]
    text = []
    if tested := [v for v in unsure if v.is_reached]:
        text.append(
            f"Open, neither shown to be enough nor shown not to be: {_named(tested)}. That no "
            "difference was found there is no proof that there is none; more people may tell."
        )
    if untested := [v for v in unsure if not v.is_reached]:
        text.append(
            f"Not tested, because a higher LoD had failed before: {_named(untested)}. Nothing may "
            "be concluded about these."
        )
    return text


def _unmeasured(verdicts: Iterable[Verdict | EffectVerdict]) -> list[str]:
    unknown = [v for v in verdicts if v.noticed is None]
    if not unknown:
        return []
    return [
        "Whether it is noticed beyond false alarms was not measured, without which no LoD is "
        f"called equivalent: {_named(unknown)}. It takes that pair and pairs of equal LoDs. In "
        "the shares of draws in which a LoD is the cheapest, these go by their ratings alone."
    ]


def _margins(margins: Margins, has_equals: bool) -> list[str]:
    text = []
    stated = f"{number(margins.realism_points)} points, {percent(margins.noticed_share)} of people"
    if margins.origins != DECLARED:
        text.append(
            f"The margins ({stated}) were not all declared before there were data "
            f"({margins.origins}). Whoever has seen the answers can choose margins that fit them, "
            "so take the verdicts as exploratory."
        )
    if has_equals:
        text.append(
            f"Equivalent means within the margins ({stated}) for people, clips and screens like "
            "these; smaller losses are not excluded, and no two LoDs are shown to be the same."
        )
    return text


def _named(verdicts: Iterable[Verdict | EffectVerdict]) -> str:
    """Name LoDs by distance: "high at macroscopic; medium and low at far"."""
    by_distance: dict[str, list[str]] = {}
    own = list(verdicts)
    lods = {verdict.lod for verdict in own}
    for verdict in own:
        by_distance.setdefault(place(verdict.distance, lods), []).append(verdict.lod)
    return "; ".join(f"{listed(lods)} at {where}" for where, lods in by_distance.items())


def _about_people(tables: Tables) -> list[str]:
    people = answered(tables.ratings)["participant"].nunique()
    if people == 1:
        return ["One person took part: this describes that person, and nobody else."]
    gaps = differences_from_best(tables.ratings)
    width = ((gaps["high"] - gaps["low"]) / 2).median()
    text = f"{people} people took part"
    if people < _ENOUGH_PEOPLE:
        text += f", fewer than the {_ENOUGH_PEOPLE} that ITU-R BT.500 asks for"
    if pd.notna(width):
        text += (
            f"; differences between LoDs are known to about ± {number(float(width), digits=1)} "
            "points, and smaller ones stay hidden"
        )
    return [
        f"{text}.",
        "Apart from the verdicts of one distance, intervals and shares stand each for itself; none "
        "is adjusted for how many are looked at.",
    ]
