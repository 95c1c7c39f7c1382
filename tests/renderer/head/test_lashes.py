"""Lashes: numbers, lengths, curl, roots on whatever lid they are given, reproducibility."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial import cKDTree

from renderer.eye.anatomy import GLOBE_RADIUS_MM
from renderer.eye.optics import surface_height
from renderer.head.face_mesh import face_mesh
from renderer.head.lash_rows import UPPER
from renderer.head.lashes import grow_lashes
from renderer.head.lid_fit import LidPatch, fit_lids
from renderer.head.lid_ground import rim_frames, skin_facing
from renderer.head.lid_pose import STRAIGHT, LidPose
from renderer.head.strand_group import Strands

Floats = npt.NDArray[np.float64]
SHUT = LidPose(blink=1.0)


def rng(seed: int = 3) -> np.random.Generator:
    return np.random.Generator(np.random.PCG64(seed))


@pytest.fixture(scope="module")
def lid() -> LidPatch:
    return face_mesh().lids[1]


@pytest.fixture(scope="module")
def hairs(lid: LidPatch) -> Strands:
    return grow_lashes(lid, rng()).hairs


def upper_and_lower(strands: Strands) -> tuple[Floats, Floats]:
    return strands.points_mm[: UPPER.count], strands.points_mm[UPPER.count :]


def lengths(points: Floats) -> Floats:
    return np.asarray(np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1))


def turned(lid: LidPatch, angle_deg: float) -> tuple[LidPatch, Floats]:
    """Turn a lid about the globe's horizontal axis, as a blink does; return it and the rotation."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    rotation = np.array([[1.0, 0, 0], [0, c, -s], [0, s, c]])
    return replace(lid, points_mm=lid.points_mm @ rotation.T), rotation


def test_there_are_as_many_lashes_as_on_human_lids(hairs: Strands) -> None:
    upper, lower = upper_and_lower(hairs)
    assert 130 <= len(upper) <= 170
    assert 65 <= len(lower) <= 85


def test_upper_lashes_are_8_to_12_mm_in_the_middle_and_shorter_beside_the_nose(
    hairs: Strands,
) -> None:
    upper, lower = upper_and_lower(hairs)
    x, length = upper[:, 0, 0], lengths(upper)
    assert 8.0 < np.median(length[np.abs(x) < 6.0]) < 12.0
    assert length.max() < 12.5
    assert np.median(length[x < -9.0]) < 7.0
    assert 5.5 < np.median(lengths(lower)) < 8.0


def test_a_few_lashes_have_just_grown(hairs: Strands) -> None:
    upper, _ = upper_and_lower(hairs)
    centre = np.abs(upper[:, 0, 0]) < 6.0
    short = lengths(upper)[centre] < 6.5
    assert 0.02 < short.mean() < 0.25


def test_upper_lashes_curl_up_and_lower_ones_hang_out(hairs: Strands) -> None:
    upper, lower = upper_and_lower(hairs)
    first, last = upper[:, 1] - upper[:, 0], upper[:, -1] - upper[:, -2]
    elevation = [np.degrees(np.arctan2(d[:, 1], d[:, 2])) for d in (first, last)]
    assert np.median(elevation[1] - elevation[0]) > 40.0
    centre = np.abs(upper[:, 0, 0]) < 7.0
    assert (upper[centre, -1, 1] - upper[centre, 0, 1]).mean() > 3.0
    assert (lower[:, -1, 1] - lower[:, 0, 1]).mean() < -2.0
    for row in (upper, lower):
        centre = np.abs(row[:, 0, 0]) < 7.0
        assert (row[centre, -1, 2] - row[centre, 0, 2]).mean() > 2.0


def test_the_fan_opens_towards_temple_and_nose(hairs: Strands) -> None:
    upper, _ = upper_and_lower(hairs)
    way = upper[:, -1, 0] - upper[:, 0, 0]
    assert way[upper[:, 0, 0] > 7].mean() > 2.0
    assert way[upper[:, 0, 0] < -8].mean() < -1.0


def test_lashes_root_in_rows_on_the_lids_outer_edge(lid: LidPatch, hairs: Strands) -> None:
    rim = lid.points_mm[:, lid.rim_row]
    roots = hairs.points_mm[:, 0]
    distance = np.linalg.norm(roots[:, None] - rim[None], axis=2).min(axis=1)
    assert distance.max() < 0.95
    assert distance.std() > 0.05  # more than one row


@pytest.mark.parametrize("angle_deg", [20.0, 45.0])
def test_lashes_ride_on_a_lid_that_moves(lid: LidPatch, angle_deg: float) -> None:
    moved, rotation = turned(lid, angle_deg)
    for before, after in zip(grow_lashes(lid, rng()), grow_lashes(moved, rng()), strict=True):
        np.testing.assert_allclose(after.points_mm, before.points_mm @ rotation.T, atol=1e-9)


def test_the_frame_on_the_rim_is_square_and_looks_off_the_globe(lid: LidPatch) -> None:
    frames = rim_frames(lid)
    product = np.einsum("nik,njk->nij", frames, frames)
    np.testing.assert_allclose(product, np.broadcast_to(np.eye(3), product.shape), atol=1e-9)
    assert ((frames[:, 2] * lid.points_mm[:, lid.rim_row]).sum(axis=1) > 0).all()
    middle = np.abs(lid.points_mm[:, lid.rim_row, 0]) < 6
    up = frames[:, 1, 1] * np.where(lid.is_upper > 0.5, 1, -1)
    assert up[middle].min() > 0.3


@pytest.mark.parametrize("angle_deg", [0.0, 25.0])
def test_no_lash_enters_the_globe(lid: LidPatch, angle_deg: float) -> None:
    moved, _ = turned(lid, angle_deg)
    points = grow_lashes(moved, rng()).hairs.points_mm.reshape(-1, 3)
    r = np.hypot(points[:, 0], points[:, 1])
    front = (r < 11) & (points[:, 2] > 0)
    assert (points[front, 2] - surface_height(r[front])[0]).min() > 0.3
    assert np.linalg.norm(points, axis=1).min() > GLOBE_RADIUS_MM


def test_lashes_bend_away_from_skin_that_bulges_in_their_way(lid: LidPatch) -> None:
    """Push the skin under the eye forwards until it would swallow the lower lashes."""
    beyond = lid.across_mm - lid.across_mm[:, lid.rim_row][:, None]
    push = 7.0 * np.clip(beyond / 5.0, 0, 1) * (lid.is_upper < 0.5)[:, None]
    bulging = replace(lid, points_mm=lid.points_mm + push[..., None] * [0.0, 0.0, 1.0])
    lower = upper_and_lower(grow_lashes(bulging, rng()).hairs)[1]
    skin = bulging.points_mm[:, lid.rim_row + 1 :].reshape(-1, 3)
    tips = lower[:, 4:].reshape(-1, 3)
    near = np.array([np.argmin(((skin - tip) ** 2).sum(axis=1)) for tip in tips[::7]])
    height = tips[::7, 2] - skin[near, 2]
    assert (height > -0.2).mean() > 0.88


@pytest.mark.parametrize("pose", [STRAIGHT, LidPose(0.0, -30.0), LidPose(0.0, 25.0), SHUT])
def test_no_lash_pierces_the_skin_however_the_lids_fold(pose: LidPose) -> None:
    lid = fit_lids(face_mesh().sockets[1], pose)
    points = grow_lashes(lid, rng()).hairs.points_mm[:, 4:].reshape(-1, 3)  # past the root
    skin = lid.points_mm[:, lid.rim_row + 1 :]
    around = np.roll(skin, -1, axis=0) - np.roll(skin, 1, axis=0)
    facing = np.cross(np.gradient(skin, axis=1), around)  # from the temple over the upper lid
    facing /= np.linalg.norm(facing, axis=2, keepdims=True) + 1e-9
    _, near = cKDTree(skin.reshape(-1, 3)).query(points)
    height = ((points - skin.reshape(-1, 3)[near]) * facing.reshape(-1, 3)[near]).sum(axis=1)
    assert height.min() > 0.05


def test_tips_of_a_tuft_meet_but_roots_do_not(hairs: Strands) -> None:
    upper, _ = upper_and_lower(hairs)
    order = np.argsort(upper[:, 0, 0])
    steps = np.linalg.norm(np.diff(upper[order], axis=0), axis=2)
    assert (steps[:, -1] < 0.8).mean() > 0.08
    assert (steps[:, -1] > 2.0).mean() > 0.2


def test_shades_and_pores_lie_at_the_roots_and_are_soft(lid: LidPatch) -> None:
    shades, pores, hairs = grow_lashes(lid, rng())
    assert shades.shadow is not None
    assert pores.shadow is not None
    for marks in (shades.shadow, pores.shadow):
        assert 0.05 < marks.min() <= marks.max() < 0.6
    roots = hairs.points_mm[:, 0]
    away = np.linalg.norm(shades.points_mm[:, 0] - roots, axis=1)
    assert away.max() < 0.4
    nearest, _ = cKDTree(pores.points_mm.reshape(-1, 3)).query(roots)
    assert np.max(nearest) < 0.25
    assert hairs.shadow is None


def test_pores_are_red_and_shades_are_black(lid: LidPatch) -> None:
    shades, pores, _ = grow_lashes(lid, rng())
    assert shades.colour.max() == 0.0
    assert (pores.colour[:, 0] > 1.4 * pores.colour[:, 1]).all()
    assert pores.width_mm.max() < 0.6


def test_marks_lie_on_the_skin(lid: LidPatch) -> None:
    skin, facing = skin_facing(lid)
    tree, edge = cKDTree(skin), cKDTree(lid.points_mm[:, lid.rim_row])
    for marks in grow_lashes(lid, rng())[:2]:
        points = marks.points_mm.reshape(-1, 3)
        distance, near = tree.query(points)
        beyond = distance < edge.query(points)[0]
        height = np.abs(((points - skin[near]) * facing[near]).sum(axis=1))[beyond]
        assert len(height) > 500
        assert np.percentile(height, 95) < 0.1


def test_lower_lashes_are_finer_and_shorter_and_curve_down(hairs: Strands) -> None:
    upper, lower = upper_and_lower(hairs)
    assert np.median(lengths(lower)) < 0.75 * np.median(lengths(upper))
    width = hairs.width_mm
    assert np.median(width[UPPER.count :]) < 0.65 * np.median(width[: UPPER.count])
    straight = np.linalg.norm(lower[:, -1] - lower[:, 0], axis=1) / lengths(lower)
    assert np.median(straight) < 0.96
    assert (np.diff(lower, axis=1)[:, -1, 1] < 0.0).mean() > 0.9


def test_the_same_seed_grows_the_same_hairs(lid: LidPatch, hairs: Strands) -> None:
    np.testing.assert_array_equal(grow_lashes(lid, rng()).hairs.points_mm, hairs.points_mm)


def test_both_eyes_obey_the_same_laws_but_are_no_mirror_images(hairs: Strands) -> None:
    other = grow_lashes(face_mesh().lids[0], rng(4)).hairs
    assert np.abs(other.points_mm - hairs.points_mm).max() > 1.0
    for ours, theirs in zip(upper_and_lower(hairs), upper_and_lower(other), strict=True):
        assert lengths(theirs).mean() == pytest.approx(lengths(ours).mean(), rel=0.08)
        np.testing.assert_allclose(theirs.mean(axis=0)[-1], ours.mean(axis=0)[-1], atol=1.2)
