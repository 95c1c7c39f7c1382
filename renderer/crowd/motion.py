"""How the crowd moves: a walk, a wave, standing about. Pure numpy, a function of time alone.

A pose gives bone rotations (``renderer.body.rig``: world axes relative to the parent). Body
frame: +x the character's left, +y up, +z forwards; angles in degrees, lengths in mm.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from renderer.body.rig import Rig, bone_transforms, rotation

Floats = npt.NDArray[np.float64]
Turns = dict[str, Floats]

WALK_SPEED_MM_S: Final = 1300.0
# From little to index finger of the right hand, in the base mesh's rest pose.
_THUMB_SIDE: Final = np.array([0.393, 0.419, 0.818])
_ROLL_MM: Final = 150.0  # from heel to ball: how far the ankle moves on over a standing foot
# Sagittal joint angles over one stride from heel contact, level walking at natural cadence, read
# off published means (after Winter 2009, "Biomechanics and Motor Control of Human Movement").
# Flexion and dorsiflexion are positive.
_HIP: Final = ((0.0, 22), (0.12, 19), (0.30, 4), (0.50, -11), (0.60, -6), (0.75, 17), (0.87, 25))
_KNEE: Final = ((0.0, 4), (0.13, 18), (0.28, 11), (0.42, 5), (0.60, 34), (0.72, 62), (0.87, 26))
_ANKLE: Final = ((0.0, 0), (0.07, -5), (0.25, 5), (0.45, 10), (0.60, -16), (0.72, -4), (0.87, 2))


@dataclass(frozen=True)
class Pose:
    """Where a character is and how its bones turn; ``heading_deg`` 0 faces +z, 90 faces +x."""

    turns: Turns
    x_mm: float
    z_mm: float
    heading_deg: float


def _stride_curve(knots: tuple[tuple[float, float], ...]) -> CubicSpline:
    phase, angle = zip(*knots, strict=True)
    return CubicSpline([*phase, 1.0], [*angle, angle[0]], bc_type="periodic")


HIP, KNEE, ANKLE = (_stride_curve(knots) for knots in (_HIP, _KNEE, _ANKLE))


def stride_s(leg_mm: float) -> float:
    """Return the stride's duration at which the standing foot does not slide, for a leg's length.

    During stance (60 % of a stride) the ankle travels backwards as far as the body forwards.
    """
    phase = np.linspace(0.02, 0.58, 57)
    thigh, shank = np.radians(HIP(phase)), np.radians(HIP(phase) - KNEE(phase))
    ankle_z = leg_mm / 2 * (np.sin(thigh) + np.sin(shank))
    travel = float(ankle_z[0] - ankle_z[-1]) + _ROLL_MM
    return travel / float(phase[-1] - phase[0]) / WALK_SPEED_MM_S


def walk(rig: Rig, time_s: float, *, stride: float) -> Turns:
    """Return a step of a walk; ``stride`` is its duration in seconds."""
    phase = time_s / stride
    turns = hang_arms(rig, swing_deg=_arm_swing(phase), elbow_deg=28.0)
    for side, start in (("l", 0.0), ("r", 0.5)):
        at = (phase + start) % 1.0
        turns[f"thigh_{side}"] = _level_leg(rig, side) @ rotation([1, 0, 0], -float(HIP(at)))
        turns[f"calf_{side}"] = rotation([1, 0, 0], float(KNEE(at)))
        turns[f"foot_{side}"] = rotation([1, 0, 0], -float(ANKLE(at)))
    twist = 5.0 * math.cos(2 * math.pi * phase)
    sway = 2.0 * math.sin(2 * math.pi * phase)
    turns["pelvis"] = rotation([0, 1, 0], -twist) @ rotation([0, 0, 1], -sway)
    turns["spine_01"] = rotation([0, 1, 0], twist) @ rotation([0, 0, 1], sway)
    turns["spine_03"] = rotation([0, 1, 0], 0.9 * twist) @ rotation([1, 0, 0], 2.0)
    turns["neck_01"] = rotation([0, 1, 0], -0.9 * twist)
    # The thighs hang from the pelvis: its turn is taken back, so that feet point ahead.
    for side in "lr":
        turns[f"thigh_{side}"] = turns["pelvis"].T @ turns[f"thigh_{side}"]
    return turns


def stand(rig: Rig, time_s: float, *, seed: int) -> Turns:
    """Return someone who stands about: breathes, shifts weight, looks around a little."""
    slow = _drift(time_s, seed, 0)
    turns = hang_arms(rig, swing_deg=(2.0 * slow, -1.5 * slow), elbow_deg=16.0)
    lean = 1.6 * _drift(time_s, seed, 1)
    breath = 0.8 * math.sin(2 * math.pi * (0.26 * time_s + 0.13 * seed))
    turns["pelvis"] = rotation([0, 0, 1], lean) @ rotation([0, 1, 0], 3.0 * _drift(time_s, seed, 2))
    turns["spine_01"] = rotation([0, 0, 1], -1.4 * lean)
    turns["spine_03"] = rotation([1, 0, 0], -breath)
    turns["neck_01"] = rotation([0, 1, 0], 7.0 * _drift(time_s, seed, 3)) @ rotation(
        [1, 0, 0], breath + 2.0 * _drift(time_s, seed, 4)
    )
    turns["head"] = rotation([0, 1, 0], 8.0 * _drift(time_s, seed, 3))
    for side in "lr":
        turns[f"thigh_{side}"] = turns["pelvis"].T @ _level_leg(rig, side)
    return turns


def wave(rig: Rig, time_s: float, *, seed: int) -> Turns:
    """Return someone who stands and waves with the right hand, 1.5 times a second."""
    turns = stand(rig, time_s, seed=seed)
    beat = math.sin(2 * math.pi * 1.5 * time_s)
    swing = beat * (0.8 + 0.2 * math.sin(2 * math.pi * 0.31 * time_s))
    turns["clavicle_r"] = rotation([0, 0, 1], -8.0)
    frames = {"clavicle_r": _global(rig, turns, "clavicle_r")}
    upper = np.array([-0.80, -0.42 + 0.05 * swing, 0.42])
    turns["upperarm_r"] = _aim(rig, "upperarm_r", upper, parent=frames["clavicle_r"])
    frames["upperarm_r"] = frames["clavicle_r"] @ turns["upperarm_r"]
    lean = math.radians(28.0 * swing - 4.0)
    lower = np.array([-math.sin(lean), math.cos(lean), 0.22])
    turns["lowerarm_r"] = _aim(rig, "lowerarm_r", lower, parent=frames["upperarm_r"])
    frames["lowerarm_r"] = frames["upperarm_r"] @ turns["lowerarm_r"]
    turns["hand_r"] = _show_palm(rig, frames["lowerarm_r"], lower, lag_deg=-10.0 * swing)
    turns["spine_03"] = turns["spine_03"] @ rotation([0, 0, 1], 1.2 * swing)
    return turns


def hang_arms(rig: Rig, *, swing_deg: tuple[float, float], elbow_deg: float) -> Turns:
    """Return arms that hang from the shoulders, swung forwards by angles (left, right)."""
    turns: Turns = {}
    for side, out, swing in (("l", 1.0, swing_deg[0]), ("r", -1.0, swing_deg[1])):
        angle = math.radians(swing)
        upper = np.array([0.17 * out, -math.cos(angle), math.sin(angle)])
        upper_turn = _aim(rig, f"upperarm_{side}", upper, parent=np.eye(3))
        bend = math.radians(swing + elbow_deg + 0.6 * max(swing, 0.0))
        lower = np.array([0.02 * out, -math.cos(bend), math.sin(bend)])
        turns[f"upperarm_{side}"] = upper_turn
        lower_turn = _aim(rig, f"lowerarm_{side}", lower, parent=upper_turn)
        turns[f"lowerarm_{side}"] = lower_turn
    return turns


def place(rig: Rig, pose: Pose, *, ground_y_mm: float) -> Floats:
    """Return the world transforms (b, 4, 4) of a posed body whose lower foot meets the ground."""
    transforms = bone_transforms(rig, pose.turns)
    heading = np.eye(4)
    heading[:3, :3] = rotation([0, 1, 0], pose.heading_deg)
    heading[[0, 2], 3] = pose.x_mm, pose.z_mm
    heading[1, 3] = ground_y_mm - _lowest_sole(rig, transforms)
    return np.asarray(heading @ transforms)


def _lowest_sole(rig: Rig, transforms: Floats) -> float:
    """Return the height of the lowest sole: below heel and toe by what they are at rest."""
    floor = float(rig.tails_mm[rig.index("foot_l"), 1]) - 22.0
    heights = []
    for side in "lr":
        foot = rig.index(f"foot_{side}")
        heel = rig.heads_mm[foot] * [1, 0, 1] + [0, floor, -35]
        toe = rig.tails_mm[foot] * [1, 0, 1] + [0, floor, 25]
        for point in (heel, toe):
            heights.append(float((transforms[foot] @ np.append(point, 1.0))[1]))
    return min(heights)


def _arm_swing(phase: float) -> tuple[float, float]:
    """Arms swing against their legs, further forwards than back."""
    beat = math.cos(2 * math.pi * phase)
    return 4.0 - 19.0 * beat, 4.0 + 19.0 * beat


def _level_leg(rig: Rig, side: str) -> Floats:
    """Return the turn that brings a leg from its rest stance under the hip."""
    bone, foot = rig.index(f"thigh_{side}"), rig.index(f"foot_{side}")
    along = rig.heads_mm[foot] - rig.heads_mm[bone]
    spread = math.degrees(math.atan2(along[0], -along[1]))
    return rotation([0, 0, 1], -0.72 * spread)


def _aim(rig: Rig, bone: str, direction: Floats, *, parent: Floats) -> Floats:
    """Return the smallest turn that points a bone along a direction of the body frame."""
    number = rig.index(bone)
    children = [k for k, owner in enumerate(rig.parents) if owner == number]
    end = rig.heads_mm[children[0]] if children else rig.tails_mm[number]
    rest = end - rig.heads_mm[number]
    return shortest_turn(rest, parent.T @ direction)


def shortest_turn(start: Floats, end: Floats) -> Floats:
    """Return the rotation (3, 3) that carries one direction into another the shortest way."""
    a, b = start / np.linalg.norm(start), end / np.linalg.norm(end)
    axis = np.cross(a, b)
    if np.linalg.norm(axis) < 1e-9:
        return np.eye(3)
    return rotation(axis, math.degrees(math.atan2(float(np.linalg.norm(axis)), float(a @ b))))


def _show_palm(rig: Rig, parent: Floats, along: Floats, *, lag_deg: float) -> Floats:
    """Return the hand's turn about the forearm that turns the palm forwards, and its lag."""
    hand, forearm = rig.index("hand_r"), rig.index("lowerarm_r")
    axis = rig.heads_mm[hand] - rig.heads_mm[forearm]
    axis /= np.linalg.norm(axis)
    unit = along / np.linalg.norm(along)
    thumb = parent @ _THUMB_SIDE
    flat = thumb - (thumb @ unit) * unit
    # Palm forwards, the right thumb points to the character's left.
    wanted = np.array([1.0, 0.0, 0.0]) - unit[0] * unit
    turn = math.atan2(float(np.cross(flat, wanted) @ unit), float(flat @ wanted))
    return rotation(axis, math.degrees(turn)) @ (parent.T @ rotation([0, 0, 1], lag_deg) @ parent)


def _global(rig: Rig, turns: Mapping[str, Floats], bone: str) -> Floats:
    """Return a bone's rotation in the body frame."""
    number = rig.index(bone)
    turn = np.eye(3)
    while number >= 0:
        turn = turns.get(rig.names[number], np.eye(3)) @ turn
        number = int(rig.parents[number])
    return turn


def _drift(time_s: float, seed: int, channel: int) -> float:
    """Return slow motion within -1 to 1: three sines with periods of 3 to 11 seconds."""
    rng = np.random.Generator(np.random.PCG64([seed, channel]))
    periods, starts = rng.uniform(3.0, 11.0, 3), rng.uniform(0.0, 1.0, 3)
    return float(np.sin(2 * np.pi * (time_s / periods + starts)).sum() / 2.2)
