"""Everybody's poses, computed together, against one figure and one bone after the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from renderer.body.rig import Rig, bone_transforms
from renderer.crowd.bodies import build_figures
from renderer.crowd.figure import BONES
from renderer.crowd.figures import Figure
from renderer.crowd.formation import formation
from renderer.crowd.gait import ANKLE, HIP, KNEE
from renderer.crowd.skeletons import Skeletons
from renderer.crowd.stage import GROUND_MM, members
from renderer.crowd.troupe import Troupe

Turns = dict[str, Rotation]
TIMES_S = (0.0, 0.7, 2.35, 11.9)


def about(axis: str, angle_deg: float) -> Rotation:
    return Rotation.from_euler(axis, angle_deg, degrees=True)


def way(rig: Rig, start: str, end: str) -> np.ndarray:
    return rig.heads_mm[rig.index(end)] - rig.heads_mm[rig.index(start)]


def shortest(start: np.ndarray, end: np.ndarray) -> Rotation:
    """Turn about what is square to both, by the angle between them."""
    axis = np.cross(start, end)
    angle = np.arctan2(np.linalg.norm(axis), start @ end)
    return Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))


def level(rig: Rig, side: str) -> Rotation:
    along = way(rig, f"thigh_{side}", f"foot_{side}")
    return about("z", -0.72 * np.degrees(np.arctan2(along[0], -along[1])))


def hanging(rig: Rig, swings_deg: Mapping[str, float], elbow_deg: float) -> Turns:
    turns: Turns = {}
    for side, out in (("l", 1.0), ("r", -1.0)):
        swing = swings_deg[side]
        down = about("x", -swing).apply([0.0, -1.0, 0.0]) + [0.17 * out, 0.0, 0.0]
        bend = swing + elbow_deg + 0.6 * max(swing, 0.0)
        ahead = about("x", -bend).apply([0.0, -1.0, 0.0]) + [0.02 * out, 0.0, 0.0]
        upper = shortest(way(rig, f"upperarm_{side}", f"lowerarm_{side}"), down)
        lower = shortest(way(rig, f"lowerarm_{side}", f"hand_{side}"), upper.inv().apply(ahead))
        turns |= {f"upperarm_{side}": upper, f"lowerarm_{side}": lower}
    return turns


def idle_signals(seed: int, time_s: float) -> list[float]:
    """Return slow, lean, turn, look, nod and breath."""
    found = []
    for channel in range(5):
        rng = np.random.Generator(np.random.PCG64([seed, channel]))
        periods, starts = rng.uniform(3.0, 11.0, 3), rng.uniform(0.0, 1.0, 3)
        found.append(np.sin(2 * np.pi * (time_s / periods + starts)).sum() / 2.2)
    return [*found, np.sin(2 * np.pi * (0.26 * time_s + 0.13 * seed))]


def walking(figure: Figure, time_s: float) -> Turns:
    rig, phase = figure.body.rig, time_s / figure.stride
    beat, sway = np.cos(2 * np.pi * phase), 2.0 * np.sin(2 * np.pi * phase)
    twist = 5.0 * beat
    pelvis = about("y", -twist) * about("z", -sway)
    turns = hanging(rig, {"l": 4.0 - 19.0 * beat, "r": 4.0 + 19.0 * beat}, 28.0)
    for side, start in (("l", 0.0), ("r", 0.5)):
        at = (phase + start) % 1.0
        turns[f"thigh_{side}"] = pelvis.inv() * level(rig, side) * about("x", -float(HIP(at)))
        turns[f"calf_{side}"] = about("x", float(KNEE(at)))
        turns[f"foot_{side}"] = about("x", -float(ANKLE(at)))
    return turns | {
        "pelvis": pelvis,
        "spine_01": about("y", twist) * about("z", sway),
        "spine_03": about("y", 0.9 * twist) * about("x", 2.0),
        "neck_01": about("y", -0.9 * twist),
    }


def standing(figure: Figure, time_s: float) -> Turns:
    rig = figure.body.rig
    slow, lean, turn, look, nod, breath = idle_signals(figure.seed, time_s)
    pelvis = about("z", 1.6 * lean) * about("y", 3.0 * turn)
    turns = hanging(rig, {"l": 2.0 * slow, "r": -1.5 * slow}, 16.0)
    turns |= {f"thigh_{side}": pelvis.inv() * level(rig, side) for side in "lr"}
    return turns | {
        "pelvis": pelvis,
        "spine_01": about("z", -2.24 * lean),
        "spine_03": about("x", -0.8 * breath),
        "neck_01": about("y", 7.0 * look) * about("x", 0.8 * breath + 2.0 * nod),
        "head": about("y", 8.0 * look),
    }


def waving_too(figure: Figure, time_s: float) -> Turns:
    rig, turns = figure.body.rig, standing(figure, time_s)
    beat = np.sin(2 * np.pi * 1.5 * time_s) * (0.8 + 0.2 * np.sin(2 * np.pi * 0.31 * time_s))
    turns["clavicle_r"] = about("z", -8.0)
    frame = turns["pelvis"] * turns["spine_01"] * turns["spine_03"] * turns["clavicle_r"]
    lean = np.radians(28.0 * beat - 4.0)
    upper = np.array([-0.80, -0.42 + 0.05 * beat, 0.42])
    lower = np.array([-np.sin(lean), np.cos(lean), 0.22])
    turns["upperarm_r"] = shortest(way(rig, "upperarm_r", "lowerarm_r"), frame.inv().apply(upper))
    frame = frame * turns["upperarm_r"]
    along = way(rig, "lowerarm_r", "hand_r")
    turns["lowerarm_r"] = shortest(along, frame.inv().apply(lower))
    frame = frame * turns["lowerarm_r"]
    # The turn about the forearm that brings the thumb's side as far to the left as it goes.
    axis = along / np.linalg.norm(along)
    thumb, left = np.array([0.393, 0.419, 0.818]), frame.inv().apply([1.0, 0.0, 0.0])
    palm = np.arctan2(np.cross(thumb, left) @ axis, thumb @ left - (thumb @ axis) * (left @ axis))
    lag = frame.inv() * about("z", -10.0 * beat) * frame
    turns["hand_r"] = Rotation.from_rotvec(palm * axis) * lag
    turns["spine_03"] = turns["spine_03"] * about("z", 1.2 * beat)
    return turns


def posed_alone(figure: Figure, time_s: float) -> np.ndarray:
    """Return a figure's bones (b, 4, 4), bone by bone from the root on."""
    act = {"walk": walking, "stand": standing, "wave": waving_too}[figure.member.action]
    turns = act(figure, time_s)
    for bone in ("neck_01", "head"):
        bow = about("x", figure.member.nod_deg / 2)
        turns[bone] = turns.get(bone, Rotation.identity()) * bow
    rig = figure.body.rig
    bones = bone_transforms(rig, {bone: turn.as_matrix() for bone, turn in turns.items()})
    soles_mm = []
    for foot in (rig.index("foot_l"), rig.index("foot_r")):
        for joint, along in ((rig.heads_mm, -35.0), (rig.tails_mm, 25.0)):
            floor = rig.tails_mm[rig.index("foot_l"), 1] - 22.0
            point = [joint[foot, 0], floor, joint[foot, 2] + along, 1.0]
            soles_mm.append((bones[foot] @ point)[1])
    x_mm, z_mm = figure.member.place_mm(time_s)
    body = np.eye(4)
    body[:3, :3] = figure.scale * about("y", figure.member.heading_deg).as_matrix()
    body[:3, 3] = x_mm, GROUND_MM - figure.scale * min(soles_mm), z_mm
    return np.asarray(body @ bones)


@pytest.fixture(scope="module", params=["around", "group"])
def figures(request: pytest.FixtureRequest) -> tuple[Figure, ...]:
    return build_figures(members(30) if request.param == "around" else formation(30))


@pytest.mark.parametrize("time_s", TIMES_S)
def test_a_troupe_stands_as_each_posed_bone_by_bone(
    figures: tuple[Figure, ...], time_s: float
) -> None:
    together = Troupe(figures).bones(time_s)
    for figure, bones in zip(figures, together, strict=True):
        np.testing.assert_allclose(bones, posed_alone(figure, time_s), atol=1e-9)


def test_poses_depend_on_their_time_alone(figures: tuple[Figure, ...]) -> None:
    troupe = Troupe(figures)
    first = troupe.bones(1.3)
    assert (troupe.bones(2.6) != first).any()
    np.testing.assert_array_equal(troupe.bones(1.3), first)


def test_a_troupe_of_none_has_no_bones() -> None:
    assert Troupe(()).bones(1.0).shape == (0, len(BONES), 4, 4)


def test_skeletons_of_other_bones_are_refused(figures: tuple[Figure, ...]) -> None:
    rig = figures[0].body.rig
    other = replace(rig, names=("stick", *rig.names[1:]))
    with pytest.raises(ValueError, match="2 kinds of skeletons; figures posed together share one"):
        Skeletons.of([rig, other])
