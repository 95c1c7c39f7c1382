"""The procedural iris: statistics of a real one, one iris per seed, the same at each size."""

from __future__ import annotations

import hashlib
import itertools
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import ndimage

from renderer.clip_values import IRIS_COLOURS
from renderer.colour import srgb_to_linear
from renderer.iris import maps as iris
from renderer.iris.pigment import FAMILIES
from renderer.iris.statistics import to_lab

SIZE_PX = 512


@pytest.fixture(scope="module", autouse=True)
def small_maps(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Bake at SIZE_PX instead of 2048, into a cache of our own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("OCULARIST_CACHE", str(tmp_path_factory.mktemp("bakes")))
        patch.setattr(iris, "BASE_PX", SIZE_PX)
        yield


@pytest.fixture(scope="module")
def blue() -> iris.IrisMaps:
    return iris.iris_maps(3, "blue", size_px=SIZE_PX)


@pytest.fixture(scope="module")
def means() -> dict[str, Any]:
    return {c: iris.bake_iris(2, c, size_px=256)["mean_albedo"] for c in IRIS_COLOURS}


def radius_mm(size_px: int) -> Any:
    line = ((np.arange(size_px) + 0.5) / size_px * 2.0 - 1.0) * iris.MAP_EDGE_MM
    return np.hypot(line[:, None], line[None, :])


def test_every_clip_colour_has_a_family() -> None:
    assert set(FAMILIES) == set(IRIS_COLOURS)


def test_the_pupil_is_nearly_black_and_its_ruff_brown(blue: iris.IrisMaps) -> None:
    radius = radius_mm(SIZE_PX)
    assert blue.albedo[radius < 1.9].max() < 0.01
    ruff = blue.albedo[(radius > 2.0) & (radius < 2.05)].mean(axis=0)
    assert ruff[0] > ruff[1] > ruff[2]


def test_the_rim_is_darker_than_the_tissue(blue: iris.IrisMaps) -> None:
    radius = radius_mm(SIZE_PX)
    rim = blue.albedo[(radius > 5.65) & (radius < 5.85)].mean()
    assert rim < 0.5 * blue.albedo[(radius > 4.0) & (radius < 5.0)].mean()


def test_families_keep_near_their_anchors(means: dict[str, Any]) -> None:
    for colour, mean in means.items():
        stops = srgb_to_linear(FAMILIES[colour].stops)
        distance = np.linalg.norm(to_lab(mean) - to_lab(stops[2:5].mean(axis=0)))
        assert distance < 16.0, f"{colour} strays by {distance:.1f}"


def test_families_are_told_apart(means: dict[str, Any]) -> None:
    labs = {colour: to_lab(mean) for colour, mean in means.items()}
    for (a, lab_a), (b, lab_b) in itertools.combinations(labs.items(), 2):
        assert np.linalg.norm(lab_a - lab_b) > 8.0, f"{a} looks like {b}"


def test_families_follow_the_order_of_melanin(means: dict[str, Any]) -> None:
    lightness = [to_lab(means[c])[0] for c in ("blue", "hazel", "brown", "dark-brown")]
    assert lightness == sorted(lightness, reverse=True)


@pytest.mark.parametrize("size_px", [128, 256])
def test_smaller_sizes_are_the_same_iris(blue: iris.IrisMaps, size_px: int) -> None:
    small = iris.iris_maps(3, "blue", size_px=size_px)
    factor = SIZE_PX // size_px
    blocks = blue.albedo.reshape(size_px, factor, size_px, factor, 3).mean(axis=(1, 3))
    np.testing.assert_allclose(small.albedo, blocks, atol=2e-6)
    for name in ("albedo", "thickness_mm", "cavity", "height_mm"):
        full, less = getattr(blue, name).mean(), getattr(small, name).mean()
        assert abs(less - full) < 0.01 * full


def test_size_one_is_the_mean_of_the_tissue(blue: iris.IrisMaps) -> None:
    radius = radius_mm(SIZE_PX)
    tissue = (radius > 2.1) & (radius < 5.85)
    off = iris.iris_maps(3, "blue", size_px=1)
    np.testing.assert_allclose(off.albedo[0, 0], blue.albedo[tissue].mean(axis=0), rtol=2e-3)
    np.testing.assert_array_equal(off.albedo[0, 0], iris.mean_albedo(3, "blue"))
    np.testing.assert_array_equal(off.normal[0, 0], [0.0, 0.0, 1.0])


def test_maps_have_the_promised_shapes_and_types(blue: iris.IrisMaps) -> None:
    shapes = {
        "albedo": (SIZE_PX, SIZE_PX, 3),
        "normal": (SIZE_PX, SIZE_PX, 3),
        "height_mm": (SIZE_PX, SIZE_PX),
        "thickness_mm": (SIZE_PX, SIZE_PX, 4),
        "cavity": (SIZE_PX, SIZE_PX),
    }
    for name, shape in shapes.items():
        values = getattr(blue, name)
        assert values.shape == shape
        assert values.dtype == np.float32
    assert blue.cavity.min() >= 0.0
    assert blue.cavity.max() <= 1.0
    assert 0.0 < blue.albedo.min() < blue.albedo.max() < 0.95


def test_normals_are_unit_and_belong_to_the_relief(blue: iris.IrisMaps) -> None:
    np.testing.assert_allclose(np.linalg.norm(blue.normal, axis=-1), 1.0, atol=1e-5)
    texel_mm = 2.0 * iris.MAP_EDGE_MM / SIZE_PX
    row, column = SIZE_PX // 2, SIZE_PX // 2 + 180
    rise = blue.height_mm[row, column + 1] - blue.height_mm[row, column - 1]
    normal = blue.normal[row, column]
    assert -normal[0] / normal[2] == pytest.approx(rise / (2.0 * texel_mm), abs=1e-4)


def test_relief_is_a_third_of_a_millimetre(blue: iris.IrisMaps) -> None:
    radius = radius_mm(SIZE_PX)
    low, high = np.percentile(blue.height_mm[(radius > 2.2) & (radius < 5.8)], [0.1, 99.9])
    assert 0.28 < high - low < 0.42


def test_layers_are_as_thick_as_an_iris(blue: iris.IrisMaps) -> None:
    radius = radius_mm(SIZE_PX)
    total = blue.thickness_mm.sum(axis=-1)
    assert (blue.thickness_mm >= 0.0).all()
    assert total[radius < 1.7].max() < 0.01
    assert 0.30 < total[(radius > 2.3) & (radius < 5.7)].mean() < 0.50
    ring = total[(radius > 3.3) & (radius < 3.7)].mean()
    assert ring > 1.3 * total[(radius > 5.6) & (radius < 5.8)].mean()


def test_thickness_has_no_features_that_marching_would_miss(blue: iris.IrisMaps) -> None:
    texel_mm = 2.0 * iris.MAP_EDGE_MM / SIZE_PX
    front = blue.thickness_mm[..., 1]
    power = np.abs(np.fft.fft2(front - front.mean())) ** 2
    frequency = np.fft.fftfreq(SIZE_PX, texel_mm)
    fine = np.hypot(frequency[:, None], frequency[None, :]) > 1.0 / 0.2
    assert power[fine].sum() < 1e-3 * power.sum()


def test_melanin_thickens_the_border_layer() -> None:
    pale = iris.bake_iris(2, "blue", size_px=128)["mean_thickness"]
    brown = iris.bake_iris(2, "brown", size_px=128)["mean_thickness"]
    assert brown[0] > 1.5 * pale[0]


def test_another_seed_is_another_iris(blue: iris.IrisMaps) -> None:
    other = iris.iris_maps(4, "blue", size_px=SIZE_PX)
    zone = (radius_mm(SIZE_PX) > 2.2) & (radius_mm(SIZE_PX) < 5.6)
    a, b = blue.albedo[zone].mean(axis=-1), other.albedo[zone].mean(axis=-1)
    assert (
        np.corrcoef(a - ndimage.uniform_filter(a, 9), b - ndimage.uniform_filter(b, 9))[0, 1] < 0.2
    )


def test_the_same_seed_is_the_same_bytes_in_any_process() -> None:
    code = (
        "import hashlib; from renderer.iris.maps import bake_iris; "
        "b = bake_iris(7, 'hazel', size_px=128); "
        "print(hashlib.sha256(b''.join(b[k].tobytes() for k in sorted(b))).hexdigest())"
    )
    here = iris.bake_iris(7, "hazel", size_px=128)
    digest = hashlib.sha256(b"".join(here[k].tobytes() for k in sorted(here))).hexdigest()
    threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONHASHSEED": "5"}
    ran = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | threads,
        cwd=Path(iris.__file__).parents[1],
        capture_output=True,
        text=True,
        check=True,
    )
    assert ran.stdout.strip() == digest


def test_an_unknown_colour_is_named_with_those_that_exist() -> None:
    with pytest.raises(ValueError, match=r'unknown "violet"; choose one of blue, grey'):
        iris.iris_maps(1, "violet", size_px=128)
    with pytest.raises(ValueError, match=r'unknown "violet"'):
        iris.scattering("violet")


@pytest.mark.parametrize("size_px", [0, 100, 4096])
def test_an_odd_size_is_refused(size_px: int) -> None:
    with pytest.raises(ValueError, match=f"{size_px} is no map size; choose a power of two"):
        iris.iris_maps(1, "blue", size_px=size_px)
