"""Light on the eyes' corners: the shade of lids and lashes, and the globe's own on the globe."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.eye.anatomy import GLOBE_RADIUS_MM
from renderer.eye.lids import LidRims, lid_openness
from renderer.head.corner_light import light_corner, past_lids
from renderer.head.face_mesh import face_mesh
from renderer.head.lid_pose import STRAIGHT, LidPose
from renderer.head.lid_rims import rim_curves
from renderer.head.skin_light import SkinLight
from renderer.light import Sky

RIMS = LidRims(*rim_curves(samples=513))
GREY = np.zeros((9, 3))
GREY[0] = 1.0
SUN = np.array([0.0, 0.6, 0.8])


def lit(eye: int, *, pose: LidPose = STRAIGHT, sun: float = 1.0) -> SkinLight:
    part = face_mesh((pose, pose)).corners[eye]
    sky = Sky(SUN, np.full(3, 2.0), GREY)
    shares = np.full(len(part.points_mm), sun)
    return light_corner(
        part.points_mm, part.normals, part.triangles, eye=eye, pose=pose, sky=sky, sun=shares
    )


def test_on_the_globe_rays_pass_the_lids_as_the_iriss_light_does() -> None:
    rng = np.random.Generator(np.random.PCG64(3))
    xy = rng.uniform((-9.0, -3.0), (9.0, 2.5), (200, 2))
    points = np.column_stack([xy, np.sqrt(GLOBE_RADIUS_MM**2 - (xy**2).sum(axis=1))])
    rays = points / GLOBE_RADIUS_MM + 0.8 * rng.standard_normal((200, 3)) * [1.0, 1.0, 0.2]
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    lids, _ = past_lids(points, rays, RIMS, 0.5)
    np.testing.assert_allclose(lids, lid_openness(points, rays, RIMS), atol=1e-6)


@pytest.mark.parametrize("one_beam", [False, True])
def test_lashes_take_light_from_above_and_none_from_below(one_beam: bool) -> None:
    point = np.array([[-6.0, 1.5, 10.3]])
    above, below = np.array([[0.0, 0.6, 0.8]]), np.array([[0.0, -0.3, 0.95]])
    assert past_lids(point, above, RIMS, 0.35, one_beam=one_beam)[1][0] < 0.95
    assert past_lids(point, below, RIMS, 0.35, one_beam=one_beam)[1][0] == 1.0


def test_conjunctiva_is_darker_under_the_upper_lid_than_over_the_lower() -> None:
    part = face_mesh().corners[1]
    light = lit(1)
    shown = (part.lid > 0.5) & (part.caruncle < 0.1)
    y = part.points_mm[:, 1]
    x = part.points_mm[:, 0] - 31.0
    band = shown & (x > -11.0) & (x < -9.5)
    upper, lower = band & (y > 0.9), band & (y < -1.5) & (y > -2.6)
    assert light.diffuse[upper, 1].mean() < 0.75 * light.diffuse[lower, 1].mean()
    assert light.sun[upper].mean() < 0.3 < light.sun[lower].mean()


def test_both_eyes_corners_are_lit_alike_by_a_sun_in_the_middle() -> None:
    np.testing.assert_allclose(lit(0).diffuse, lit(1).diffuse, atol=0.012)


def test_shut_lids_leave_little_light_and_no_sun() -> None:
    open_eye, shut = lit(0), lit(0, pose=LidPose(blink=1.0))
    assert shut.ambient.mean() < 0.5 * open_eye.ambient.mean()
    assert shut.diffuse.mean() < 0.5 * open_eye.diffuse.mean()


def test_what_the_head_shades_gets_sky_alone() -> None:
    shaded = lit(0, sun=0.0)
    assert shaded.sun.max() == 0.0
    assert (shaded.diffuse > 0.0).all()
    assert shaded.diffuse.mean() < 0.7 * lit(0).diffuse.mean()
