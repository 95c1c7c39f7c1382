from dataclasses import replace

import numpy as np
import pytest

from renderer.body.makehuman import base_mesh
from renderer.body.rig import Rig
from renderer.crowd.bodies import build_figures
from renderer.crowd.figures import Figure
from renderer.crowd.gait import HIP, KNEE, WALK_SPEED_MM_S, stride_s
from renderer.crowd.people import PEOPLE
from renderer.crowd.stage import GROUND_MM, PATH_Z_MM, STAGE, Member
from renderer.crowd.troupe import Troupe


@pytest.fixture(scope="module")
def figure() -> Figure:
    return build_figures([Member(PEOPLE[0], "stand")])[0]


@pytest.fixture(scope="module")
def rig(figure: Figure) -> Rig:
    return figure.body.rig


def joint(rig: Rig, transforms: np.ndarray, name: str) -> np.ndarray:
    bone = rig.index(name)
    return (transforms[bone] @ np.append(rig.heads_mm[bone], 1.0))[:3]


def acting(figure: Figure, action: str, time_s: float, *, seed: int = 1) -> np.ndarray:
    """Return the bones of a figure that faces +z, or walks towards +x."""
    heading_deg = 90.0 if action == "walk" else 0.0
    member = replace(figure.member, action=action, heading_deg=heading_deg)
    return Troupe([replace(figure, member=member, seed=seed)]).bones(time_s)[0]


def test_joint_angles_close_after_a_stride() -> None:
    for curve in (HIP, KNEE):
        assert curve(0.0) == pytest.approx(float(curve(1.0)))
        assert curve(1e-4) - curve(0.0) == pytest.approx(
            float(curve(1.0) - curve(0.9999)), abs=0.01
        )


def test_a_stride_lasts_about_a_second(figure: Figure, rig: Rig) -> None:
    leg = rig.heads_mm[rig.index("thigh_l")] - rig.heads_mm[rig.index("foot_l")]
    assert figure.stride == pytest.approx(stride_s(figure.scale * float(np.linalg.norm(leg))))
    assert 0.9 < figure.stride < 1.25


def test_the_standing_foot_hardly_slides_in_a_walk(figure: Figure) -> None:
    times = (
        1.0 + np.linspace(0.10, 0.40, 7)
    ) * figure.stride  # the left foot is flat on the ground
    places = [
        joint(figure.body.rig, acting(figure, "walk", float(time)), "foot_l")[0] for time in times
    ]
    travelled = WALK_SPEED_MM_S * (times[-1] - times[0])
    assert np.ptp(places) < 0.4 * travelled


def test_arms_swing_against_their_legs(figure: Figure, rig: Rig) -> None:
    transforms = acting(figure, "walk", 0.0)
    feet = joint(rig, transforms, "foot_l")[0] - joint(rig, transforms, "foot_r")[0]
    hands = joint(rig, transforms, "hand_l")[0] - joint(rig, transforms, "hand_r")[0]
    assert feet > 200
    assert hands < -150


def test_the_lower_foot_meets_the_ground_in_every_pose(figure: Figure, rig: Rig) -> None:
    for time in np.linspace(0, figure.stride, 9).tolist():
        for action in ("walk", "stand"):
            transforms = acting(figure, action, time)
            low = min(joint(rig, transforms, f"foot_{side}")[1] for side in "lr")
            assert 40 < low - GROUND_MM < 160, "ankles stand a foot's height above the ground"


def test_the_waving_hand_is_beside_the_head_and_swings_thrice_in_two_seconds(
    figure: Figure, rig: Rig
) -> None:
    times = np.arange(0, 2, 1 / 60)
    offsets = []
    for time in times.tolist():
        transforms = acting(figure, "wave", time)
        offset = joint(rig, transforms, "hand_r") - joint(rig, transforms, "head")
        offsets.append(offset)
    x, y = np.array(offsets)[:, 0], np.array(offsets)[:, 1]
    assert x.max() < -120, "the right hand stays on the right side"
    assert -200 < y.min() < y.max() < 250
    assert np.ptp(x) > 100
    spectrum = np.abs(np.fft.rfft(x - x.mean()))
    assert np.fft.rfftfreq(len(x), 1 / 60)[spectrum.argmax()] == pytest.approx(1.5)


def test_the_palm_faces_the_one_who_is_waved_at(figure: Figure, rig: Rig) -> None:
    hand = acting(figure, "wave", 0.0)[rig.index("hand_r")][:3, :3]
    # Index and little finger of the right hand, palm forwards: index towards the head (+x).
    knuckles = base_mesh().vertices_mm[base_mesh().vertices_of("joint-r-finger-2-1")].mean(axis=0)
    little = base_mesh().vertices_mm[base_mesh().vertices_of("joint-r-finger-5-1")].mean(axis=0)
    across = hand @ (knuckles - little)
    assert across[0] > 0.6 * np.linalg.norm(across)


def test_idle_motion_is_slight_and_depends_on_time_and_seed_alone(figure: Figure, rig: Rig) -> None:
    first, again, other = (acting(figure, "stand", 1.3, seed=seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first, again)
    assert (first != other).any()
    heads = [
        joint(rig, acting(figure, "stand", time, seed=3), "head")
        for time in np.arange(0, 5, 0.25).tolist()
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
