"""Fitted lids: rims on the globe, no gap, nothing of the globe through the skin, thickness."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.eye.lids import LidRims
from renderer.head import lid_rims
from renderer.head.caruncle import CARUNCLE_GRID, caruncle, outer_membrane
from renderer.head.face_mesh import face_mesh
from renderer.head.lid_fit import EDGE_ROW, fit_lids
from renderer.head.lid_lap import LAP_COLUMN
from renderer.head.lid_pose import STRAIGHT, LidPose
from renderer.head.lid_shell import height_over_globe
from renderer.head.patch_space import to_patch, to_world

POSES = (STRAIGHT, LidPose(25.0, -20.0), LidPose(-30.0, 20.0, 0.3), LidPose(blink=1.0))


@pytest.mark.parametrize("eye", [0, 1])
def test_rims_are_curves_in_ascending_x_with_the_nose_on_the_right_side(eye: int) -> None:
    rims = lid_rims.lid_rims(eye)
    for curve in (rims.upper_mm, rims.lower_mm):
        assert (np.diff(curve[:, 0]) > 0).all()
        nose = curve[-1] if eye == 0 else curve[0]
        assert abs(nose[0]) == pytest.approx(-lid_rims.MEDIAL_MM[0])
    assert isinstance(rims, LidRims)


def test_both_eyes_have_mirrored_rims() -> None:
    left, right = lid_rims.lid_rims(0), lid_rims.lid_rims(1)
    np.testing.assert_allclose(left.upper_mm[::-1] * [-1, 1, 1], right.upper_mm)


def test_the_opening_is_that_of_an_average_eye() -> None:
    upper, lower = lid_rims.rim_curves()
    x = np.linspace(-8, 8, 33)
    opening = np.interp(x, upper[:, 0], upper[:, 1]) - np.interp(x, lower[:, 0], lower[:, 1])
    assert 8.0 < opening.max() < 10.5
    assert 28.0 < upper[-1, 0] - upper[0, 0] < 31.0
    assert upper[np.argmax(upper[:, 1]), 0] < 0 < lower[np.argmin(lower[:, 1]), 0]


def test_the_fissure_is_an_almond() -> None:
    upper, lower = lid_rims.rim_curves()
    x = np.array([-14.0, -12.0, 0.0, 9.0, 11.0])
    opening = np.interp(x, upper[:, 0], upper[:, 1]) - np.interp(x, lower[:, 0], lower[:, 1])
    share = opening / opening[2]
    assert (share[:2] < [0.35, 0.55]).all()
    assert (share[3:] < [0.60, 0.32]).all()
    # The iris shows over its whole width.
    assert np.interp(5.9, upper[:, 0], upper[:, 1]) > 2.0
    assert np.interp(-5.9, lower[:, 0], lower[:, 1]) < -3.0


def test_both_lids_show_a_thin_edge_from_the_front() -> None:
    patch = face_mesh().lids[1]
    middle = np.abs(patch.points_mm[:, EDGE_ROW, 0]) < 5.0
    rise = patch.points_mm[:, patch.rim_row, 1] - patch.points_mm[:, EDGE_ROW, 1]
    assert 0.3 < rise[middle & (patch.is_upper > 0.9)].mean() < 1.1
    assert -1.1 < rise[middle & (patch.is_upper < 0.1)].mean() < -0.3


def test_rims_touch_the_globe_wherever_they_lie_on_it() -> None:
    for pose in POSES:
        for curve in lid_rims.rim_curves(pose):
            middle = np.abs(curve[:, 0]) < 7.0
            gap = height_over_globe(curve[middle], pose)
            np.testing.assert_allclose(gap, lid_rims.CLEARANCE_MM, atol=1e-4)


@pytest.mark.parametrize("eye", [0, 1])
def test_the_globe_never_pokes_through_the_skin(eye: int) -> None:
    patch = face_mesh().lids[eye]
    skin = patch.points_mm[:, patch.rim_row :]
    assert height_over_globe(skin, patch.pose).min() > 0.5


@pytest.mark.parametrize("eye", [0, 1])
def test_no_light_passes_between_lid_and_globe(eye: int) -> None:
    patch = face_mesh().lids[eye]
    ring = patch.points_mm[:, 0]
    on_globe = np.abs(ring[:, 0]) < 8.0
    assert height_over_globe(ring[on_globe], patch.pose).max() < -0.3


def test_lids_are_about_two_millimetres_thick() -> None:
    patch = face_mesh().lids[1]
    middle = (np.abs(patch.points_mm[:, EDGE_ROW, 0]) < 7.0) & (patch.is_upper > 0.9)
    thickness = patch.across_mm[middle, patch.rim_row]
    assert 1.3 < thickness.mean() < 2.6


def test_the_upper_lid_has_a_crease() -> None:
    patch = face_mesh().lids[1]
    column = int(np.argmin(np.abs(patch.points_mm[:, EDGE_ROW, 0]) + 9 * (patch.is_upper < 0.5)))
    profile = patch.points_mm[column, patch.rim_row :]
    near = profile[:, 1] < profile[0, 1] + 6.0
    # Going up, depth falls along the lid to the crease, then rises over the fold.
    z = profile[near, 2]
    deepest = int(np.argmin(z))
    assert 0 < deepest < len(z) - 1
    assert z[-1] > z[deepest] + 0.8


def test_patches_end_on_the_face() -> None:
    face = face_mesh()
    for eye in (0, 1):
        end = face.lids[eye].points_mm[:, -1]
        height = face.sockets[eye].height(end[:, :2])
        np.testing.assert_allclose(end[:, 2], height, atol=0.15)


def test_corners_are_closed_and_dive_under_the_globe() -> None:
    inner, outer = caruncle(), outer_membrane()
    for corner in (inner, outer):
        assert height_over_globe(corner.points_mm, STRAIGHT).min() < -0.1
    assert inner.pink.max() > 0.9
    assert outer.pink.max() == 0.0
    bump = inner.points_mm[inner.pink > 0.5]
    assert bump[:, 0].max() < -11.0
    assert 2.0 < np.ptp(bump[:, 0]) < 4.5


def test_conjunctiva_fades_into_the_sclera_but_hides_what_lies_beside_the_globe() -> None:
    for corner in (caruncle(), outer_membrane()):
        r = np.hypot(corner.points_mm[:, 0], corner.points_mm[:, 1])
        assert corner.cover[r > 11.5].min() == 1.0
        assert corner.cover[r < 8.3].max(initial=0.0) < 0.1
        assert np.count_nonzero((corner.cover > 0.1) & (corner.cover < 0.9)) > 30


@pytest.mark.parametrize("pose", [STRAIGHT, LidPose(20.0), LidPose(-20.0)])
def test_from_the_temple_no_valley_shows_the_globes_outline(pose: LidPose) -> None:
    """From 30 degrees the covered conjunctiva climbs steadily from the globe to the caruncle."""
    corner = caruncle(pose)
    rows, columns = CARUNCLE_GRID
    towards = np.array([np.cos(np.pi / 6), 0.0, -np.sin(np.pi / 6)])  # to the right as it is seen
    seen = (corner.points_mm @ towards).reshape(rows, columns)[:, columns // 2]
    opaque = corner.cover.reshape(rows, columns)[:, columns // 2] > 0.95
    assert np.count_nonzero(opaque) > 50
    assert np.diff(seen[opaque]).min() > -0.02


def test_the_plica_is_a_fold_between_globe_and_caruncle() -> None:
    rows, columns = CARUNCLE_GRID
    sheet = caruncle()
    x, _, z = sheet.points_mm.reshape(rows, columns, 3)[:, columns // 2].T
    foot, crest, behind = np.interp((-11.1, -11.45, -12.3), x, z)
    assert crest > foot + 0.1
    assert crest > behind + 0.2  # the lake of tears
    sclera = sheet.sclera.reshape(rows, columns)[:, columns // 2]
    white, fold, lake = np.interp((-10.0, -11.45, -12.3), x, sclera)
    assert white > 0.95
    assert lake + 0.1 < fold < 0.7


def test_the_caruncle_stands_out_of_the_lake_and_alone_is_rough() -> None:
    sheet = caruncle()
    is_caruncle = sheet.pink > 0.9
    x, y, z = sheet.points_mm.T
    assert 2.5 < np.ptp(x[is_caruncle]) < 4.5
    assert np.ptp(y[is_caruncle]) > 2.2
    row = np.abs(y + 1.3) < 0.1
    lake = z[row & (x > -12.6) & (x < -11.9)].min()
    assert z[is_caruncle & row].max() > lake + 1.0
    assert sheet.grain[sheet.pink < 0.01].max() < 0.02
    assert sheet.grain[is_caruncle].mean() > 0.5


def test_the_upper_lid_laps_over_the_lower_at_the_outer_corner() -> None:
    patch = face_mesh().lids[1]
    places = patch.points_mm[:, patch.rim_row + 6]
    upper, lower = places[1], places[LAP_COLUMN - 2]
    assert upper[2] > lower[2] + 0.15
    assert upper[1] > lower[1]


def test_patch_and_world_space_are_inverse() -> None:
    points = np.array([[3.0, 4.0, 5.0], [-7.0, 1.0, 0.5]])
    for eye in (0, 1):
        np.testing.assert_allclose(to_patch(to_world(points, eye), eye), points)
    assert to_world(points, 0)[0, 0] == pytest.approx(-34.0)


@pytest.mark.parametrize("pose", POSES)
def test_the_skin_around_the_lids_never_dips_below_the_face(pose: LidPose) -> None:
    """A dip of 0.4 mm is a ring of shade around the eye."""
    socket = face_mesh().sockets[1]
    patch = fit_lids(socket, pose)
    over = patch.points_mm[..., 2] - socket.height(patch.points_mm[..., :2])
    way = patch.across_mm - patch.across_mm[:, patch.rim_row][:, None]
    outer = over[way > 0.6 * way[:, -1:]]
    assert np.percentile(outer, 2) > -0.1
    assert outer.min() > -0.45
