"""What these data cannot say, in sentences: printed as prominently as the answer."""

from __future__ import annotations

import pandas as pd

from analysis.audit import Audit
from analysis.descriptive import answered, differences_from_best
from analysis.reading import Tables
from analysis.wording import number


def limits(tables: Tables, audit: Audit) -> list[str]:
    """Return every limit of design and data that a reader of the answer must know."""
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
    text += _about_people(tables)
    text.append(
        "No LoD is shown to be equal to another. That needs a margin declared before the data were "
        'seen; "not shown to be rated lower" is not "equal".'
    )
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


def _about_people(tables: Tables) -> list[str]:
    people = answered(tables.ratings)["participant"].nunique()
    if people == 1:
        return ["One person took part: this describes that person, and nobody else."]
    gaps = differences_from_best(tables.ratings)
    width = ((gaps["high"] - gaps["low"]) / 2).median()
    text = f"{people} people took part"
    if pd.notna(width):
        text += (
            f"; differences between LoDs are known to about ± {number(float(width), digits=1)} "
            "points, and smaller ones stay hidden"
        )
    return [
        f"{text}.",
        "Intervals and shares stand each for itself; none is adjusted for how many are looked at.",
    ]
