from dataclasses import replace

import numpy as np
import pytest

from renderer.body.makehuman import base_mesh
from renderer.body.rig import Rig, bone_transforms
from renderer.crowd.bodies import cached_body
from renderer.crowd.figure import Body
from renderer.crowd.gait import HIP, KNEE, WALK_SPEED_MM_S, stride_s
from renderer.crowd.motion import Places, place, stand, walk, wave
from renderer.crowd.people import PEOPLE
from renderer.crowd.skeletons import Skeletons, Turns, shortest_turns
from renderer.crowd.stage import PATH_Z_MM, STAGE


@pytest.fixture(scope="module")
def body() -> Body:
    return cached_body(PEOPLE[0])


@pytest.fixture(scope="module")
def rig(body: Body) -> Rig:
    return body.rig


def joint(rig: Rig, transforms: np.ndarray, name: str) -> np.ndarray:
    bone = rig.index(name)
    return (transforms[bone] @ np.append(rig.heads_mm[bone], 1.0))[:3]


def stand_alone(
    rig: Rig, turns: Turns, *, z_mm: float = 0.0, heading_deg: float = 0.0, ground_y_mm: float = 0.0
) -> np.ndarray:
    places = Places(*(np.array([value]) for value in (0.0, z_mm, heading_deg, 1.0)))
    return place(Skeletons.of([rig]), turns, places, ground_y_mm=ground_y_mm)[0]


def walking(rig: Rig, time_s: float, stride: float) -> Turns:
    return walk(Skeletons.of([rig]), time_s, strides=np.array([stride]))


def standing(rig: Rig, time_s: float, seed: int) -> Turns:
    return stand(Skeletons.of([rig]), time_s, seeds=(seed,))


def waving(rig: Rig, time_s: float) -> Turns:
    return wave(Skeletons.of([rig]), time_s, seeds=(1,))


def leg_mm(rig: Rig) -> float:
    return float(
        np.linalg.norm(rig.heads_mm[rig.index("thigh_l")] - rig.heads_mm[rig.index("foot_l")])
    )


def test_joint_angles_close_after_a_stride() -> None:
    for curve in (HIP, KNEE):
        assert curve(0.0) == pytest.approx(float(curve(1.0)))
        assert curve(1e-4) - curve(0.0) == pytest.approx(
            float(curve(1.0) - curve(0.9999)), abs=0.01
        )


def test_a_stride_lasts_about_a_second(rig: Rig) -> None:
    assert 0.9 < stride_s(leg_mm(rig)) < 1.25


def test_the_standing_foot_hardly_slides_in_a_walk(rig: Rig) -> None:
    stride = stride_s(leg_mm(rig))
    times = np.linspace(0.10, 0.40, 7) * stride  # the left foot is flat on the ground
    places = []
    for time in times:
        transforms = stand_alone(
            rig, walking(rig, time, stride), z_mm=WALK_SPEED_MM_S * float(time)
        )
        places.append(joint(rig, transforms, "foot_l")[2])
    travelled = WALK_SPEED_MM_S * (times[-1] - times[0])
    assert np.ptp(places) < 0.4 * travelled


def test_arms_swing_against_their_legs(rig: Rig) -> None:
    stride = stride_s(leg_mm(rig))
    transforms = stand_alone(rig, walking(rig, 0.0, stride))
    feet = joint(rig, transforms, "foot_l")[2] - joint(rig, transforms, "foot_r")[2]
    hands = joint(rig, transforms, "hand_l")[2] - joint(rig, transforms, "hand_r")[2]
    assert feet > 200
    assert hands < -150


def test_the_lower_foot_meets_the_ground_in_every_pose(rig: Rig) -> None:
    stride = stride_s(leg_mm(rig))
    sole = 0.0
    for time in np.linspace(0, stride, 9):
        for turns in (walking(rig, time, stride), standing(rig, time, 2)):
            transforms = stand_alone(rig, turns, heading_deg=30.0, ground_y_mm=-1620.0)
            low = min(joint(rig, transforms, f"foot_{side}")[1] for side in "lr")
            sole = low + 1620.0
            assert 40 < sole < 160, "ankles stand a foot's height above the ground"


def test_the_waving_hand_is_beside_the_head_and_swings_thrice_in_two_seconds(rig: Rig) -> None:
    times = np.arange(0, 2, 1 / 60)
    offsets = []
    for time in times:
        transforms = stand_alone(rig, waving(rig, time))
        offset = joint(rig, transforms, "hand_r") - joint(rig, transforms, "head")
        offsets.append(offset)
    x, y = np.array(offsets)[:, 0], np.array(offsets)[:, 1]
    assert x.max() < -120, "the right hand stays on the right side"
    assert -200 < y.min() < y.max() < 250
    assert np.ptp(x) > 100
    spectrum = np.abs(np.fft.rfft(x - x.mean()))
    assert np.fft.rfftfreq(len(x), 1 / 60)[spectrum.argmax()] == pytest.approx(1.5)


def test_the_palm_faces_the_one_who_is_waved_at(rig: Rig) -> None:
    hand = stand_alone(rig, waving(rig, 0.0))[rig.index("hand_r")][:3, :3]
    # Index and little finger of the right hand, palm forwards: index towards the head (+x).
    knuckles = base_mesh().vertices_mm[base_mesh().vertices_of("joint-r-finger-2-1")].mean(axis=0)
    little = base_mesh().vertices_mm[base_mesh().vertices_of("joint-r-finger-5-1")].mean(axis=0)
    across = hand @ (knuckles - little)
    assert across[0] > 0.6 * np.linalg.norm(across)


def test_idle_motion_is_slight_and_depends_on_time_and_seed_alone(rig: Rig) -> None:
    first, again, other = (standing(rig, 1.3, seed) for seed in (3, 3, 4))
    assert all((first[name] == again[name]).all() for name in first)
    assert any((first[name] != other[name]).any() for name in first)
    heads = [
        joint(rig, stand_alone(rig, standing(rig, t, 3)), "head") for t in np.arange(0, 5, 0.25)
    ]
    assert 2 < np.ptp(heads, axis=0).max() < 120


def test_the_walker_passes_the_face_amid_the_clip_at_walking_speed() -> None:
    walker = STAGE[0]
    early, middle, late = (walker.place_mm(time) for time in (1.5, 2.5, 3.5))
    assert middle == pytest.approx((0.0, PATH_Z_MM))
    assert PATH_Z_MM == 1500.0
    assert late[0] - early[0] == pytest.approx(2 * WALK_SPEED_MM_S)
    period = 11000.0 / WALK_SPEED_MM_S
    assert walker.place_mm(1.0 + period)[0] == pytest.approx(walker.place_mm(1.0)[0])


def test_the_shortest_turn_carries_one_direction_into_another() -> None:
    a, b = np.array([[0.3, -1.0, 0.2]]), np.array([[0.5, 0.4, 2.0]])
    turned = (shortest_turns(a, b) @ a[..., None])[0, :, 0]
    np.testing.assert_allclose(turned / np.linalg.norm(turned), b[0] / np.linalg.norm(b))
    np.testing.assert_array_equal(shortest_turns(a, 2 * a)[0], np.eye(3))


def test_skeletons_posed_together_stand_as_each_alone() -> None:
    rigs = [cached_body(person).rig for person in PEOPLE]
    together = Skeletons.of(rigs)
    seeds = (3, 9, 4, 11, 20)
    strides = np.array([1.0, 1.1, 0.95, 1.2, 1.05])
    places = Places(
        x_mm=np.arange(5) * 300.0,
        z_mm=np.arange(5) * -70.0,
        heading_deg=np.arange(5) * 50.0,
        scale=np.array([1.0, 0.9, 1.1, 1.05, 0.97]),
    )
    for turns, alone in (
        (walk(together, 1.7, strides=strides), lambda k, one: walk(one, 1.7, strides=strides[[k]])),
        (stand(together, 1.7, seeds=seeds), lambda k, one: stand(one, 1.7, seeds=(seeds[k],))),
        (wave(together, 1.7, seeds=seeds), lambda k, one: wave(one, 1.7, seeds=(seeds[k],))),
    ):
        posed = place(together, turns, places, ground_y_mm=-1600.0)
        for k, rig in enumerate(rigs):
            here = Places(*(getattr(places, name)[[k]] for name in vars(places)))
            one = Skeletons.of([rig])
            by_itself = place(one, alone(k, one), here, ground_y_mm=-1600.0)
            np.testing.assert_allclose(posed[k], by_itself[0], atol=1e-9)


def test_bones_agree_with_the_skeletons_own_posing(rig: Rig) -> None:
    turns = standing(rig, 0.8, 5)
    alone = bone_transforms(rig, {bone: turn[0] for bone, turn in turns.items()})
    np.testing.assert_allclose(Skeletons.of([rig]).posed(turns)[0], alone, atol=1e-9)


def test_skeletons_of_other_bones_are_refused(rig: Rig) -> None:
    other = replace(rig, names=("stick", *rig.names[1:]))
    with pytest.raises(ValueError, match="2 kinds of skeletons; figures posed together share one"):
        Skeletons.of([rig, other])
