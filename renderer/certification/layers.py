"""The iris's layers: the GLSL integrators against thousands of small steps in numpy.

Same thickness maps, same rays. The truth is the midpoint rule with 4000 steps, written apart from
the shader (``renderer.eye.subsurface``).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.caustics import MAP_EDGE_MM
from renderer.eye.model import eye_constants
from renderer.eye.subsurface import Path, midpoint_sum
from renderer.eye.textures import float_texture
from renderer.gl.program import Program, build_program
from renderer.iris.maps import iris_maps, scattering

Array = npt.NDArray[np.float64]

STEPS: Final = 4000
MAP_PX: Final = 512
SQUARE_MM: Final = (2.4, 4.8)  # x of a patch of the iris from the collarette to the outer zone
# View and light: straight, slanting, both slanting to opposite sides and to the same one.
DIRECTIONS_DEG: Final = ((0.0, 0.0), (35.0, 10.0), (40.0, -40.0), (30.0, 35.0))
NODES: Final = (4, 6, 8, 12, 16)
LEFT_SAMPLES: Final = (10, 20, 200)


@dataclass(frozen=True)
class LayerError:
    """One integrator's error over points, directions and channels, relative to the mean."""

    integrator: str
    fetches: int
    rms_percent: float
    bias_percent: float


def layer_errors(
    gl: moderngl.Context, *, iris_seed: int, iris_colour: str, points: int, steps: int = STEPS
) -> list[LayerError]:
    """Return the errors of ours by nodes and of the thesis's left sum by samples.

    ``points`` along each side of the patch.
    """
    wanted = [("pieces", nodes) for nodes in NODES]
    wanted += [("left sum", samples) for samples in LEFT_SAMPLES]
    return integrator_errors(
        gl,
        wanted=wanted,
        iris_seed=iris_seed,
        iris_colour=iris_colour,
        points=points,
        steps=steps,
    )


def integrator_errors(
    gl: moderngl.Context,
    *,
    wanted: Iterable[tuple[str, int]],
    iris_seed: int,
    iris_colour: str,
    points: int,
    steps: int = STEPS,
) -> list[LayerError]:
    """Return the errors of ``wanted`` integrators: ("pieces", nodes) or ("left sum", samples)."""
    # The shader reads half floats: so does the truth.
    maps = iris_maps(iris_seed, iris_colour, size_px=MAP_PX).thickness_mm.astype(np.float16)
    scene = _Scene(gl, iris_seed, iris_colour, np.asarray(maps, np.float64), points)
    truth = [scene.truth(*angles, steps=steps) for angles in DIRECTIONS_DEG]
    return [_error(kind, count, scene.drawn(kind, count), truth) for kind, count in wanted]


def _error(kind: str, count: int, drawn: list[Array], truth: list[Array]) -> LayerError:
    gaps = [d / t.mean(axis=0) - t / t.mean(axis=0) for d, t in zip(drawn, truth, strict=True)]
    gap = np.concatenate([g.ravel() for g in gaps])
    return LayerError(
        integrator=f"{kind} {count}",
        fetches=count + (1 if kind == "left sum" else 2),
        rms_percent=100 * float(np.sqrt(np.mean(gap**2))),
        bias_percent=100 * float(gap.mean()),
    )


@dataclass(frozen=True)
class _Scene:
    gl: moderngl.Context
    iris_seed: int
    iris_colour: str
    thickness: Array
    points: int

    @property
    def places_mm(self) -> Array:
        """The patch's points along one side."""
        return np.linspace(*SQUARE_MM, self.points)

    def truth(self, view_deg: float, light_deg: float, *, steps: int) -> Array:
        """Return radiance per irradiance (points^2, 3) by the midpoint rule."""
        view, light = _down(view_deg), _down(light_deg)
        tissue = scattering(self.iris_colour)
        rows = []
        for y in self.places_mm - np.mean(SQUARE_MM):
            for x in self.places_mm:
                path = Path(
                    thickness=partial(self._thickness_along, np.array([x, y]), view),
                    view_cosine=-view[2],
                    light_cosine=-light[2],
                    phase_cosine=float(light @ -view),
                )
                rows.append(midpoint_sum(path, tissue, samples=steps))
        return np.array(rows)

    def drawn(self, kind: str, count: int) -> list[Array]:
        """Return the same from the shader for each of DIRECTIONS_DEG."""
        samples = count if kind == "left sum" else 0
        detail = Detail.uniform("ultra")
        constants = eye_constants(
            detail, ClipSpec(left=detail, right=detail, subsurface_samples=samples)
        )
        if not samples:
            constants["SUBSURFACE_NODES"] = count
        program = build_program(
            self.gl, "screen.vert", fragment="subsurface_probe.frag", constants=constants
        )
        tissue = scattering(self.iris_colour)
        values: dict[str, Any] = {
            "u_thickness": float_texture(self.gl, self.thickness),
            "u_sigma_s": tissue.sigma_s.T,
            "u_sigma_t": tissue.sigma_t.T,
            "u_anisotropy": tissue.anisotropy,
            "u_mirror": 1.0,
            "u_mm_per_px": 1e-3,  # the finest level of the maps: the hardest case
            "u_probe_origin_mm": (SQUARE_MM[0], SQUARE_MM[0] - np.mean(SQUARE_MM)),
            "u_probe_step_mm": (SQUARE_MM[1] - SQUARE_MM[0]) / (self.points - 1),
        }
        return [
            self._picture(
                program, values | {"u_probe_view": _down(view), "u_probe_light": _down(light)}
            )
            for view, light in DIRECTIONS_DEG
        ]

    def _picture(self, program: Program, values: dict[str, Any]) -> Array:
        program.set(**values)
        size = (self.points, self.points)
        target = self.gl.framebuffer([self.gl.texture(size, 4, dtype="f4")])
        with self.gl.scope(target, moderngl.NOTHING):
            self.gl.vertex_array(program.gl_program, []).render(moderngl.TRIANGLES, vertices=3)
        pixels = np.frombuffer(target.read(components=3, dtype="f4"), np.float32)
        return pixels.reshape(-1, 3).astype(np.float64)

    def _thickness_along(self, start_mm: Array, view: Array, along_mm: Array) -> Array:
        """Return the layers (n, 4) at distances (n,) along a ray from a point of the maps."""
        x, y = start_mm[:, None] + view[:2, None] * along_mm
        texel = np.stack([y, x]) * (MAP_PX / (2 * MAP_EDGE_MM)) + (MAP_PX - 1) / 2
        layers = [
            ndimage.map_coordinates(layer, texel, order=1, mode="nearest")
            for layer in np.moveaxis(self.thickness, -1, 0)
        ]
        return np.stack(layers, axis=-1)


def _down(angle_deg: float) -> Array:
    """Return a unit direction into the iris, turned towards +x."""
    angle = math.radians(angle_deg)
    return np.array([math.sin(angle), 0.0, -math.cos(angle)])
