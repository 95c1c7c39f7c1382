"""A small benchmark with known figures, and a stand on the shared context and scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import moderngl
import pytest

from renderer.benchmark.result import About, Bench, Cost, Memory, Stage, Work
from renderer.benchmark.stand import Stand
from renderer.clip import ClipSpec
from renderer.crowd.group import GroupRenderer
from renderer.detail import STANDARD_LODS
from renderer.frame.frame import FrameRenderer
from renderer.gl.context import identify
from renderer.scene import Scene


def cost(part: str, **says: Any) -> Cost:
    row: dict[str, Any] = {
        "renderer": "llvmpipe",
        "size": "1920x1080",
        "distance": "macroscopic",
        "iris_px": 350.0,
        "eyes": 1,
        "ms_median": 10.0,
        "ms_mad": 0.5,
        "n": 9,
        "load": 1.5,
    }
    return Cost(part=part, **(row | says))


@pytest.fixture
def known() -> Bench:
    """A bench of every part, with invented figures."""
    about = About(
        renderer="llvmpipe",
        gl_version="4.5 Mesa",
        clock="wall time",
        size="1920x1080",
        code_version="0123456789abcdef",
        processor="a processor",
        cores=2,
        load_before=0.25,
        is_quick=False,
        seconds=600.0,
    )
    places = (("macroscopic", 350.0), ("far", 12.0))
    lods = [
        cost("lods", lod=lod, distance=distance, iris_px=iris_px, eyes=eyes,
             ms_median=50.0 * (step + 1) * eyes * (iris_px / 350) ** 0.3,
             processor_ms=5.0 * (step + 1), draw_calls=60 * eyes, reads=2)
        for distance, iris_px in places
        for eyes in (2, 1)
        for step, lod in enumerate(STANDARD_LODS)
    ]  # fmt: skip
    effects = [
        cost("effects", effect=effect, level=level, base="ultra", ms_median=ms)
        for effect, level, ms in (
            ("texture", "low", 1.0), ("texture", "ultra", 12.0), ("caustics", "high", 3.0),
            ("subsurface", "ultra", 40.0), ("reflection", "ultra", 60.0),
        )
    ]  # fmt: skip
    samples = [
        cost("samples", effect="subsurface", level="ultra", base="ultra", samples=count,
             ms_median=ms, fetches=count + 1, rms_percent=rms, bias_percent=bias)
        for count, ms, rms, bias in ((10, 20.0, 25.0, 20.0), (200, 300.0, 1.3, 1.1),
                                     (0, 40.0, 0.6, -0.02))
    ]  # fmt: skip
    cubes = [
        cost("cubes", effect="reflection", level="ultra", base="ultra", cube=kind, cube_px=size,
             ms_median=ms)
        for size, kind, ms in ((128, "static", 5.0), (128, "dynamic", 9.0),
                               (2048, "static", 8.0), (2048, "dynamic", 90.0))
    ]  # fmt: skip
    cubes += [
        cost(
            "cubes",
            lod="ultra",
            eyes=2,
            cube=choice,
            cube_px=size,
            ms_median=ms,
            processor_ms=20.0,
            draw_calls=146,
            reads=2,
        )
        for choice, size, ms in (("table", 2048, 400.0), ("auto", 256, 250.0))
    ]
    crowd = [
        cost("crowd", lod="ultra", crowd=people, distance="far", eyes=2, ms_median=80.0 + people)
        for people in (0, 30)
    ]
    crowd += [
        cost("crowd", lod="by size", crowd=people, distance="group", eyes=2 * people,
             ms_median=40.0 + people)
        for people in (5, 30)
    ]  # fmt: skip
    aims = [
        cost(
            "aims",
            lod="ultra",
            eyes=2,
            cube="table",
            cube_px=2048,
            ms_median=500.0,
            processor_ms=10.0,
            draw_calls=102,
            reads=1,
        ),
        cost(
            "aims",
            lod="by size",
            eyes=60,
            crowd=30,
            distance="group",
            ms_median=400.0,
            processor_ms=6.0,
            draw_calls=106,
            reads=1,
        ),
    ]
    return Bench(
        about=about,
        rows=[*lods, *effects, *samples, *cubes, *crowd, *aims],
        work=[
            Work(lod="low", triangles=156, pixels=5000, fetches=4.0, arithmetic=157.4),
            Work(effect="subsurface", level="ultra", base="ultra", samples=10, pixels=3000,
                 fetches=11.0, arithmetic=346.0),
            Work(effect="caustics", level="high", base="ultra", pixels=3000, fetches=2.0,
                 arithmetic=40.0),
        ],
        startup=[
            Stage(lod="ultra", cache=cache, stage=stage, seconds=seconds)
            for cache, stage, seconds in (("cold", "head", 20.0), ("cold", "eyes", 30.5),
                                          ("warm", "head", 2.0), ("warm", "eyes", 3.25))
        ],
        memory=[Memory(lod="ultra", kind="textures", megabytes=812.4)],
    )  # fmt: skip


@dataclass
class SharedStudio:
    """Renderers in the scene that all tests share: a studio of its own would build another."""

    gl: moderngl.Context
    scene: Scene

    @property
    def gl_renderer(self) -> str:
        return identify(self.gl).renderer

    def renderer(self, spec: ClipSpec, *, eyes: tuple[int, ...]) -> FrameRenderer:
        return FrameRenderer(self.gl, spec, scene=self.scene, eyes=eyes)

    def group_renderer(self, spec: ClipSpec) -> GroupRenderer:
        return GroupRenderer(self.gl, spec, surroundings=self.scene.surroundings)


@pytest.fixture
def stand(gl: moderngl.Context, standard_scene: Scene) -> Stand:
    studio: Any = SharedStudio(gl, standard_scene)
    return Stand(studio, (96, 64), rounds=2)
