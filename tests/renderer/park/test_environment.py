"""A user's HDR picture as surroundings: orientation, sun, harmonics, exposure, refusals."""

from __future__ import annotations

import hashlib
import math
from pathlib import Path

import moderngl
import numpy as np
import pytest

from renderer.camera import views
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.exchange.exr import write_exr
from renderer.park.cube_faces import read_face
from renderer.park.image import irradiance, light_from, load_environment, read_environment
from renderer.park.lat_long import lat_long_directions, sh_of_lat_long, solid_angles
from renderer.park.sky import LUMINANCE
from renderer.park.sun import separate_sun
from renderer.park.surroundings import Surroundings
from renderer.scene import scene_key
from renderer.spherical_harmonics import sh_basis

SIZE = (128, 256)
COLOURS = [(1, 0, 0), (0, 1, 1), (0, 1, 0), (1, 0, 1), (0, 0, 1), (1, 1, 0)]


def spec_of(path: Path, **changes: float) -> ClipSpec:
    return ClipSpec(
        left=Detail(),
        right=Detail(),
        environment="image",
        environment_file=str(path),
        environment_sha256=hashlib.sha256(path.read_bytes()).hexdigest(),
        **changes,
    )


def six_colours() -> np.ndarray:
    """Each direction in the colour of its largest axis: the order of a cube map's faces."""
    d = lat_long_directions(*SIZE)
    axis = np.abs(d).argmax(axis=-1)
    face = 2 * axis + (np.take_along_axis(d, axis[..., None], axis=-1)[..., 0] < 0)
    return np.array(COLOURS, np.float32)[face]


def with_sun(direction: np.ndarray, *, radius_deg: float, radiance: float) -> np.ndarray:
    """An even sky of radiance 0.5 with a warm disc."""
    d = lat_long_directions(*SIZE)
    sky = np.full((*SIZE, 3), 0.5, np.float32)
    sky[d @ direction > math.cos(math.radians(radius_deg))] = radiance * np.array([1.0, 0.9, 0.7])
    return sky


def unit(*xyz: float) -> np.ndarray:
    return np.array(xyz) / np.linalg.norm(xyz)


def test_the_middle_looks_before_the_face_and_the_left_half_to_the_viewers_right() -> None:
    # OpenEXR's own words: longitude 0 is +z, longitude pi/2 is +x and lies left of it.
    d = lat_long_directions(180, 360)
    np.testing.assert_allclose(d[90, 180], [0, 0, 1], atol=0.02)
    np.testing.assert_allclose(d[90, 90], [1, 0, 0], atol=0.02)
    np.testing.assert_allclose(d[0, 0], [0, 1, 0], atol=0.02)
    np.testing.assert_allclose(np.linalg.norm(d, axis=-1), 1.0)


def test_solid_angles_sum_to_the_sphere() -> None:
    assert solid_angles(64, 128).sum() * 128 == pytest.approx(4 * math.pi)


def test_known_harmonics_are_found() -> None:
    rng = np.random.Generator(np.random.PCG64(5))
    known = rng.normal(size=(9, 3))
    picture = sh_basis(lat_long_directions(*SIZE)) @ known
    np.testing.assert_allclose(sh_of_lat_long(picture), known, atol=1e-3)


def test_a_furnace_lights_every_side_alike_and_has_no_sun() -> None:
    light = light_from(np.full((*SIZE, 3), 7.0, np.float32))
    np.testing.assert_array_equal(light.sky.sun_irradiance, 0.0)
    np.testing.assert_allclose(light.radiance, 1.0, rtol=1e-3)
    sides = np.concatenate([np.eye(3), -np.eye(3)])
    np.testing.assert_allclose(irradiance(light.sky.ambient_sh, sides), math.pi, rtol=1e-3)


@pytest.mark.parametrize("towards", [unit(0.3, 0.7, 0.6), unit(0.02, 1, 0), unit(0.05, 0.4, -1)])
def test_a_known_sun_is_found_with_its_energy(towards: np.ndarray) -> None:
    """Anywhere: beside the zenith, and across the picture's edge."""
    picture = with_sun(towards, radius_deg=3.0, radiance=2000.0)
    found = separate_sun(picture)
    assert math.degrees(math.acos(min(1.0, found.direction @ towards))) < 0.5
    d, weight = lat_long_directions(*SIZE), solid_angles(*SIZE)[..., None]
    facing = np.maximum(d @ found.direction, 0)[..., None] * weight
    np.testing.assert_allclose(
        (picture * facing).sum(axis=(0, 1)),
        found.irradiance + (found.rest * facing).sum(axis=(0, 1)),
        rtol=1e-5,
    )
    expected = 2000 * math.pi * math.sin(math.radians(3)) ** 2 * np.array([1.0, 0.9, 0.7])
    np.testing.assert_allclose(found.irradiance, expected, rtol=0.06)
    assert found.rest.max() < 6.0


def test_windows_lamps_and_hot_pixels_are_no_sun() -> None:
    window = with_sun(unit(1, 0, 1), radius_deg=14.0, radiance=60.0)
    dim = with_sun(unit(1, 0, 1), radius_deg=3.0, radiance=10.0)
    hot = np.full((*SIZE, 3), 0.5, np.float32)
    hot[60, 60] = 40.0
    for picture in (window, dim, hot):
        found = separate_sun(picture)
        np.testing.assert_array_equal(found.irradiance, 0.0)
        assert found.rest is picture


def test_exposure_is_set_for_the_brightest_white_and_moves_in_stops() -> None:
    towards = unit(0.3, 0.7, 0.6)
    picture = with_sun(towards, radius_deg=2.0, radiance=5000.0)
    for brighter in (1.0, 400.0):
        sky = light_from(picture * np.float32(brighter)).sky
        sides = lat_long_directions(40, 80).reshape(-1, 3)
        sun = np.maximum(sides @ sky.sun_direction, 0)[:, None] * sky.sun_irradiance
        total = (sun + irradiance(sky.ambient_sh, sides)) @ LUMINANCE
        assert total.max() == pytest.approx(math.pi, rel=0.01)
    twice = light_from(picture, exposure_ev=1.0)
    np.testing.assert_allclose(twice.sky.sun_irradiance, 2 * sky.sun_irradiance, rtol=1e-3)
    np.testing.assert_allclose(twice.sky.ambient_sh, 2 * sky.ambient_sh, atol=1e-3)


def test_a_turn_carries_sun_and_ambient_light_to_the_viewers_right() -> None:
    picture = with_sun(unit(0, 0.5, 1), radius_deg=2.0, radiance=5000.0)
    picture[:, : SIZE[1] // 4] += 0.3  # so that the ambient light has a side too
    still, turned = light_from(picture).sky, light_from(picture, turn_deg=90.0).sky
    np.testing.assert_allclose(turned.sun_direction, unit(1, 0.5, 0), atol=0.01)
    for normal, moved in (([0, 0, 1], [1, 0, 0]), ([1, 0, 0], [0, 0, -1]), ([0, 1, 0], [0, 1, 0])):
        before, after = (
            irradiance(sky.ambient_sh, np.array([n], float))
            for sky, n in ((still, normal), (turned, moved))
        )
        np.testing.assert_allclose(before, after, rtol=1e-6)


@pytest.mark.parametrize("turn_deg", [0.0, 90.0])
def test_six_coloured_directions_reach_the_cubes_faces(
    gl: moderngl.Context, tmp_path: Path, turn_deg: float
) -> None:
    write_exr(tmp_path / "six.exr", six_colours())
    surroundings = Surroundings(
        gl, spec_of(tmp_path / "six.exr", environment_turn_deg=turn_deg, crowd=0)
    )
    for size in (32, 128):
        cube = surroundings.cube(size)
        middles = [read_face(cube, face)[size // 2, size // 2, :3] for face in range(6)]
        order = range(6) if turn_deg == 0 else (4, 5, 2, 3, 1, 0)  # what lay at +z comes to +x
        scale = max(middles[0])
        np.testing.assert_allclose(
            np.array(middles) / scale, [COLOURS[k] for k in order], atol=2e-3
        )


def test_a_camera_before_the_face_sees_what_lies_behind_the_head(
    gl: moderngl.Context, tmp_path: Path
) -> None:
    write_exr(tmp_path / "six.exr", six_colours())
    spec = spec_of(tmp_path / "six.exr", width=128, height=64)
    surroundings = Surroundings(gl, spec)
    target = gl.framebuffer([gl.texture((128, 64), 4, dtype="f4")], gl.depth_texture((128, 64)))
    target.use()
    target.clear(depth=1.0)
    gl.enable_only(moderngl.DEPTH_TEST)
    view = views(spec, 0.0)[0]
    surroundings.draw_background(view_matrix=view.view_matrix, projection=view.projection)
    seen = np.frombuffer(target.read(components=3, dtype="f4"), np.float32).reshape(64, 128, 3)
    red, green, blue = seen[32, 64]
    assert red == pytest.approx(green)
    assert red > 0.1  # yellow: -z
    assert blue < 0.01 * red


def test_cubes_keep_the_pictures_energy_at_every_size(gl: moderngl.Context, tmp_path: Path) -> None:
    rng = np.random.Generator(np.random.PCG64(2))
    write_exr(tmp_path / "x.exr", rng.uniform(0, 2, (*SIZE, 3)))
    surroundings = Surroundings(gl, spec_of(tmp_path / "x.exr"))
    for size in (32, 64, 256):
        cube = surroundings.cube(size)
        total = 0.0
        for face in range(6):
            axis = (np.arange(size) + 0.5) / size * 2 - 1
            weight = 4 / size**2 / (1 + axis[:, None] ** 2 + axis[None] ** 2) ** 1.5
            total += float((read_face(cube, face)[..., 0] * weight).sum())
        ambient = surroundings.sky.ambient_sh[0, 0] / 0.282095
        assert total == pytest.approx(ambient, rel=0.01)


def test_a_radiance_file_serves_too(tmp_path: Path) -> None:
    path = tmp_path / "x.hdr"
    pixels = np.tile(np.array([128, 64, 32, 129], np.uint8), (64 * 32, 1))
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n" + pixels.tobytes())
    np.testing.assert_allclose(
        read_environment(path)[5, 5], np.array([128.5, 64.5, 32.5]) / 128, rtol=1e-6
    )


def test_wide_pictures_are_averaged_down(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr("renderer.park.image.MOST_WIDTH_PX", 64)
    pixels = six_colours()
    write_exr(tmp_path / "x.exr", pixels)
    found = read_environment(tmp_path / "x.exr")
    assert found.shape == (32, 64, 3)
    np.testing.assert_allclose(found, pixels.reshape(32, 4, 64, 4, 3).mean(axis=(1, 3)), atol=1e-5)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda p: p[:, :-2], "254 x 128 pixels; a latitude-longitude picture is twice as wide"),
        (lambda p: p[:16, :32], "32 pixels wide; 64 or more are needed"),
        (lambda p: np.where(p == 1, np.nan, p), "pixels are infinite or no number"),
        (lambda p: np.where(p == 1, np.inf, p), "pixels are infinite or no number"),
        (lambda p: p - 0.5, "values down to -0.5; radiance is never negative"),
        (lambda p: p * 0, "all black; there is no light in it"),
    ],
)
def test_pictures_that_cannot_light_a_scene_are_refused(tmp_path: Path, change, message) -> None:
    write_exr(tmp_path / "x.exr", change(six_colours()))
    with pytest.raises(ValueError, match=message) as caught:
        read_environment(tmp_path / "x.exr")
    assert str(caught.value).startswith(str(tmp_path / "x.exr"))
    assert "\n" not in str(caught.value)


def test_other_kinds_of_file_are_refused(tmp_path: Path) -> None:
    with pytest.raises(
        ValueError, match=r'x\.png: unknown kind of picture "\.png"; \.exr or \.hdr'
    ):
        read_environment(tmp_path / "x.png")
    with pytest.raises(FileNotFoundError):
        read_environment(tmp_path / "none.exr")


def test_a_picture_that_changed_is_refused(tmp_path: Path) -> None:
    write_exr(tmp_path / "x.exr", six_colours())
    spec = spec_of(tmp_path / "x.exr")
    assert load_environment(spec).sky.ambient_sh.shape == (9, 3)
    write_exr(tmp_path / "x.exr", 2 * six_colours())
    with pytest.raises(ValueError, match=r"x\.exr: changed since the clip was named"):
        load_environment(spec)


def test_a_scene_is_kept_for_the_same_picture_alone(tmp_path: Path) -> None:
    write_exr(tmp_path / "a.exr", six_colours())
    write_exr(tmp_path / "b.exr", 2 * six_colours())
    keys = {
        scene_key(spec_of(tmp_path / "a.exr")),
        scene_key(spec_of(tmp_path / "b.exr")),
        scene_key(spec_of(tmp_path / "a.exr", environment_turn_deg=3.0)),
        scene_key(spec_of(tmp_path / "a.exr", environment_exposure_ev=1.0)),
    }
    assert len(keys) == 4
