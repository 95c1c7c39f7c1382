"""How the crowd moves: a walk, a wave, standing about. Pure numpy, a function of time alone.

All figures of one kind move together (``renderer.crowd.skeletons``). Body frame: +x the character's
left, +y up, +z forwards; angles in degrees, lengths in mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.crowd.gait import ANKLE, HIP, KNEE, drift
from renderer.crowd.skeletons import (
    Floats,
    Skeletons,
    Turns,
    applied,
    shortest_turns,
    turns_about,
)

# From little to index finger of the right hand, in the base mesh's rest pose.
_THUMB_SIDE: Final = np.array([0.393, 0.419, 0.818])
_X, _Y, _Z = np.eye(3)


@dataclass(frozen=True)
class Places:
    """Where figures are, (f,) each; ``heading_deg`` 0 faces +z, 90 faces +x; ``scale`` of size."""

    x_mm: Floats
    z_mm: Floats
    heading_deg: Floats
    scale: Floats


def walk(figures: Skeletons, time_s: float, *, strides: Floats) -> Turns:
    """Return a step of a walk; ``strides`` (f,) are its durations in seconds."""
    phase = time_s / strides
    beat = np.cos(2 * np.pi * phase)
    # Arms swing against their legs, further forwards than back.
    swing = (4.0 - 19.0 * beat, 4.0 + 19.0 * beat)
    turns = hang_arms(figures, swing_deg=swing, elbow_deg=28.0)
    for side, start in (("l", 0.0), ("r", 0.5)):
        at = (phase + start) % 1.0
        turns[f"thigh_{side}"] = _level_leg(figures, side) @ turns_about(_X, -HIP(at))
        turns[f"calf_{side}"] = turns_about(_X, KNEE(at))
        turns[f"foot_{side}"] = turns_about(_X, -ANKLE(at))
    twist, sway = 5.0 * beat, 2.0 * np.sin(2 * np.pi * phase)
    turns["pelvis"] = turns_about(_Y, -twist) @ turns_about(_Z, -sway)
    turns["spine_01"] = turns_about(_Y, twist) @ turns_about(_Z, sway)
    turns["spine_03"] = turns_about(_Y, 0.9 * twist) @ turns_about(_X, np.full_like(twist, 2.0))
    turns["neck_01"] = turns_about(_Y, -0.9 * twist)
    # The thighs hang from the pelvis: its turn is taken back, so that feet point ahead.
    for side in "lr":
        turns[f"thigh_{side}"] = _taken_back(turns["pelvis"]) @ turns[f"thigh_{side}"]
    return turns


def stand(figures: Skeletons, time_s: float, *, seeds: tuple[int, ...]) -> Turns:
    """Return people who stand about: they breathe, shift weight, look around a little."""
    slow, lean, turn, look, nod = drift(time_s, seeds).T
    turns = hang_arms(figures, swing_deg=(2.0 * slow, -1.5 * slow), elbow_deg=16.0)
    breath = 0.8 * np.sin(2 * np.pi * (0.26 * time_s + 0.13 * np.array(seeds)))
    turns["pelvis"] = turns_about(_Z, 1.6 * lean) @ turns_about(_Y, 3.0 * turn)
    turns["spine_01"] = turns_about(_Z, -2.24 * lean)
    turns["spine_03"] = turns_about(_X, -breath)
    turns["neck_01"] = turns_about(_Y, 7.0 * look) @ turns_about(_X, breath + 2.0 * nod)
    turns["head"] = turns_about(_Y, 8.0 * look)
    for side in "lr":
        turns[f"thigh_{side}"] = _taken_back(turns["pelvis"]) @ _level_leg(figures, side)
    return turns


def wave(figures: Skeletons, time_s: float, *, seeds: tuple[int, ...]) -> Turns:
    """Return people who stand and wave with the right hand, 1.5 times a second."""
    turns = stand(figures, time_s, seeds=seeds)
    beat = np.sin(2 * np.pi * 1.5 * time_s)
    swing = np.full(len(seeds), beat * (0.8 + 0.2 * np.sin(2 * np.pi * 0.31 * time_s)))
    turns["clavicle_r"] = turns_about(_Z, np.full_like(swing, -8.0))
    frame = figures.frame(turns, "clavicle_r")
    upper = _directions(-0.80, -0.42 + 0.05 * swing, 0.42)
    turns["upperarm_r"] = _aim(figures, "upperarm_r", upper, parent=frame)
    frame = frame @ turns["upperarm_r"]
    lean = np.radians(28.0 * swing - 4.0)
    lower = _directions(-np.sin(lean), np.cos(lean), 0.22)
    turns["lowerarm_r"] = _aim(figures, "lowerarm_r", lower, parent=frame)
    frame = frame @ turns["lowerarm_r"]
    turns["hand_r"] = _show_palm(figures, frame, lower, lag_deg=-10.0 * swing)
    turns["spine_03"] = turns["spine_03"] @ turns_about(_Z, 1.2 * swing)
    return turns


def hang_arms(figures: Skeletons, *, swing_deg: tuple[Floats, Floats], elbow_deg: float) -> Turns:
    """Return arms that hang from the shoulders, swung forwards by angles (f,) left and right."""
    turns: Turns = {}
    for side, out, swing in (("l", 1.0, swing_deg[0]), ("r", -1.0, swing_deg[1])):
        angle = np.radians(swing)
        upper = _directions(0.17 * out, -np.cos(angle), np.sin(angle))
        turns[f"upperarm_{side}"] = _aim(figures, f"upperarm_{side}", upper, parent=np.eye(3))
        bend = np.radians(swing + elbow_deg + 0.6 * np.maximum(swing, 0.0))
        lower = _directions(0.02 * out, -np.cos(bend), np.sin(bend))
        turns[f"lowerarm_{side}"] = _aim(
            figures, f"lowerarm_{side}", lower, parent=turns[f"upperarm_{side}"]
        )
    return turns


def place(figures: Skeletons, turns: Turns, places: Places, *, ground_y_mm: float) -> Floats:
    """Return the world transforms (f, b, 4, 4) of figures whose lower feet meet the ground."""
    transforms = figures.posed(turns)
    scale = places.scale[:, None]
    world = turns_about(_Y, places.heading_deg)[:, None] * scale[..., None, None]
    shift = np.zeros((len(transforms), 3))
    shift[:, 0], shift[:, 2] = places.x_mm, places.z_mm
    shift[:, 1] = ground_y_mm - places.scale * _lowest_sole(figures, transforms)
    placed = transforms.copy()
    placed[..., :3, :] = world @ transforms[..., :3, :]
    placed[..., :3, 3] += shift[:, None]
    return placed


def _lowest_sole(figures: Skeletons, transforms: Floats) -> Floats:
    """Return the heights (f,) of the lowest soles: below heel and toe by what they are at rest."""
    floor = figures.tails_mm[:, figures.index("foot_l"), 1] - 22.0
    heights = []
    for side in "lr":
        foot = figures.index(f"foot_{side}")
        for joint, along in ((figures.heads_mm, -35.0), (figures.tails_mm, 25.0)):
            point = joint[:, foot] * [1, 0, 1] + [0, 0, along]
            point[:, 1] = floor
            row = transforms[:, foot, 1]
            heights.append(np.einsum("fk,fk->f", row[:, :3], point) + row[:, 3])
    return np.asarray(np.min(heights, axis=0))


def _directions(x: Floats | float, y: Floats, z: Floats | float) -> Floats:
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def _taken_back(turns: Floats) -> Floats:
    return np.swapaxes(turns, 1, 2)


def _level_leg(figures: Skeletons, side: str) -> Floats:
    """Return the turns that bring legs from their rest stance under the hip."""
    along = figures.head(f"foot_{side}") - figures.head(f"thigh_{side}")
    return turns_about(_Z, -0.72 * np.degrees(np.arctan2(along[:, 0], -along[:, 1])))


def _aim(figures: Skeletons, bone: str, directions: Floats, *, parent: Floats) -> Floats:
    """Return the smallest turns that point a bone along directions (f, 3) of the body frame."""
    turned = np.broadcast_to(parent, (len(directions), 3, 3))
    return shortest_turns(figures.along(bone), applied(_taken_back(turned), directions))


def _show_palm(figures: Skeletons, parent: Floats, along: Floats, *, lag_deg: Floats) -> Floats:
    """Return the hand's turns about the forearm that turn the palm forwards, and their lag."""
    axis = figures.head("hand_r") - figures.head("lowerarm_r")
    unit = along / np.linalg.norm(along, axis=1, keepdims=True)
    thumb = parent @ _THUMB_SIDE
    flat = thumb - np.einsum("fk,fk->f", thumb, unit)[:, None] * unit
    # Palm forwards, the right thumb points to the character's left.
    wanted = _X - unit[:, :1] * unit
    turn = np.arctan2(
        np.einsum("fk,fk->f", np.cross(flat, wanted), unit), np.einsum("fk,fk->f", flat, wanted)
    )
    lagging = _taken_back(parent) @ turns_about(_Z, lag_deg) @ parent
    return turns_about(axis, np.degrees(turn)) @ lagging
