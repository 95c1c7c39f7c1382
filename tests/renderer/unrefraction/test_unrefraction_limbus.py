"""The limbus of a photograph: its law is the drawn one's; edge, ring and wandering are measured."""

from __future__ import annotations

import dataclasses
import re
from importlib import resources

import moderngl
import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.colour import decode_srgb
from renderer.detail import Detail
from renderer.eye.anatomy import LIMBUS_WIDTH_MM
from renderer.iris.maps import PUPIL_RADIUS_MM
from renderer.unrefraction import limbus as law
from renderer.unrefraction.edges import LIMBUS_LEVEL, edge_points
from renderer.unrefraction.light import lift_veils
from renderer.unrefraction.limbus import EDGE_MM, Limbus, half_way_mm, mean_edge_mm
from renderer.unrefraction.limbus_fit import SCLERA, SECTORS, find_limbus
from renderer.unrefraction.portrait import developed, portrait
from renderer.unrefraction.pose import Pose
from renderer.unrefraction.texels import Texels, place_texels, sample

BLUE, PALE, DARK = (0.10, 0.12, 0.20), (0.22, 0.20, 0.18), (0.02, 0.015, 0.01)
WHITE = np.array([0.6, 0.55, 0.5])


@pytest.fixture(scope="module")
def texels(level_pose: Pose) -> Texels:
    return place_texels(level_pose, 256)


def shown(texels: Texels, limbus: Limbus, iris: tuple[float, ...]) -> np.ndarray:
    """Return a map's colours behind a limbus, a black pupil in the middle."""
    clear = limbus.clear(texels.surface_mm, texels.bearing)[..., None]
    inside = np.where(texels.radius_mm[..., None] < PUPIL_RADIUS_MM, 0.0, np.array(iris))
    light = clear * inside + (1 - clear) * WHITE
    return np.asarray(limbus.dimmed(texels.surface_mm, texels.bearing) * light, np.float32)


def test_eyes_are_drawn_with_the_limbus_that_is_looked_for() -> None:
    """Change the one and this says what else to change."""
    source = resources.files("renderer").joinpath("shaders/tear_film.glsl").read_text("utf-8")

    def drawn(name: str) -> list[float]:
        found = re.search(rf"const \w+ {name} = (?:vec\d\()?([^;)]+)\)?;", source)
        assert found, f"tear_film.glsl no longer says {name}"
        return [float(v) for v in found[1].split(",")]

    assert drawn("LIMBAL_RING") == pytest.approx(law.RING.tolist())
    assert drawn("LIMBAL_WHITE") == pytest.approx(law.RING_ON_WHITE.tolist())
    assert drawn("LIMBAL_RING_MM") == list(law.RING_REACH_MM)
    assert drawn("PANNUS") == [law.PANNUS]
    assert drawn("LIMBUS_WANDER_MM") == [law.WANDER_MM]
    assert f"s.limbus_mm + {law.RING_INSIDE_MM}" in source
    assert f"min(off / {law.ON_WHITE_MM}," in source
    assert f"{law.WANDER_WIDTH} * wander" in source


def test_the_law_is_the_drawn_limbus(gl: moderngl.Context, level_pose: Pose) -> None:
    """Measured on a rendered eye whose place is known: edge, ring and the white's hue."""
    spec = ClipSpec(
        left=Detail.uniform("ultra"), right=Detail.uniform("off"), iris_colour="dark-brown"
    )
    photo = developed(portrait(gl, spec, size_px=500))
    pose = dataclasses.replace(level_pose, x=249.5, y=249.5, px_per_mm=500 / 14, distance_mm=400.0)
    texels = place_texels(pose, 512)
    linear = decode_srgb(photo / 255.0).astype(np.float32)
    limbus, white = find_limbus(sample(linear, texels), texels)
    assert mean_edge_mm(limbus) == pytest.approx(EDGE_MM, abs=0.015)
    assert limbus.width_mm == pytest.approx(LIMBUS_WIDTH_MM, abs=0.03)
    assert limbus.ring == pytest.approx(1.0, abs=0.08)
    assert 0.3 < np.std(limbus.wander) < 1.2
    assert white / white[1] == pytest.approx(SCLERA / SCLERA[1], rel=0.02)


@pytest.mark.parametrize("iris", [BLUE, PALE, DARK])
@pytest.mark.parametrize("ring", [0.6, 1.0, 1.3])
def test_edge_and_ring_are_told_apart(texels: Texels, iris: tuple[float, ...], ring: float) -> None:
    truth = Limbus(5.70, 0.15, ring)
    limbus, _ = find_limbus(shown(texels, truth, iris), texels)
    assert mean_edge_mm(limbus) == pytest.approx(5.70, abs=0.04)
    assert limbus.ring == pytest.approx(ring, abs=0.2)


def test_the_edge_is_followed_where_it_wanders(texels: Texels) -> None:
    at = np.arange(SECTORS) / SECTORS * 2 * np.pi
    wander = 1.2 * np.sin(3 * at) + 0.6 * np.cos(8 * at)
    truth = Limbus(wander=tuple(wander))
    colour = shown(texels, truth, BLUE)
    lid = texels.surface_mm * np.sin(texels.bearing) > 4.6
    colour[lid] = (0.5, 0.35, 0.28)
    limbus, _ = find_limbus(colour, texels)
    free = np.sin(at) < 0.7
    assert np.corrcoef(wander[free], np.array(limbus.wander)[free])[0, 1] > 0.95
    assert np.abs(np.array(limbus.wander)[free] - wander[free]).mean() < 0.4
    hidden = np.sin(at) > 0.9
    assert np.abs(np.array(limbus.wander)[hidden]).max() < 0.8, "a lid is no edge"


@pytest.mark.parametrize("iris", [BLUE, PALE, DARK])
def test_half_of_the_light_lies_outside_of_half_of_the_tissue(iris: tuple[float, ...]) -> None:
    y, x = np.mgrid[:560, :600].astype(np.float64)
    r, bearing = np.hypot(x - 300, y - 280) / 40, np.arctan2(280 - y, x - 300)
    limbus = Limbus()
    clear = limbus.clear(r, bearing)[..., None]
    light = limbus.dimmed(r, bearing) * (clear * np.array(iris) + (1 - clear) * WHITE)
    red = (0.6 * light[..., 0] + 0.4 * light[..., 1]).astype(np.float32)
    points = edge_points(red, (300.0, 280.0), 234.0, reach=(0.82, 1.18), level=LIMBUS_LEVEL)
    away = np.hypot(*(points - [300.0, 280.0]).T) / 40
    side = np.abs(points[:, 1] - 280) < 40
    top = np.abs(points[:, 0] - 300) < 40
    assert away[side].mean() == pytest.approx(half_way_mm(0.0), abs=0.035)
    assert away[top].mean() == pytest.approx(half_way_mm(np.pi / 2), abs=0.035)
    assert half_way_mm(np.pi / 2) > half_way_mm(0.0) > EDGE_MM + 0.1


def test_the_limbus_veil_is_lifted(texels: Texels) -> None:
    veil = 0.02  # mirrored everywhere
    colour = shown(texels, Limbus(5.72, 0.14, 0.9), BLUE) + np.float32(veil)
    limbus, white = find_limbus(colour, texels)
    bare = lift_veils(colour, texels, limbus=limbus, white=white)
    ring = (texels.radius_mm > 2.3) & (texels.surface_mm < 5.3)
    expected = np.array(BLUE) / texels.transmitted[ring][:, None]
    np.testing.assert_allclose(bare[ring], expected, rtol=0.1)
