"""What people of the crowd do: signals in time, and by how much each turns which joint. Pure data.

A joint turns about up to two axes, one after the other: +x the character's left, +y up, +z
forwards. Angles in degrees per signal.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

# What stays of a figure: 1, how far its head is bowed, what brings each leg under its hip.
STAYING: Final = ("always", "bow", "level_l", "level_r")
# What moves, -1 to 1 but for the degrees of a walker's joints: ``gait`` says how.
STRIDING: Final = (
    *("step", "sway"),
    *("hip_l", "knee_l", "ankle_l", "hip_r", "knee_r", "ankle_r"),
)
IDLING: Final = ("slow", "lean", "turn", "look", "nod", "breath")
MOVING: Final = (*STRIDING, *IDLING)

Degrees = Mapping[str, float]


@dataclass(frozen=True)
class Turn:
    """A turn about an axis by degrees per signal."""

    axis: tuple[float, float, float]
    degrees: Degrees


@dataclass(frozen=True)
class Action:
    """Joints' turns by bone, and how arms hang: the left's and right's swing forwards, the elbow's

    bend. ``is_striding`` where its signals are a walker's, ``is_waving`` where the right arm does.
    """

    turns: Mapping[str, tuple[Turn, ...]]
    swing: tuple[Degrees, Degrees]
    elbow_deg: float
    is_striding: bool = False
    is_waving: bool = False


def _x(**degrees: float) -> Turn:
    return Turn((1.0, 0.0, 0.0), degrees)


def _y(**degrees: float) -> Turn:
    return Turn((0.0, 1.0, 0.0), degrees)


def _z(**degrees: float) -> Turn:
    return Turn((0.0, 0.0, 1.0), degrees)


_WALK: Final = Action(
    turns={
        "pelvis": (_y(step=-5.0), _z(sway=-2.0)),
        "spine_01": (_y(step=5.0), _z(sway=2.0)),
        "spine_03": (_y(step=4.5), _x(always=2.0)),
        "neck_01": (_y(step=-4.5), _x(bow=0.5)),
        "head": (_x(bow=0.5),),
        "thigh_l": (_z(level_l=1.0), _x(hip_l=-1.0)),
        "thigh_r": (_z(level_r=1.0), _x(hip_r=-1.0)),
        "calf_l": (_x(knee_l=1.0),),
        "calf_r": (_x(knee_r=1.0),),
        "foot_l": (_x(ankle_l=-1.0),),
        "foot_r": (_x(ankle_r=-1.0),),
    },
    # Arms swing against their legs, further forwards than back.
    swing=({"always": 4.0, "step": -19.0}, {"always": 4.0, "step": 19.0}),
    elbow_deg=28.0,
    is_striding=True,
)
# People who stand about breathe, shift weight, look around a little.
_STAND: Final = Action(
    turns={
        "pelvis": (_z(lean=1.6), _y(turn=3.0)),
        "spine_01": (_z(lean=-2.24),),
        "spine_03": (_x(breath=-0.8),),
        "neck_01": (_y(look=7.0), _x(breath=0.8, nod=2.0, bow=0.5)),
        "head": (_y(look=8.0), _x(bow=0.5)),
        "thigh_l": (_z(level_l=1.0),),
        "thigh_r": (_z(level_r=1.0),),
    },
    swing=({"slow": 2.0}, {"slow": -1.5}),
    elbow_deg=16.0,
)
_WAVE: Final = Action(
    turns={**_STAND.turns, "clavicle_r": (_z(always=-8.0),)},
    swing=_STAND.swing,
    elbow_deg=_STAND.elbow_deg,
    is_waving=True,
)
ACTIONS: Final = {"walk": _WALK, "stand": _STAND, "wave": _WAVE}
