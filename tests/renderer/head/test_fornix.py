"""No one looks through the head past a coarse globe."""

from __future__ import annotations

import moderngl
import numpy as np

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.anatomy import GLOBE_RADIUS_MM
from renderer.eye.place import eye_centre_mm
from renderer.frame.frame import FrameRenderer
from renderer.head.fornix import REACHED, TISSUE, disc, radiance, wall
from renderer.light import Sky
from renderer.scene import Scene


def test_the_disc_is_wider_than_the_globe_and_faces_forwards() -> None:
    corners = disc(1).reshape(-1, 3, 3)
    reach = np.linalg.norm((corners - eye_centre_mm(1))[..., :2], axis=-1)
    assert reach.max() > GLOBE_RADIUS_MM + 0.5
    turns = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (turns[:, 2] > 0).all()


def test_the_wall_stands_on_the_temples_side_and_faces_inwards() -> None:
    for eye, outwards in ((0, -1), (1, 1)):
        corners = (wall(eye) - eye_centre_mm(eye)).reshape(-1, 3, 3)
        assert (corners[..., 0] * outwards > -1e-9).all()
        turns = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert ((turns * corners.mean(axis=1)).sum(axis=1) < 0).all()


def test_nothing_of_the_background_shows_between_globe_and_lids(
    gl: moderngl.Context, standard_scene: Scene
) -> None:
    """The lawn is the only green thing there is: none of it is left where the face fills a view."""
    low = Detail.uniform("low")
    spec = ClipSpec(left=low, right=low, width=640, height=360, crowd=0)
    renderer = FrameRenderer(gl, spec, scene=standard_scene)
    for azimuth, columns in ((-55, (0, 320)), (-20, (0, 640)), (0, (0, 640)), (20, (0, 640))):
        pixels = renderer.render(azimuth).pixels[:, slice(*columns)].astype(int)
        is_green = pixels[..., 1] > pixels[..., 0] + 8
        is_green &= pixels[..., 1] > pixels[..., 2] + 8
        assert is_green.sum() == 0, azimuth


def test_an_even_sky_gives_the_tissue_its_share() -> None:
    even = np.zeros((9, 3))
    even[0] = 1 / 0.282095  # radiance 1 from everywhere
    sky = Sky(sun_direction=np.array([0, 0, 1.0]), sun_irradiance=np.ones(3), ambient_sh=even)
    np.testing.assert_allclose(radiance(sky), REACHED * np.array(TISSUE), rtol=1e-5)
