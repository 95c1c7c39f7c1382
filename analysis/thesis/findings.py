"""What the thesis found, as a table: claim, its words, its section, and our measure of the same.

What it gives only in words stands here in words: the bar heights of its Figure 5.2 are unknown, and
no number of them is used but the one in its text (low at far, 2.5).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import pandas as pd

from analysis.tables.reading import Tables
from analysis.thesis.measures import (
    Found,
    Pairs,
    apart,
    ends_of_scale,
    follows,
    gap_of_distances,
    gap_of_lods,
    mean_at,
    mentioned,
    noticed,
)

_STEP: Final = (("high", "ultra"),)


@dataclass(frozen=True)
class Evidence:
    """The tables, and the table of who mentioned what (``coding.mentions``)."""

    tables: Tables
    said: pd.DataFrame


@dataclass(frozen=True)
class Claim:
    """One finding: what is claimed, what the thesis said, in which section, and our measure."""

    claim: str
    thesis: str
    section: str
    measure: Callable[[Evidence], Found]


def _refracted(e: Evidence) -> Pairs:
    """Return the pairs of which one eye alone is refracted (levels: the thesis's Table 5.1)."""
    return apart(e.tables, "refraction", ("high", "ultra"))


def _reflected(e: Evidence) -> Pairs:
    return apart(e.tables, "reflection", ("medium", "high", "ultra"))


def _dynamic(e: Evidence) -> Pairs:
    return apart(e.tables, "reflection", ("ultra",))


def _beyond_macroscopic(e: Evidence, code: str, pairs: Pairs) -> Found:
    found = mentioned(e.said[e.said["distance"] != "macroscopic"], code, pairs)
    return replace(found, text=found.text.replace("mention it", "mention it beyond macroscopic"))


CLAIMS: Final = (
    Claim(
        "Ratings rise with the LoD",
        "perceived and actual LoD are proportionate",
        "5.2.1",
        lambda e: follows(e.tables),
    ),
    Claim(
        "They follow the LoD up close",
        "relatively proportionate at closer distances",
        "5.2.1",
        lambda e: follows(e.tables, "macroscopic"),
    ),
    Claim(
        "They follow it less from afar",
        "less accurate as the camera's distance grows",
        "5.2.1",
        lambda e: follows(e.tables, "far"),
    ),
    Claim(
        "Low at far is rated 2.5",
        "mean 2.5",
        "5.2.1",
        lambda e: mean_at(e.tables, "far", "low"),
    ),
    Claim(
        "Low is rated highest at far",
        "much higher than other ratings of low",
        "5.2.1",
        lambda e: gap_of_distances(e.tables, "low", "far", ("macroscopic", "near", "medium")),
    ),
    Claim(
        "Medium looks like high at macroscopic",
        "perceived resemblance; no number",
        "5.2.1",
        lambda e: gap_of_lods(e.tables, "macroscopic", "high", "medium"),
    ),
    Claim(
        "Ultra at near is no better than medium there",
        "neither ultra eye (clips 4 and 6) was rated higher; no number",
        "6.2",
        lambda e: gap_of_lods(e.tables, "near", "ultra", "medium"),
    ),
    Claim(
        "Ultra at near is no better than high there",
        "not shown: clips 4 to 6 have no high",
        "6.2",
        lambda e: gap_of_lods(e.tables, "near", "ultra", "high"),
    ),
    Claim(
        "Ultra is rated lower at near than at macroscopic",
        "photo-realistic at macroscopic distances only",
        "6.2",
        lambda e: gap_of_distances(e.tables, "ultra", "near", ("macroscopic",)),
    ),
    Claim(
        "Hardly anything is perfect",
        "6 of 140 ratings were 5, 3 of them by one person",
        "6.2",
        lambda e: ends_of_scale(e.tables, e.tables.scale[1]),
    ),
    Claim(
        "People avoid an end of the scale",
        "suspected of the highest, after Friedman and Amoo; the lowest is not told",
        "6.2",
        lambda e: ends_of_scale(e.tables, e.tables.scale[0]),
    ),
    Claim(
        "Reflection is what people speak of most",
        "8 of 10: even simple reflection adds volume",
        "5.3",
        lambda e: mentioned(e.said, "reflection", _reflected(e)),
    ),
    Claim(
        "Few notice that reflections move",
        "2 of 10, both colleagues",
        "5.3",
        lambda e: mentioned(e.said, "dynamic reflection", _dynamic(e)),
    ),
    Claim(
        "High and ultra differ for few at macroscopic",
        "2 of 10 seemed to notice",
        "5.3",
        lambda e: noticed(e.tables, _STEP, "macroscopic"),
    ),
    Claim(
        "Moving reflections are seen at macroscopic only",
        "only at the macroscopic distance",
        "5.3",
        lambda e: _beyond_macroscopic(e, "dynamic reflection", _dynamic(e)),
    ),
    Claim(
        "Nearly everyone notices refraction",
        "nearly everyone, on or off",
        "5.3",
        lambda e: noticed(e.tables, _refracted(e), where=" where one eye is refracted"),
    ),
    Claim(
        "People speak of refraction or of the pupil",
        "large impact on the pupil's size; no number",
        "5.3",
        lambda e: mentioned(e.said, "refraction", _refracted(e)),
    ),
    Claim(
        "Half speak of the sclera at macroscopic",
        "about half",
        "5.3",
        lambda e: mentioned(e.said, "sclera", distance="macroscopic"),
    ),
    Claim(
        "A coarse reflection makes the eye see-through",
        "several people; no number",
        "5.3",
        lambda e: mentioned(e.said, "see-through"),
    ),
    Claim(
        "Caustics are noticed as unrealistic",
        "noticed at high, by one person at ultra",
        "5.3",
        lambda e: mentioned(e.said, "caustics"),
    ),
    Claim(
        "Nobody notices tessellation",
        "seemingly undetected by anyone",
        "5.3",
        lambda e: mentioned(e.said, "tessellation"),
    ),
    Claim(
        "Nobody notices subsurface scattering",
        "nobody explicitly",
        "6.1",
        lambda e: mentioned(e.said, "subsurface"),
    ),
    Claim(
        "Low and ultra differ even from afar",
        "conspicuous even at medium to long ranges",
        "5.3",
        lambda e: noticed(e.tables, (("low", "ultra"),), "far"),
    ),
    Claim(
        "Two different eyes are off-putting",
        "several people; no number",
        "5.3",
        lambda e: mentioned(e.said, "the pair"),
    ),
)
