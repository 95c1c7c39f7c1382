"""Un-refraction on rendered eyes: the iris that comes back is the one that was drawn."""

from __future__ import annotations

import io
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.iris.file import IrisFileError, read_iris
from renderer.iris.source import iris_of
from renderer.unrefraction.photograph import Photograph
from renderer.unrefraction.portrait import developed, even_sky, portrait
from renderer.unrefraction.preview import draw_preview
from renderer.unrefraction.recovery import Recovery, recover_iris
from renderer.unrefraction.refusal import PhotographError
from renderer.unrefraction.sighting import Sighting, see_eye
from renderer.unrefraction.writing import write_found, write_iris, write_textures

ULTRA, OFF = Detail.uniform("ultra"), Detail.uniform("off")
# The eye without its cornea: what un-refraction is about.
BARE = ULTRA.with_levels(refraction="off", caustics="off", reflection="off", sclera="off")
DISTANCE_MM = 400.0
PHOTO_PX = 1000  # for 14 mm: an iris of 830 pixels
SMALL_PX = 500  # where the eye is only looked for: the work grows with the pixels
BARE_PX = 600  # for 12 mm: 0.02 mm


def clip(**changes: Any) -> ClipSpec:
    return ClipSpec(**({"left": ULTRA, "right": OFF, "iris_seed": 3} | changes))


def photographed(pixels: np.ndarray, *, is_monochrome: bool = False) -> Photograph:
    return Photograph("eye.png", pixels, None, is_monochrome)


def bare(gl: moderngl.Context, spec: ClipSpec) -> np.ndarray:
    """Return the iris without cornea, straight on, with the maps' own pupil; linear radiance."""
    face_on = replace(spec, left=BARE, pupil_mm=4.0, gaze_yaw_deg=0.0, gaze_pitch_deg=0.0)
    return portrait(gl, face_on, size_px=BARE_PX, half_view_mm=6.0, distance_mm=4000.0)


def decibels(a: np.ndarray, b: np.ndarray, *, texel_mm: float) -> float:
    """Return PSNR against full brightness inside r < 5 mm, at a resolution; no gain is fitted."""
    step = round(texel_mm / 0.02)
    n = BARE_PX // step
    line = ((np.arange(n) + 0.5) / n * 2 - 1) * 6.0
    radius = np.hypot(*np.meshgrid(line, line))
    ring = (radius > 2.1) & (radius < 5.0)
    small = [x.reshape(n, step, n, step, 3).mean(axis=(1, 3))[ring] for x in (a, b)]
    return float(-10 * np.log10(np.mean((small[0] - small[1]) ** 2)))


@pytest.fixture(scope="module")
def blue_photo(gl: moderngl.Context) -> np.ndarray:
    return developed(portrait(gl, clip(), size_px=PHOTO_PX))


@pytest.fixture(scope="module")
def small_photo(blue_photo: np.ndarray) -> np.ndarray:
    return np.asarray(Image.fromarray(blue_photo).resize((SMALL_PX, SMALL_PX)))


@pytest.fixture(scope="module")
def blue(blue_photo: np.ndarray) -> Recovery:
    return recover_iris(photographed(blue_photo), distance_mm=DISTANCE_MM)


def test_a_blue_iris_comes_back_from_a_photograph_straight_on(
    gl: moderngl.Context, blue: Recovery, tmp_path: Path
) -> None:
    assert blue.pose.pupil_mm == pytest.approx(2.0, abs=0.02)
    assert blue.pose.px_per_mm == pytest.approx(PHOTO_PX / 14, rel=0.002)
    middle = (PHOTO_PX - 1) / 2
    for name in ("pupil", "limbus"):
        ellipse = blue.found["ellipses"][name]
        off = math.hypot(ellipse["x_px"] - middle, ellipse["y_px"] - middle)
        assert off / blue.pose.px_per_mm < 0.1
    assert blue.found["tilt_deg"] < 2.5
    assert blue.found["iris_seen"] > 0.98
    sha256 = write_iris(blue, tmp_path / "iris.npz")
    drawn = clip(iris_file=str(tmp_path / "iris.npz"), iris_sha256=sha256)
    truth, ours = bare(gl, clip()), bare(gl, drawn)
    # The aim is 32 dB. At 0.02 mm, half of a strand, it is just met (32.05 where this was written):
    # bright strands beside dark gaps do not forgive 0.01 mm, see the document.
    assert decibels(truth, ours, texel_mm=0.04) > 32.0
    assert decibels(truth, ours, texel_mm=0.02) > 31.0


def test_a_brown_iris_comes_back_from_20_degrees_in_the_sun(
    gl: moderngl.Context, tmp_path: Path
) -> None:
    spec = clip(iris_colour="brown", iris_seed=5, pupil_mm=3.0, gaze_yaw_deg=20.0)
    photo = developed(portrait(gl, spec, size_px=PHOTO_PX, sky=even_sky(sun=0.6)), exposure=0.8)
    found = recover_iris(photographed(photo), distance_mm=DISTANCE_MM)
    assert found.pose.pupil_mm == pytest.approx(1.5, abs=0.03)
    assert found.found["gaze_yaw_deg"] == pytest.approx(20.0, abs=2.0)
    assert found.found["gaze_pitch_deg"] == pytest.approx(0.0, abs=3.0)
    sha256 = write_iris(found, tmp_path / "iris.npz")
    drawn = replace(spec, iris_file=str(tmp_path / "iris.npz"), iris_sha256=sha256)
    truth, ours = bare(gl, spec), bare(gl, drawn)
    assert decibels(truth, ours, texel_mm=0.02) > 34.0


def degraded(photo: np.ndarray, how: str) -> np.ndarray:
    """Return a photograph as worse cameras take it."""
    rng = np.random.Generator(np.random.PCG64(4))
    if how == "noise":
        return np.clip(photo + rng.normal(0, 8, photo.shape), 0, 255).astype(np.uint8)
    if how == "JPEG":
        buffer = io.BytesIO()
        Image.fromarray(photo).save(buffer, "JPEG", quality=40)
        return np.asarray(Image.open(buffer))
    if how == "blur":
        return np.asarray(ndimage.gaussian_filter(photo, (1.25, 1.25, 0)))
    if how == "turned":
        return np.asarray(Image.fromarray(photo).rotate(17, fillcolor=(190, 180, 170)))
    if how == "off-centre":
        return np.pad(photo, ((0, 150), (0, 350), (0, 0)), constant_values=120)
    return np.stack([photo.mean(axis=-1).astype(np.uint8)] * 3, axis=-1)  # infra-red


@pytest.mark.parametrize("how", ["noise", "JPEG", "blur", "turned", "off-centre", "infra-red"])
def test_the_eye_is_found_in_worse_photographs(small_photo: np.ndarray, how: str) -> None:
    seen = see_eye(photographed(degraded(small_photo, how)), distance_mm=DISTANCE_MM)
    assert 2 * seen.pose.pupil_mm == pytest.approx(4.0, abs=0.1)
    assert seen.pose.px_per_mm == pytest.approx(SMALL_PX / 14, rel=0.015)
    assert seen.pose.tilt_deg < 5.0
    assert off_centre_mm(seen) < 0.1


@pytest.mark.parametrize("turn_deg", [-17, 30])
def test_a_turned_eye_is_no_eye_that_looks_aside(small_photo: np.ndarray, turn_deg: int) -> None:
    picture = Image.fromarray(small_photo).rotate(turn_deg, fillcolor=(190, 180, 170))
    seen = see_eye(photographed(np.asarray(picture)), distance_mm=DISTANCE_MM)
    assert seen.edges.softness is not None
    off = seen.edges.softness.errors(math.radians(turn_deg))
    assert np.abs(off).max() < 1.5
    assert math.degrees(seen.pose.roll) == pytest.approx(turn_deg, abs=4.0)
    assert seen.pose.tilt_deg < 6.0


def off_centre_mm(seen: Sighting) -> float:
    middle = (SMALL_PX - 1) / 2
    centre = seen.crop.to_photograph(np.array([seen.pose.x, seen.pose.y]))
    return float(np.hypot(*(centre - middle))) / seen.pose.px_per_mm


@pytest.mark.long
@pytest.mark.parametrize(
    ("colour", "pupil_mm", "yaw_deg", "pitch_deg"),
    [("dark-brown", 2.5, 0.0, 0.0), ("green", 6.0, -14.0, -14.0), ("grey", 5.0, 0.0, 12.0)],
)
def test_every_colour_and_pupil_is_measured(
    gl: moderngl.Context, colour: str, pupil_mm: float, yaw_deg: float, pitch_deg: float
) -> None:
    spec = clip(
        iris_colour=colour, pupil_mm=pupil_mm, gaze_yaw_deg=yaw_deg, gaze_pitch_deg=pitch_deg
    )
    photo = developed(portrait(gl, spec, size_px=600))
    seen = see_eye(photographed(photo), distance_mm=DISTANCE_MM)
    assert 2 * seen.pose.pupil_mm == pytest.approx(pupil_mm, abs=0.1)
    assert math.degrees(seen.pose.yaw) == pytest.approx(yaw_deg, abs=3.0)
    assert math.degrees(seen.pose.pitch) == pytest.approx(pitch_deg, abs=3.0)


def test_bad_photographs_are_refused_in_words(
    gl: moderngl.Context, small_photo: np.ndarray
) -> None:
    tiny = np.asarray(Image.fromarray(small_photo).resize((180, 180)))
    skin = np.full_like(small_photo, (200, 150, 120))
    lidded = small_photo.copy()
    lidded[:235] = lidded[320:] = (200, 150, 120)
    oblique = developed(portrait(gl, clip(gaze_yaw_deg=32.0, gaze_pitch_deg=-32.0), size_px=500))
    blurred = ndimage.gaussian_filter(small_photo, (7, 7, 0))
    cases = {
        r"no eye found; a sharp photograph of one open eye": skin,
        r"two eyes found, at \(\d+, \d+\) and \(\d+, \d+\) pixels; crop": np.concatenate(
            [small_photo, small_photo], axis=1
        ),
        r"the iris is 1\d\d pixels wide; at least 200 are needed": tiny,
        r"under-exposed, .* at least 3% is needed": (small_photo * 0.16).astype(np.uint8),
        r"over-exposed|no eye found": np.clip(small_photo * 3.0, 0, 255).astype(np.uint8),
        r"blurred|no round edge": blurred,
        r"% of the iris|no eye found|no round edge": lidded,
        r"degrees past the camera; at most 35|no eye found|no round edge": oblique,
    }
    for words, photo in cases.items():
        with pytest.raises(PhotographError, match=words) as caught:
            recover_iris(photographed(photo), distance_mm=DISTANCE_MM)
        assert str(caught.value).startswith("eye.png: ")
        assert len(str(caught.value).splitlines()) == 1


def test_the_results_are_written_and_the_same_again(blue: Recovery, tmp_path: Path) -> None:
    first, second = (write_iris(blue, tmp_path / name) for name in ("a.npz", "b.npz"))
    assert first == second
    names = write_textures(blue, tmp_path)
    write_found(blue, tmp_path / "found.json", sha256=first)
    assert {path.name for path in tmp_path.iterdir()} == {*names, "a.npz", "b.npz", "found.json"}
    with Image.open(tmp_path / "albedo.png") as albedo, Image.open(tmp_path / "height.png") as h:
        assert albedo.size == h.size == (2048, 2048)
        assert h.mode.startswith("I;16")
        pixels = np.asarray(albedo)
    assert pixels[1024, 1024].max() < 20, "the pupil is black"
    assert pixels[1024, 1600, 2] > pixels[1024, 1600, 0], "the iris is blue"
    assert draw_preview(blue, None).size == (1452, 720)


def test_a_clip_draws_the_files_iris_or_says_what_is_wrong(blue: Recovery, tmp_path: Path) -> None:
    path = tmp_path / "iris.npz"
    sha256 = write_iris(blue, path)
    iris = iris_of(clip(iris_file=str(path), iris_sha256=sha256))
    assert iris.maps(256).albedo.shape == (256, 256, 3)
    np.testing.assert_allclose(iris.mean_albedo, blue.arrays["mean_albedo"])
    np.testing.assert_array_equal(iris.tissue.sigma_t, blue.arrays["sigma_t"])
    other = "0" * 64
    with pytest.raises(IrisFileError, match=r"has other contents .* than the clip was named for"):
        read_iris(str(path), other)
    with pytest.raises(IrisFileError, match=r"absent.npz: No such file .*; put the iris file back"):
        read_iris(str(tmp_path / "absent.npz"), sha256)
    np.savez(tmp_path / "odd.npz", albedo=np.zeros(3))
    with pytest.raises(IrisFileError, match=r'odd.npz: is no iris file \("albedo" is missing'):
        read_iris(str(tmp_path / "odd.npz"), "")
