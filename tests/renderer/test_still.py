"""A still's two files: the picture as shown and the radiance it was made from."""

from __future__ import annotations

import json
from pathlib import Path

import moderngl
import numpy as np
import pytest
from PIL import Image

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.exchange.exr import REC_709, read_attributes, read_exr
from renderer.frame.frame import FrameRenderer
from renderer.scene import Scene
from renderer.sources import code_version
from renderer.still import write_frame

SPEC = ClipSpec(left=Detail.uniform("low"), right=Detail.uniform("high"), width=192, height=108)


@pytest.fixture(scope="module")
def files(
    gl: moderngl.Context, standard_scene: Scene, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    folder = tmp_path_factory.mktemp("still")
    renderer = FrameRenderer(gl, SPEC, scene=standard_scene)
    for name in ("x.exr", "x.png"):
        write_frame(folder / name, renderer, azimuth_deg=12.0)
    return folder


def shown(radiance: np.ndarray, exposure: float) -> np.ndarray:
    """Expose, bend and encode as a display would have it (Narkowicz 2016; IEC 61966-2-1)."""
    u = radiance * exposure
    c = np.clip(u * (2.51 * u + 0.1163) / (u * (2.4458 * u + 0.6162) + 0.1938), 0, 1)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055) * 255


def test_the_tone_curve_turns_the_radiance_into_the_picture(files: Path) -> None:
    exposure = read_attributes(files / "x.exr")["exposure"]
    expected = shown(read_exr(files / "x.exr"), exposure)
    picture = np.asarray(Image.open(files / "x.png")).astype(float)
    off = np.abs(expected - picture).max(axis=-1)
    # Half a step of rounding and half of dither; bloom and the weights of edges' samples move some.
    assert np.quantile(off, 0.5) < 1.6
    assert np.quantile(off, 0.9) < 5.0
    flipped = np.abs(expected[::-1] - picture).max(axis=-1)
    assert np.quantile(flipped, 0.5) > 5.0


def test_radiance_goes_beyond_what_a_display_shows(files: Path) -> None:
    radiance = read_exr(files / "x.exr")
    assert radiance.max() > 1.5
    assert radiance.min() >= 0.0
    assert np.isfinite(radiance).all()


def test_the_files_words_say_what_it_shows_and_what_drew_it(
    files: Path, gl: moderngl.Context
) -> None:
    words = read_attributes(files / "x.exr")
    assert ClipSpec.from_dict(json.loads(words["spec"])) == SPEC
    assert words["clip_id"] == SPEC.clip_id
    assert words["azimuth_deg"] == pytest.approx(12.0)
    assert words["code_version"] == code_version()
    assert words["gl_renderer"] == gl.info["GL_RENDERER"]
    np.testing.assert_allclose(words["chromaticities"], REC_709)
