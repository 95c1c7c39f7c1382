"""How the lids move: with the gaze, while blinking, always outside of the eye that turns."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.model import gaze_rotation
from renderer.eye.optics import surface_height
from renderer.head import lid_fit
from renderer.head.caruncle import caruncle, outer_membrane
from renderer.head.face_mesh import face_mesh
from renderer.head.lid_pose import STRAIGHT, LidPose, lid_poses
from renderer.head.lid_rims import MEDIAL_MM, lid_rims, rim, rim_curves
from renderer.head.lid_shell import globe_radius, height_over_globe, hull_radius

LOW = Detail.uniform("low")
OPEN = ClipSpec(left=LOW, right=LOW)
GRID = [
    LidPose(turn, pitch, blink)
    for turn, pitch, blink in itertools.product(
        (-35.0, -15.0, 0.0, 15.0, 35.0), (-35.0, 0.0, 25.0), (0.0, 0.5, 1.0)
    )
]


def height_at(x: float, pose: LidPose) -> tuple[float, float]:
    """Return y of the upper and the lower rim in mm."""
    upper, lower = rim_curves(pose)
    return float(np.interp(x, *upper[:, :2].T)), float(np.interp(x, *lower[:, :2].T))


def column(patch: lid_fit.LidPatch, x: float) -> np.ndarray:
    """Return the upper lid's profile (along, 3) whose inner edge is nearest to x."""
    away = np.abs(patch.points_mm[:, lid_fit.EDGE_ROW, 0] - x) + 99.0 * (patch.is_upper < 0.5)
    return np.asarray(patch.points_mm[int(np.argmin(away))])


def test_the_viewers_two_eyes_turn_opposite_ways_in_patch_space() -> None:
    left, right = lid_poses(replace(OPEN, gaze_yaw_deg=20.0, gaze_pitch_deg=5.0))
    assert (left.turn_deg, right.turn_deg) == (-20.0, 20.0)
    assert left.pitch_deg == right.pitch_deg == 5.0
    crossed = lid_poses(replace(OPEN, vergence_deg=10.0, blink=0.5))
    assert crossed[0] == crossed[1] == LidPose(-5.0, 0.0, 0.5)


def test_the_upper_lid_goes_along_with_three_quarters_of_the_corneas_way() -> None:
    for pitch in (-30.0, -10.0, 15.0):
        pose = LidPose(pitch_deg=pitch)
        way = pose.corneal_shift_mm[1]
        upper, lower = (
            now - before
            for now, before in zip(height_at(-1.2, pose), height_at(-1.2, STRAIGHT), strict=True)
        )
        assert upper == pytest.approx(0.75 * way, rel=0.03)
        assert lower == pytest.approx(0.4 * way, rel=0.15)


def test_the_fissure_narrows_in_downgaze() -> None:
    # Reference: from 9.7 mm straight ahead to 6.4 mm at 40 degrees down.
    for pitch, fissure in ((0.0, 9.7), (-40.0, 6.4)):
        upper, lower = height_at(0.0, LidPose(pitch_deg=pitch))
        assert upper - lower == pytest.approx(fissure, abs=0.35)


def test_a_blink_is_the_upper_lids_work() -> None:
    shares = np.linspace(0.3, 0.7, 41)
    way = {
        lid: rim(shares, LidPose(blink=1.0), is_upper=lid) - rim(shares, STRAIGHT, is_upper=lid)
        for lid in (True, False)
    }
    assert 8.0 < -way[True][:, 1].min() < 11.0
    lower = np.linalg.norm(way[False][:, :2], axis=1).max()
    assert 1.0 < lower < 2.0
    nasal = -way[False][:, 0]
    assert (nasal > way[False][:, 1]).all()
    assert nasal.min() > 0.6


@pytest.mark.parametrize("pitch", [-30.0, 0.0, 20.0])
def test_lids_close_steadily_and_completely(pitch: float) -> None:
    openings = [np.subtract(*height_at(0.0, LidPose(0, pitch, b))) for b in (0, 0.25, 0.5, 0.75, 1)]
    steps = np.diff(openings)
    assert (steps < 0).all()
    assert openings[-1] < 0  # the lids overlap a little: nothing shines through
    upper, lower = rim_curves(LidPose(0, pitch, 1.0), samples=257)
    inside = np.linspace(MEDIAL_MM[0] + 0.2, 12.4, 90)
    gap = np.interp(inside, *upper[:, :2].T) - np.interp(inside, *lower[:, :2].T)
    assert gap.max() < 1e-3


def test_the_hull_surrounds_the_eye_and_hugs_it() -> None:
    angle = np.radians(np.linspace(0, 90, 181))
    over = hull_radius(angle) - globe_radius(angle)
    assert over.min() >= 0.0
    assert over.max() < 0.15
    r = np.linspace(0.5, 8.0, 16)
    z = surface_height(r)[0]
    np.testing.assert_allclose(globe_radius(np.arctan2(r, z)), np.hypot(r, z), atol=1e-4)


@pytest.mark.parametrize("pose", GRID, ids=lambda p: f"{p.turn_deg} {p.pitch_deg} {p.blink}")
def test_the_turned_cornea_never_cuts_a_lid(pose: LidPose) -> None:
    patch = lid_fit.fit_lids(face_mesh().sockets[1], pose)
    assert height_over_globe(patch.points_mm[:, 3:], pose).min() > 0.0
    assert height_over_globe(patch.points_mm[:, patch.rim_row :], pose).min() > 0.5
    # Towards the back the patch dives into the globe wherever the rim lies on it.
    edge_on_globe = height_over_globe(patch.points_mm[:, lid_fit.EDGE_ROW], pose) < 0.3
    assert height_over_globe(patch.points_mm[edge_on_globe, 0], pose).max() < 0.0


@pytest.mark.parametrize("pose", GRID[::4], ids=lambda p: f"{p.turn_deg} {p.pitch_deg} {p.blink}")
def test_conjunctiva_stays_behind_the_lids_outer_edge(pose: LidPose) -> None:
    for sheet in (caruncle(pose), outer_membrane(pose)):
        assert np.isfinite(sheet.points_mm).all()
        assert height_over_globe(sheet.points_mm, pose).min() < -0.1
        assert sheet.points_mm[:, 2].max() < 12.0


def test_the_upper_lids_skin_unfolds_from_a_crease_that_hardly_moves() -> None:
    socket = face_mesh().sockets[1]
    profiles = {}
    for blink in (0.0, 1.0):
        profile = column(lid_fit.fit_lids(socket, LidPose(blink=blink)), -1.0)
        skin = profile[10:34]
        crease = int(np.argmin(skin[:, 2]))  # the deepest place between lashes and fold
        profiles[blink] = skin[0, 1], skin[crease, 1]
    (open_rim, open_crease), (shut_rim, shut_crease) = profiles[0.0], profiles[1.0]
    assert open_rim - shut_rim > 7.5
    assert abs(open_crease - shut_crease) < 2.5
    assert open_crease - open_rim < 4.0
    assert shut_crease - shut_rim > 7.0


@pytest.mark.parametrize("eye", [0, 1])
def test_rims_are_given_in_the_frame_of_the_turned_eye(eye: int) -> None:
    spec = replace(OPEN, gaze_yaw_deg=18.0, gaze_pitch_deg=-12.0)
    pose = lid_poses(spec)[eye]
    turned = lid_rims(eye, pose)
    to_world = gaze_rotation(18.0, -12.0)
    upper, _ = rim_curves(pose)
    expected = upper * [1.0 if eye else -1.0, 1.0, 1.0]
    back = turned.upper_mm @ to_world.T
    # Every rim point is one of the head's rim points, seen from the eye.
    distance = np.linalg.norm(back[:, None] - expected[None], axis=2).min(axis=1)
    assert distance.max() < 1e-9
    assert (np.diff(turned.upper_mm[:, 0]) > 0).all()
    assert (np.diff(turned.lower_mm[:, 0]) > 0).all()


def test_rims_ascend_at_the_limits_of_gaze() -> None:
    for yaw, pitch, blink in itertools.product((-45.0, 45.0), (-35.0, 25.0), (0.0, 0.6, 1.0)):
        for eye in (0, 1):
            rims = lid_rims(eye, LidPose(yaw, pitch, blink))
            for curve in (rims.upper_mm, rims.lower_mm):
                assert (np.diff(curve[:, 0]) > 0).all()
                assert np.ptp(curve[:, 0]) > 18.0


def test_the_same_pose_gives_the_same_lids() -> None:
    socket = face_mesh().sockets[0]
    pose = LidPose(12.0, -7.0, 0.3)
    np.testing.assert_array_equal(
        lid_fit.fit_lids(socket, pose).points_mm, lid_fit.fit_lids(socket, pose).points_mm
    )
