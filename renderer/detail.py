"""What each level of each effect means: the thesis's Table 5.1 as data.

Pure vocabulary: this module knows no GL, no picture and no clip. A LoD (level of detail) is a named
row of seven levels; a level's meaning is one record of settings here and nowhere else.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from types import MappingProxyType
from typing import Final

EFFECTS: Final = (
    "texture",
    "refraction",
    "reflection",
    "subsurface",
    "caustics",
    "tessellation",
    "sclera",
)
LEVELS: Final = ("off", "low", "medium", "high", "ultra")
STANDARD_LODS: Final = ("low", "medium", "high", "ultra")

Settings = Mapping[str, int | str]


@dataclass(frozen=True)
class Meaning:
    """One cell of the table: what an effect does at a level."""

    summary: str
    settings: Settings


def _cell(summary: str, **settings: int | str) -> Meaning:
    return Meaning(summary, MappingProxyType(settings))


# Thesis, Table 5.1. Where the table contradicts the text or its print is damaged, docs/decisions.md
# says which reading was taken and why.
TABLE: Final[Mapping[str, Mapping[str, Meaning]]] = MappingProxyType(
    {
        "texture": {
            "off": _cell("one mean colour per region", iris_map_px=1),
            "low": _cell("128 x 128 iris map", iris_map_px=128),
            "medium": _cell("512 x 512 iris map", iris_map_px=512),
            "high": _cell("1024 x 1024 iris map", iris_map_px=1024),
            "ultra": _cell("2048 x 2048 iris map", iris_map_px=2048),
        },
        "refraction": {
            "off": _cell("none", refracts=0),
            "low": _cell("none", refracts=0),
            "medium": _cell("none", refracts=0),
            "high": _cell("Snell refraction at the cornea", refracts=1),
            "ultra": _cell("Snell refraction at the cornea", refracts=1),
        },
        "reflection": {
            "off": _cell("none", cube_px=0, mode="none"),
            "low": _cell("none", cube_px=0, mode="none"),
            "medium": _cell("Blinn-Phong and a static 128 cube map", cube_px=128, mode="static"),
            "high": _cell("static 1024 cube map", cube_px=1024, mode="static"),
            "ultra": _cell("dynamic 2048 cube map", cube_px=2048, mode="dynamic"),
        },
        # "samples" are the thesis's left-endpoint samples; "nodes" those of the piecewise-linear
        # integrator that reaches a smaller error with fewer fetches.
        "subsurface": {
            "off": _cell("none", samples=0, nodes=0),
            "low": _cell("none", samples=0, nodes=0),
            "medium": _cell("none", samples=0, nodes=0),
            "high": _cell("10 samples along the viewing ray", samples=10, nodes=6),
            "ultra": _cell("200 samples along the viewing ray", samples=200, nodes=8),
        },
        "caustics": {
            "off": _cell("none", caustic_map_px=0),
            "low": _cell("none", caustic_map_px=0),
            "medium": _cell("none", caustic_map_px=0),
            "high": _cell("256 x 256 caustic map", caustic_map_px=256),
            "ultra": _cell("1024 x 1024 caustic map", caustic_map_px=1024),
        },
        # Low and medium interpolate vertex normals; high and ultra evaluate them analytically.
        "tessellation": {
            "off": _cell("about 150 triangles, flat facets", triangles=150, normals="facet"),
            "low": _cell("about 150 triangles", triangles=150, normals="vertex"),
            "medium": _cell("about 500 triangles", triangles=500, normals="vertex"),
            "high": _cell("about 2000 triangles", triangles=2000, normals="analytic"),
            "ultra": _cell("about 8000 triangles", triangles=8000, normals="analytic"),
        },
        # Low and high print as 56 and 28: most likely 256 and 128 with the first digit lost.
        "sclera": {
            "off": _cell("mean colour", diffuse_map_px=1, normal_map_px=0),
            "low": _cell("256 x 256 diffuse map", diffuse_map_px=256, normal_map_px=0),
            "medium": _cell("512 x 512 diffuse map", diffuse_map_px=512, normal_map_px=0),
            "high": _cell(
                "Blinn-Phong and a 128 x 128 normal map", diffuse_map_px=1024, normal_map_px=128
            ),
            "ultra": _cell(
                "Blinn-Phong and a 512 x 512 normal map", diffuse_map_px=2048, normal_map_px=512
            ),
        },
    }
)


@dataclass(frozen=True)
class Detail:
    """The level of each of the seven effects: what one eye is drawn with."""

    texture: str = "off"
    refraction: str = "off"
    reflection: str = "off"
    subsurface: str = "off"
    caustics: str = "off"
    tessellation: str = "off"
    sclera: str = "off"

    def __post_init__(self) -> None:
        for effect in EFFECTS:
            check_level(effect, getattr(self, effect))

    @classmethod
    def uniform(cls, level: str) -> Detail:
        """Give every effect the same level: the thesis's four standard LoDs and ``off``."""
        return cls(**dict.fromkeys(EFFECTS, level))

    def with_levels(self, **levels: str) -> Detail:
        """Copy this row with some effects at other levels.

        Raises ValueError naming the effect or level that does not exist, and what does.
        """
        for effect in levels:
            check_effect(effect)
        return replace(self, **levels)

    def only(self, effect: str) -> Detail:
        """Keep one effect at its level and switch the others off."""
        check_effect(effect)
        return Detail(**{effect: getattr(self, effect)})

    def levels(self) -> dict[str, str]:
        """Return effect -> level, in the order of EFFECTS."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def setting(self, effect: str, name: str) -> int | str:
        """Return one setting of the level that ``effect`` has in this row."""
        return TABLE[effect][getattr(self, effect)].settings[name]


def check_effect(effect: str) -> None:
    """Raise ValueError unless ``effect`` is one of EFFECTS."""
    if effect not in EFFECTS:
        raise ValueError(f'unknown effect "{effect}"; choose one of {", ".join(EFFECTS)}')


def check_level(effect: str, level: str) -> None:
    """Raise ValueError unless ``level`` is one of LEVELS."""
    if level not in LEVELS:
        raise ValueError(f'{effect}: unknown level "{level}"; choose one of {", ".join(LEVELS)}')


def lod_rank(name: str) -> int | None:
    """Return 1 to 4 for low to ultra, None for a LoD that a study names itself."""
    return STANDARD_LODS.index(name) + 1 if name in STANDARD_LODS else None
