"""What simulated observers write when asked what was different: a small set of phrases by rule.

How often an effect is mentioned follows the thesis's section 5.3 where it gives a number; nobody
there mentioned tessellation or subsurface scattering.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.tables.columns import LEVELS


@dataclass(frozen=True)
class Remark:
    """One thing to say: when an effect's levels lie on both sides of ``above``, with what odds."""

    effect: str
    above: str
    chance: float
    phrases: tuple[str, ...]


# {less} and {more} are the eye below and the eye at or above the level named.
REMARKS: Final = (
    Remark(
        "reflection",
        "medium",
        0.8,  # 8 of 10 said that even simple reflection adds volume
        (
            "the {less} eye has no reflection",
            "{less} eye looks flat and dry, no highlight",
            "there is a shine on the {more} eye",
        ),
    ),
    Remark(
        "reflection",
        "high",
        0.4,
        ("sharper reflection in the {more} eye", "the {less} eye looks a bit see-through"),
    ),
    Remark(
        "reflection",
        "ultra",
        0.2,  # 2 of 10 noticed the dynamic reflection
        ("I can see people moving in the {more} eye", "reflection of the {more} eye moves"),
    ),
    Remark(
        "refraction",
        "high",
        0.6,
        (
            "pupil of the {more} eye is bigger",
            "the {less} pupil is smaller",
            "the iris of the {more} eye seems to have depth",
        ),
    ),
    Remark("caustics", "high", 0.2, ("light pattern on the iris of the {more} eye",)),
    Remark("texture", "medium", 0.4, ("the {less} iris is blurry", "more detail in {more} iris")),
    Remark(
        "sclera",
        "high",
        0.5,  # about half noticed the scleral normal map
        ("white of the {more} eye looks wet and bumpy", "veins are clearer in the {more} eye"),
    ),
)

_NOTHING_IN_PARTICULAR: Final = ("not sure, maybe the colour", "something about the brightness")

COMMENTS: Final = (
    "The eyes look good but the face is a bit stiff.",
    "Hard to tell from this far.",
    "It is strange to compare two eyes of the same person.",
    "I watched it twice.",
)


def remark_on(
    left: Mapping[str, str],
    right: Mapping[str, str],
    rng: np.random.Generator,
    *,
    visibility: float,
) -> str:
    """Say in a few words what differs between two eyes, given the level of each effect.

    ``visibility`` (0 to 1) scales how likely each difference is to be mentioned.
    """
    said = []
    for remark in REMARKS:
        sides = _sides(remark, left, right)
        if sides and rng.random() < remark.chance * visibility:
            phrase = remark.phrases[int(rng.integers(len(remark.phrases)))]
            said.append(phrase.format(less=sides[0], more=sides[1]))
    if not said:
        return _NOTHING_IN_PARTICULAR[int(rng.integers(len(_NOTHING_IN_PARTICULAR)))]
    return ", ".join(said[:3])


def _sides(
    remark: Remark, left: Mapping[str, str], right: Mapping[str, str]
) -> tuple[str, str] | None:
    has_left, has_right = (
        LEVELS.index(levels.get(remark.effect, "off")) >= LEVELS.index(remark.above)
        for levels in (left, right)
    )
    if has_left == has_right:
        return None
    return ("left", "right") if has_right else ("right", "left")
