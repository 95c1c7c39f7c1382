"""What eyes of the crowd share on the GPU: a program and mesh per LoD, textures per LoD and iris.

Made when a frame first asks for them: most crowds never show a large eye.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any, Final

import moderngl
import numpy as np

from renderer.cache import cached_array
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.anatomy import shader_constants
from renderer.eye.caustics import caustic_map
from renderer.eye.geometry import Mesh, eye_mesh
from renderer.eye.maps import iris_values, sclera_values
from renderer.eye.model import APPARENT_GAIN, eye_constants
from renderer.eye.silhouette import vertex_array
from renderer.frame.outlines import EYE
from renderer.gl.program import Program, build_program
from renderer.iris.source import Iris

# Six irises for everybody; half a second each to make at this size.
IRIS_PX: Final = 512
IRISES: Final = {
    name: Iris(seed, name, "", "", IRIS_PX)
    for seed, name in enumerate(("blue", "grey", "green", "hazel", "brown", "dark-brown"), 11)
}
PUPIL_MM: Final = 3.6
CAUSTIC_PX: Final = 128
CAUSTIC_STEP_DEG: Final = 10.0
CAUSTIC_LAYERS: Final = 11  # up to 100 degrees; beyond, no light enters
SWAPPED: Final = {"eye_place.glsl": "crowd_place.glsl", "eye_chamber.glsl": "crowd_chamber.glsl"}
_SPEC: Final = ClipSpec(left=Detail(), right=Detail(), pupil_mm=PUPIL_MM)


Kind = tuple[Detail, str]  # LoD as ``crowd_detail`` has it, and iris


@dataclass(frozen=True)
class Run:
    """Eyes of one kind whose records lie side by side, and are drawn together."""

    kind: Kind
    first: int
    count: int


class EyeGroups:
    """Programs, meshes and textures of the crowd's eyes: ``draw`` draws those of each kind."""

    def __init__(
        self, gl: moderngl.Context, static_cube: Callable[[int], moderngl.TextureCube]
    ) -> None:
        self._gl = gl
        self._static_cube = static_cube
        self._kinds: dict[Detail, tuple[Program, moderngl.VertexArray, dict[str, Any]]] = {}
        self._irises: dict[tuple[Detail, str], dict[str, Any]] = {}
        self._caustics: moderngl.TextureArray | None = None
        self._outline = build_program(
            gl, "crowd_eye.vert", fragment="mark.frag", constants=shader_constants()
        )
        self._bare: dict[Detail, moderngl.VertexArray] = {}

    def prepare(self, kinds: Iterable[Kind]) -> None:
        """Make what kinds of eyes need, in a state of its own: a cube may draw itself first."""
        missing = [kind for kind in kinds if kind not in self._irises]
        if not missing:
            return
        target = self._gl.fbo
        for detail, iris in missing:
            if detail not in self._kinds:
                self._kinds[detail] = self._kind(detail)
            self._irises[detail, iris] = self._iris(detail, iris)
        target.use()
        self._gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)

    def draw(self, runs: Iterable[Run], values: dict[str, Any]) -> None:
        """Draw eyes of kinds that are prepared, those of one LoD one after the other."""
        for detail, same in groupby(runs, key=lambda run: run.kind[0]):
            program, mesh, shared = self._kinds[detail]
            program.set(**shared, **values)
            for run in same:
                program.set(**self._irises[run.kind], u_first_eye=run.first)
                mesh.render(instances=run.count)

    def draw_outlines(self, runs: Iterable[Run], values: dict[str, Any]) -> None:
        """Draw the same eyes as bare triangles that mark their samples."""
        self._outline.set(**values, u_mark=EYE / 255.0)
        for detail, same in groupby(runs, key=lambda run: run.kind[0]):
            if detail not in self._bare:
                self._bare[detail] = vertex_array(self._gl, self._outline, crowd_mesh(detail))
            together = list(same)
            self._outline.set(u_first_eye=together[0].first)
            self._bare[detail].render(instances=sum(run.count for run in together))

    def _kind(self, detail: Detail) -> tuple[Program, moderngl.VertexArray, dict[str, Any]]:
        constants = eye_constants(detail, _SPEC) | {
            "OWN_FACE": 0,  # it would be another one for every eye
            "CAUSTIC_STEP_DEG": CAUSTIC_STEP_DEG,
        }
        program = build_program(
            self._gl, "crowd_eye.vert", fragment="eye.frag", constants=constants, swapped=SWAPPED
        )
        is_gathered = detail.caustics in {"high", "ultra"}
        shared = sclera_values(self._gl, _SPEC, detail)
        shared["u_iris_gain"] = np.full(3, APPARENT_GAIN if is_gathered else 1.0)
        if size := int(detail.setting("reflection", "cube_px")):
            shared["u_static_cube"] = self._static_cube(size)
        if is_gathered or detail.refraction in {"high", "ultra"}:
            shared["u_caustic_pool"] = self._caustic_pool()
        return program, vertex_array(self._gl, program, crowd_mesh(detail)), shared

    def _iris(self, detail: Detail, iris: str) -> dict[str, Any]:
        # The layers' gain is that of light from in front and above, whoever looks wherever.
        frontal = np.array([0.0, 0.5, 0.87])
        return iris_values(self._gl, _SPEC, detail, sun_eye=frontal, source=IRISES[iris])

    def _caustic_pool(self) -> moderngl.TextureArray:
        if self._caustics is None:
            layers = cached_array(
                f"crowd caustics {CAUSTIC_PX} {CAUSTIC_STEP_DEG} {CAUSTIC_LAYERS}", caustic_layers
            )
            data = np.concatenate([layers, np.ones_like(layers[..., :1])], axis=-1)
            size = (CAUSTIC_PX, CAUSTIC_PX, CAUSTIC_LAYERS)
            texture = self._gl.texture_array(size, 4, data.astype("f2").tobytes(), dtype="f2")
            texture.repeat_x = texture.repeat_y = False
            texture.build_mipmaps()
            texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
            self._caustics = texture
        return self._caustics


def caustic_layers() -> Any:
    """Return caustic maps (k, n, n, 3) for a sun ever farther from the gaze, towards +x."""
    angles = np.radians(np.arange(CAUSTIC_LAYERS) * CAUSTIC_STEP_DEG)
    suns = np.stack([np.sin(angles), np.zeros_like(angles), np.cos(angles)], axis=1)
    return np.stack([caustic_map(sun, CAUSTIC_PX) for sun in suns])


def crowd_mesh(detail: Detail) -> Mesh:
    """Return a LoD's mesh as the crowd has it: a step coarser where normals come from the formula.

    Lids hide these globes' silhouettes, and the view ray meets the formula's surface under any
    mesh; fine triangles, smaller than a pixel here, would be all of the cost.
    """
    triangles = int(detail.setting("tessellation", "triangles"))
    normals = detail.setting("tessellation", "normals")
    return eye_mesh(
        triangles // 4 if normals == "analytic" else triangles, facets=normals == "facet"
    )


def crowd_detail(detail: Detail) -> Detail:
    """Return a LoD as the crowd has it: nobody but the main character mirrors moving people."""
    if detail.reflection == "ultra":
        return replace(detail, reflection="high")
    return detail
