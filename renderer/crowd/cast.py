"""Thirty people out of eight bodies: other clothes, hair, skin and stature on the same meshes.

Pure data; colours are linear Rec. 709 albedo. Nobody wears two neighbours' colours: palettes of
coprime lengths are walked through together.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from renderer.crowd.people import PEOPLE, Colour, Person

# Three more builds beside the first five; a further mesh costs a second of set-up.
MORE: Final = (
    Person(
        "sprinter", {"gender": 0.05, "age": 0.47, "muscle": 0.62, "weight": 0.4, "height": 0.52},
        {"caucasian": 1.0}, skin=(0.55, 0.35, 0.27), hair=(0.16, 0.09, 0.04),
        top=(0.55, 0.10, 0.16), bottom=(0.05, 0.06, 0.08), stature_mm=1710.0, smile=0.55,
        has_short_sleeves=True, hair_style="pixie", eye="green", iris=(0.09, 0.11, 0.05),
        body="sprinter",
    ),
    Person(
        "student", {"gender": 0.95, "age": 0.5, "muscle": 0.45, "weight": 0.42, "height": 0.5},
        {"asian": 0.8, "caucasian": 0.2}, skin=(0.46, 0.29, 0.20), hair=(0.014, 0.011, 0.011),
        top=(0.16, 0.17, 0.19), bottom=(0.07, 0.11, 0.2), stature_mm=1730.0, body="student",
        hair_style="brush", has_short_sleeves=True,
    ),
    Person(
        "grandmother", {"gender": 0.0, "age": 0.84, "muscle": 0.4, "weight": 0.58, "height": 0.45},
        {"caucasian": 0.6, "african": 0.4}, skin=(0.36, 0.22, 0.16), hair=(0.44, 0.43, 0.42),
        top=(0.30, 0.20, 0.42), bottom=(0.10, 0.09, 0.09), stature_mm=1600.0, smile=0.5,
        hair_style="set", eye="hazel", iris=(0.08, 0.055, 0.025), body="grandmother",
    ),
)  # fmt: skip
TEMPLATES: Final = {person.name: person for person in (*PEOPLE, *MORE)}

# None near a skin's: from afar its wearer would look bare.
_TOPS: Final[tuple[Colour, ...]] = (
    (0.62, 0.62, 0.60), (0.05, 0.10, 0.26), (0.44, 0.06, 0.05), (0.10, 0.22, 0.10),
    (0.72, 0.50, 0.12), (0.03, 0.03, 0.035), (0.32, 0.14, 0.30), (0.22, 0.38, 0.50),
    (0.45, 0.15, 0.05), (0.12, 0.12, 0.13), (0.20, 0.33, 0.34),
)  # fmt: skip
_BOTTOMS: Final[tuple[Colour, ...]] = (
    (0.035, 0.05, 0.11), (0.10, 0.10, 0.11), (0.26, 0.20, 0.13), (0.02, 0.02, 0.024),
    (0.07, 0.10, 0.17), (0.16, 0.14, 0.12), (0.09, 0.10, 0.06),
)  # fmt: skip
_SHADES: Final = (1.0, 0.86, 1.1, 0.94, 1.04)  # of the body's own skin
_STATURES: Final = (1.0, 0.965, 1.03, 0.985)  # of the body's own
# Hair and eyes go together with the body's own: who is dark stays dark.
Look = tuple[Colour, str]
_DARK: Final[tuple[Look, ...]] = (
    ((0.014, 0.011, 0.010), "dark-brown"),
    ((0.030, 0.018, 0.011), "brown"),
)
_FAIR: Final[tuple[Look, ...]] = (
    ((0.20, 0.12, 0.055), "blue"), ((0.055, 0.030, 0.017), "brown"), ((0.26, 0.10, 0.04), "green"),
    ((0.095, 0.055, 0.03), "hazel"), ((0.035, 0.022, 0.014), "grey"),
)  # fmt: skip
_GREY: Final[tuple[Look, ...]] = (((0.50, 0.49, 0.48), "grey"), ((0.24, 0.22, 0.21), "hazel"))
PAINTED: Final[dict[str, Colour]] = {
    "blue": (0.10, 0.14, 0.17), "grey": (0.13, 0.17, 0.20), "green": (0.09, 0.11, 0.05),
    "hazel": (0.08, 0.055, 0.025), "brown": (0.06, 0.035, 0.02), "dark-brown": (0.03, 0.018, 0.012),
}  # fmt: skip
_ORDER: Final = (  # whose body the sixth to thirtieth person wear: no two alike stand together
    "sprinter", "student", "grandmother", "walker", "waver", "right", "elder", "left", "sprinter",
    "student", "right", "walker", "grandmother", "waver", "left", "sprinter", "elder", "student",
    "right", "walker", "waver", "sprinter", "left", "student", "walker",
)  # fmt: skip


def _another(number: int, body: str) -> Person:
    template = TEMPLATES[body]
    looks = _GREY if template.build["age"] > 0.8 else _FAIR
    if "caucasian" not in template.races or template.races["caucasian"] < 0.5:
        looks = _GREY[1:] if template.build["age"] > 0.8 else _DARK
    hair, eye = looks[number % len(looks)]
    shade = _SHADES[number % len(_SHADES)]
    red, green, blue = template.skin
    return replace(
        template,
        name=f"{body}-{number}",
        skin=(red * shade, green * shade, blue * shade),
        hair=hair,
        eye=eye,
        iris=PAINTED[eye],
        top=_TOPS[number % len(_TOPS)],
        bottom=_BOTTOMS[number % len(_BOTTOMS)],
        stature_mm=template.stature_mm * _STATURES[number % len(_STATURES)],
    )


CAST: Final = (*PEOPLE, *(_another(number, body) for number, body in enumerate(_ORDER, start=5)))
