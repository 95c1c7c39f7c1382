"""Eyes on the GPU for tests: a bench that lights them and reads their linear radiance."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, ClassVar

import moderngl
import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye import maps as eye_maps
from renderer.eye import model as eye_module
from renderer.eye import sunlight
from renderer.eye.caustics import caustic_map
from renderer.eye.eyes import Eyes
from renderer.eye.lids import LidRims
from renderer.eye.micro_relief import micro_relief_tile
from renderer.eye.models import EyeModels
from renderer.eye.place import eye_centre_mm
from renderer.eye.sclera import ScleraMaps
from renderer.eye.subsurface import Tissue
from renderer.gl.program import Program, build_program
from renderer.iris.maps import IrisMaps
from renderer.iris.source import Iris, iris_of
from renderer.light import Light, Sky
from renderer.view import look_at, perspective

ALBEDO = np.array([0.3, 0.2, 0.1], np.float32)
TISSUE = Tissue(np.full((4, 3), 3.0), np.full((4, 3), 5.0), np.full(4, 0.3))
OPEN = LidRims(*(np.array([[-40.0, y, 0.0], [40.0, y, 0.0]]) for y in (60.0, -60.0)))
OFF = Detail.uniform("off")
DISTANCE_MM = 6000.0
IRIS_PX = 256
FLAT_PX = 128
CAUSTIC_PX = 512
HALF_MM = 7.0  # half the picture's height at the eye


def flat_iris(n: int) -> IrisMaps:
    """An even iris, brighter towards +x, without relief; n texels a side."""
    ramp = (1 + 0.4 * np.linspace(-1, 1, n, dtype=np.float32))[None, :, None]
    ramp = ramp if n > 1 else np.ones((1, 1, 1), np.float32)
    return IrisMaps(
        albedo=np.broadcast_to(ramp * ALBEDO, (n, n, 3)),
        normal=np.broadcast_to(np.array([0, 0, 1], np.float32), (n, n, 3)),
        height_mm=np.zeros((n, n), np.float32),
        thickness_mm=np.broadcast_to(np.array([0.05, 0.15, 0.15, 0.05], np.float32), (n, n, 4)),
        cavity=np.ones((n, n), np.float32),
    )


class FlatIris:
    """What ``iris_of`` returns, for an iris whose answers are known."""

    mean_albedo = ALBEDO
    mean_thickness_mm = np.array([0.05, 0.15, 0.15, 0.05], np.float32)
    tissue = TISSUE

    def maps(self, size_px: int) -> IrisMaps:
        return flat_iris(min(size_px, FLAT_PX))


def flat_sclera(_seed: int, *, size_px: int) -> ScleraMaps:
    shape = (min(size_px, 4),) * 2 + (3,)
    return ScleraMaps(
        albedo=np.full(shape, 0.6, np.float32),
        normal=np.broadcast_to(np.array([0, 0, 1], np.float32), shape),
    )


tile = cache(micro_relief_tile)


@dataclass
class Bench:
    """Eyes under a chosen light, and their linear radiance."""

    gl: moderngl.Context
    half_mm: ClassVar[float] = HALF_MM

    def eyes(
        self,
        left: Detail,
        right: Detail = OFF,
        *,
        sun: float = 0.0,
        sky: float = 1.0,
        rims: tuple[LidRims, LidRims] = (OPEN, OPEN),
        toward_sun: tuple[float, float, float] = (-0.5, 0.5, math.sqrt(0.5)),
        has_crowd: bool = True,
        **spec: Any,
    ) -> Eyes:
        ambient = np.zeros((9, 3))
        ambient[0] = sky / 0.282095
        lit = self.gl.texture((1, 1), 1, np.ones(1, np.float32).tobytes(), dtype="f4")
        light = Light(
            Sky(np.array(toward_sun), np.full(3, sun), ambient), lit, np.eye(4, dtype=np.float32)
        )
        mirrored = np.full((6, 4), sky, np.float16).tobytes()
        nobody = np.zeros((6, 4), np.float16).tobytes()
        return Eyes(
            self.gl,
            EyeModels(
                self.gl,
                ClipSpec(left=left, right=right, **spec),
                rims=rims,
                light=light,
                static_cube=lambda _size: self.gl.texture_cube((1, 1), 4, mirrored, dtype="f2"),
                crowd_cube=self.gl.texture_cube((1, 1), 4, nobody, dtype="f2")
                if has_crowd
                else None,
            ),
        )

    def picture(
        self, eyes: Eyes, eye: int = 0, *, size: tuple[int, int] = (64, 64), azimuth_deg: float = 0
    ) -> np.ndarray:
        """Return linear radiance (height, width, 3), row 0 at the bottom, from far away."""
        turn = math.radians(azimuth_deg)
        centre = eye_centre_mm(eye)
        camera = centre + DISTANCE_MM * np.array([math.sin(turn), 0.0, math.cos(turn)])
        fov_deg = 2 * math.degrees(math.atan(HALF_MM / (DISTANCE_MM - 10)))
        target = self.gl.framebuffer(
            [self.gl.texture(size, 4, dtype="f4")], self.gl.depth_texture(size)
        )
        target.use()
        target.clear()
        eyes.draw(
            eye,
            view_matrix=look_at(camera, centre),
            projection=perspective(fov_deg, size[0] / size[1], 5000, 7000),
            camera_mm=camera,
        )
        pixels = np.frombuffer(target.read(components=3, dtype="f4"), np.float32)
        return pixels.reshape(size[1], size[0], 3)

    def radius_mm(self, pixels: np.ndarray) -> np.ndarray:
        """Return each pixel's distance from the picture's middle."""
        n = len(pixels)
        return np.hypot(*(np.indices((n, n)) - (n - 1) / 2)) * 2 * HALF_MM / n


def small_iris(spec: ClipSpec) -> Iris:
    """A clip's own iris from maps of at most IRIS_PX a side: a quick bake."""
    return replace(iris_of(spec), base_px=IRIS_PX)


@pytest.fixture(scope="session")
def bakes(tmp_path_factory: pytest.TempPathFactory) -> str:
    """One folder for all that these tests bake: keys tell the bakes apart."""
    return str(tmp_path_factory.mktemp("bakes"))


@pytest.fixture(scope="session")
def programs() -> dict[Any, Program]:
    """Programs by their header: compiling one costs more than drawing with it."""
    return {}


@pytest.fixture
def small(
    bakes: str, programs: dict[Any, Program], monkeypatch: pytest.MonkeyPatch
) -> pytest.MonkeyPatch:
    """Share bakes and programs between tests; bake what does not matter here at small sizes."""

    def shared(gl: moderngl.Context, vertex: str, *, fragment: str, constants: Any) -> Program:
        key = (vertex, fragment, *sorted(constants.items()))
        if key not in programs:
            programs[key] = build_program(gl, vertex, fragment=fragment, constants=constants)
        return programs[key]

    monkeypatch.setenv("OCULARIST_CACHE", bakes)
    monkeypatch.setattr(eye_module, "build_program", shared)
    monkeypatch.setattr(sunlight, "build_program", shared)
    monkeypatch.setattr(
        sunlight, "caustic_map", lambda sun, size: caustic_map(sun, min(size, CAUSTIC_PX))
    )
    monkeypatch.setattr(eye_maps, "micro_relief_tile", tile)
    monkeypatch.setattr(eye_maps, "sclera_maps", flat_sclera)
    monkeypatch.setattr(eye_maps.sclera, "mean_albedo", lambda *_: np.full(3, 0.6))
    monkeypatch.setattr(eye_module, "iris_of", small_iris)
    monkeypatch.setattr(eye_module, "CHAMBER_PX", 16)
    monkeypatch.setattr(eye_module, "RELIEF_SHADE_PX", {"high": 256, "ultra": 256})
    monkeypatch.setattr(sunlight, "SHADE_MAP_PX", 64)
    return monkeypatch


@pytest.fixture
def bench(gl: moderngl.Context, small: pytest.MonkeyPatch) -> Bench:
    small.setattr(eye_maps, "iris_of", lambda _spec: FlatIris())
    return Bench(gl)


@pytest.fixture
def real_bench(gl: moderngl.Context, small: pytest.MonkeyPatch) -> Bench:
    """The bench with the irises that clips show."""
    small.setattr(eye_maps, "iris_of", small_iris)
    return Bench(gl)
