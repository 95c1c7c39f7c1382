import numpy as np
import pytest

from renderer.body.makehuman import base_mesh
from renderer.body.rig import Rig
from renderer.crowd.figure import Body
from renderer.crowd.motion import (
    HIP,
    KNEE,
    WALK_SPEED_MM_S,
    Pose,
    place,
    shortest_turn,
    stand,
    stride_s,
    walk,
    wave,
)
from renderer.crowd.people import PEOPLE
from renderer.crowd.stage import PATH_Z_MM, STAGE, Figure, cached_body


@pytest.fixture(scope="module")
def body() -> Body:
    return cached_body(PEOPLE[0])


@pytest.fixture(scope="module")
def rig(body: Body) -> Rig:
    return body.rig


def joint(rig: Rig, transforms: np.ndarray, name: str) -> np.ndarray:
    bone = rig.index(name)
    return (transforms[bone] @ np.append(rig.heads_mm[bone], 1.0))[:3]


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
        pose = Pose(walk(rig, time, stride=stride), 0.0, WALK_SPEED_MM_S * time, 0.0)
        places.append(joint(rig, place(rig, pose, ground_y_mm=0.0), "foot_l")[2])
    travelled = WALK_SPEED_MM_S * (times[-1] - times[0])
    assert np.ptp(places) < 0.4 * travelled


def test_arms_swing_against_their_legs(rig: Rig) -> None:
    stride = stride_s(leg_mm(rig))
    transforms = place(rig, Pose(walk(rig, 0.0, stride=stride), 0, 0, 0), ground_y_mm=0.0)
    feet = joint(rig, transforms, "foot_l")[2] - joint(rig, transforms, "foot_r")[2]
    hands = joint(rig, transforms, "hand_l")[2] - joint(rig, transforms, "hand_r")[2]
    assert feet > 200
    assert hands < -150


def test_the_lower_foot_meets_the_ground_in_every_pose(rig: Rig) -> None:
    stride = stride_s(leg_mm(rig))
    sole = 0.0
    for time in np.linspace(0, stride, 9):
        for turns in (walk(rig, time, stride=stride), stand(rig, time, seed=2)):
            transforms = place(rig, Pose(turns, 0, 0, 30.0), ground_y_mm=-1620.0)
            low = min(joint(rig, transforms, f"foot_{side}")[1] for side in "lr")
            sole = low + 1620.0
            assert 40 < sole < 160, "ankles stand a foot's height above the ground"


def test_the_waving_hand_is_beside_the_head_and_swings_thrice_in_two_seconds(rig: Rig) -> None:
    times = np.arange(0, 2, 1 / 60)
    offsets = []
    for time in times:
        transforms = place(rig, Pose(wave(rig, time, seed=1), 0, 0, 0), ground_y_mm=0.0)
        offset = joint(rig, transforms, "hand_r") - joint(rig, transforms, "head")
        offsets.append(offset)
    x, y = np.array(offsets)[:, 0], np.array(offsets)[:, 1]
    assert x.max() < -120, "the right hand stays on the right side"
    assert -200 < y.min() < y.max() < 250
    assert np.ptp(x) > 100
    spectrum = np.abs(np.fft.rfft(x - x.mean()))
    assert np.fft.rfftfreq(len(x), 1 / 60)[spectrum.argmax()] == pytest.approx(1.5)


def test_the_palm_faces_the_one_who_is_waved_at(rig: Rig) -> None:
    turns = wave(rig, 0.0, seed=1)
    hand = place(rig, Pose(turns, 0, 0, 0), ground_y_mm=0.0)[rig.index("hand_r")][:3, :3]
    # Index and little finger of the right hand, palm forwards: index towards the head (+x).
    knuckles = base_mesh().vertices_mm[base_mesh().vertices_of("joint-r-finger-2-1")].mean(axis=0)
    little = base_mesh().vertices_mm[base_mesh().vertices_of("joint-r-finger-5-1")].mean(axis=0)
    across = hand @ (knuckles - little)
    assert across[0] > 0.6 * np.linalg.norm(across)


def test_idle_motion_is_slight_and_depends_on_time_and_seed_alone(rig: Rig) -> None:
    first, again, other = (stand(rig, 1.3, seed=seed) for seed in (3, 3, 4))
    assert all((first[name] == again[name]).all() for name in first)
    assert any((first[name] != other[name]).any() for name in first)
    heads = [
        joint(rig, place(rig, Pose(stand(rig, t, seed=3), 0, 0, 0), ground_y_mm=0.0), "head")
        for t in np.arange(0, 5, 0.25)
    ]
    assert 2 < np.ptp(heads, axis=0).max() < 120


def test_the_walker_passes_the_face_amid_the_clip_at_walking_speed(body: Body) -> None:
    walker = Figure(STAGE[0], body, 0, 0)
    early, middle, late = (walker.pose(time) for time in (1.5, 2.5, 3.5))
    assert middle.x_mm == pytest.approx(0.0, abs=1e-6)
    assert middle.z_mm == PATH_Z_MM == 1500.0
    assert late.x_mm - early.x_mm == pytest.approx(2 * WALK_SPEED_MM_S)
    period = 11000.0 / WALK_SPEED_MM_S
    assert walker.pose(1.0 + period).x_mm == pytest.approx(walker.pose(1.0).x_mm)


def test_the_shortest_turn_carries_one_direction_into_another() -> None:
    a, b = np.array([0.3, -1.0, 0.2]), np.array([0.5, 0.4, 2.0])
    turned = shortest_turn(a, b) @ a
    np.testing.assert_allclose(turned / np.linalg.norm(turned), b / np.linalg.norm(b))
    np.testing.assert_array_equal(shortest_turn(a, 2 * a), np.eye(3))
