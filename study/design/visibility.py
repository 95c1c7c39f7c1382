"""From which size on a difference between two levels of an effect can be seen at all.

A difference that is smaller than one pixel of the clip cannot show in it, however good the viewer's
eyes are. Sizes are iris diameters in pixels; they come from the reference on eye rendering,
sections 2.4 (cube maps), 2.6 (meshes) and 2.8 (effects).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from renderer.detail import EFFECTS, Detail


@dataclass(frozen=True)
class Switch:
    """The iris diameter in pixels from which on an effect's presence moves something by a pixel."""

    iris_px: float
    because: str


# An effect against its absence. Reflection and caustics change the brightness of whole areas: no
# size is too small for them, and they have no entry.
PRESENCE: Final[Mapping[str, Switch]] = {
    "texture": Switch(12, "the limbal ring is 0.6 to 1 mm wide"),
    "refraction": Switch(9, "refraction moves the iris by 1.33 mm at 30 degrees"),
    "subsurface": Switch(39, "light travels about 0.3 mm beneath the surface"),
    "sclera": Switch(117, "the widest veins measure about 0.1 mm"),
}
# Below this iris diameter a mesh errs by less than half a pixel: a finer one looks the same.
MESH_IS_ENOUGH: Final[Mapping[int, float]] = {150: 14, 500: 48, 2000: 200, 8000: 800}
CUBE_TEXELS_PER_IRIS_PX: Final = 0.67  # one texel of a cube face per pixel


def visible_from(effect: str, one: Detail, other: Detail) -> Switch | None:
    """Return from which iris diameter on two LoDs differ visibly in an effect.

    None if they do not differ in it, or if the difference shows at every size.
    """
    settings = [
        {name: detail.setting(effect, name) for name in _SETTINGS[effect]}
        for detail in (one, other)
    ]
    if settings[0] == settings[1]:
        return None
    sizes = sorted(int(each[_SETTINGS[effect][0]]) for each in settings)
    return _RULES[effect](effect, sizes[0], settings[0].get("mode") == settings[1].get("mode"))


def _presence(effect: str, _coarser: int, _alike: bool) -> Switch | None:
    return PRESENCE.get(effect)


def _subsurface(effect: str, coarser: int, _alike: bool) -> Switch | None:
    # Few samples against many is an error in brightness, not in place: it has no size.
    return PRESENCE[effect] if coarser == 0 else None


def _map(effect: str, coarser: int, _alike: bool) -> Switch | None:
    if coarser <= 1:
        return PRESENCE.get(effect)
    return Switch(coarser, f"the coarser map has {coarser} texels across the iris")


def _cube(_effect: str, coarser: int, alike: bool) -> Switch | None:
    # A dynamic map differs from a static one in what it shows, not only in how sharply.
    if coarser == 0 or not alike:
        return None
    return Switch(
        round(coarser / CUBE_TEXELS_PER_IRIS_PX), f"the coarser cube map has {coarser} texels"
    )


def _mesh(_effect: str, coarser: int, _alike: bool) -> Switch | None:
    return Switch(MESH_IS_ENOUGH[coarser], f"the coarser mesh has {coarser} triangles")


# The settings that decide, the one with the size first.
_SETTINGS: Final[Mapping[str, tuple[str, ...]]] = {
    "texture": ("iris_map_px",),
    "refraction": ("refracts",),
    "reflection": ("cube_px", "mode"),
    "subsurface": ("samples",),
    "caustics": ("caustic_map_px",),
    "tessellation": ("triangles",),
    "sclera": ("diffuse_map_px", "normal_map_px"),
}
_RULES: Final = {
    "texture": _map,
    "refraction": _presence,
    "reflection": _cube,
    "subsurface": _subsurface,
    "caustics": _map,
    "tessellation": _mesh,
    "sclera": _presence,
}


def hidden_effects(one: Detail, other: Detail, iris_px: float) -> dict[str, Switch]:
    """Return the effects whose difference is smaller than a pixel at this iris diameter."""
    switches = {effect: visible_from(effect, one, other) for effect in EFFECTS}
    return {e: switch for e, switch in switches.items() if switch and iris_px < switch.iris_px}
