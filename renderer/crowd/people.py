"""The crowd's first five people: who they are, how they are built and what they wear. Pure data.

Builds are MakeHuman's phenotypes; colours are linear Rec. 709 albedo.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

Colour = tuple[float, float, float]


@dataclass(frozen=True)
class Person:
    """One member of the crowd: build (MakeHuman's phenotype), colours (linear albedo), clothes."""

    name: str
    build: dict[str, float]
    races: dict[str, float]
    skin: Colour
    hair: Colour
    top: Colour
    bottom: Colour
    shoes: Colour = (0.03, 0.025, 0.022)
    iris: Colour = (0.06, 0.035, 0.02)
    stature_mm: float = 1700.0
    smile: float = 0.35  # MakeHuman's face units, 0 to 1
    hair_style: str = "crop"  # one of hair_styles.STYLES
    has_short_sleeves: bool = False
    hem_y_mm: float = 55.0  # lower edge of the top on the base mesh; the hip joint is at 100
    eye: str = "brown"  # which of the crowd's irises, where eyes are more than paint
    body: str = ""  # whose mesh this person wears in other colours


PEOPLE: Final = (
    Person(
        "walker", {"gender": 1.0, "age": 0.58, "muscle": 0.6, "weight": 0.5, "height": 0.55},
        {"caucasian": 1.0}, skin=(0.50, 0.30, 0.215), hair=(0.055, 0.032, 0.018),
        stature_mm=1800.0, top=(0.70, 0.74, 0.80), bottom=(0.035, 0.042, 0.065),
        iris=(0.10, 0.14, 0.17), eye="blue", body="walker",
    ),
    Person(
        "waver", {"gender": 0.0, "age": 0.5, "muscle": 0.5, "weight": 0.45, "height": 0.5},
        {"african": 0.6, "caucasian": 0.4}, skin=(0.33, 0.185, 0.115), hair=(0.016, 0.011, 0.009),
        top=(0.80, 0.22, 0.10), bottom=(0.060, 0.095, 0.19),
        hair_style="shoulder", stature_mm=1670.0, smile=0.8, has_short_sleeves=True,
        eye="dark-brown", body="waver",
    ),
    Person(
        "left", {"gender": 1.0, "age": 0.66, "muscle": 0.62, "weight": 0.62, "height": 0.6},
        {"african": 1.0}, skin=(0.105, 0.054, 0.034), hair=(0.012, 0.010, 0.009),
        top=(0.50, 0.29, 0.045), bottom=(0.11, 0.11, 0.12), stature_mm=1840.0,
        hair_style="curls", eye="dark-brown", body="left",
    ),
    Person(
        "right", {"gender": 0.0, "age": 0.54, "muscle": 0.45, "weight": 0.5, "height": 0.46},
        {"asian": 1.0}, skin=(0.47, 0.295, 0.20), hair=(0.013, 0.010, 0.010),
        top=(0.045, 0.26, 0.25), bottom=(0.42, 0.39, 0.34), stature_mm=1640.0,
        hair_style="fringe", body="right",
    ),
    Person(
        "elder", {"gender": 1.0, "age": 0.86, "muscle": 0.42, "weight": 0.6, "height": 0.5},
        {"caucasian": 1.0}, skin=(0.49, 0.30, 0.225), hair=(0.52, 0.51, 0.49),
        top=(0.095, 0.15, 0.075), bottom=(0.33, 0.26, 0.17), iris=(0.13, 0.17, 0.20),
        stature_mm=1740.0, hair_style="thin", eye="grey", body="elder",
    ),
)  # fmt: skip
