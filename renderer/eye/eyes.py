"""Both eyes on the GPU: one program and one set of textures per eye, drawn in one pass each.

A LoD's levels become constants of its program, so an effect that is off costs nothing. Everything
that does not change within a clip (maps, light inside the eye) is made here once.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.camera import eye_centre_mm, gaze_deg
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.anatomy import shader_constants
from renderer.eye.calibration import calibrated_gain, open_lids
from renderer.eye.flat_iris import flat_iris
from renderer.eye.lids import LidRims
from renderer.eye.maps import iris_values, sclera_values, tissue_constants
from renderer.eye.silhouette import Silhouette, detail_mesh, hull_mesh, vertex_array
from renderer.eye.subsurface import DEPTH_MARGIN, MAX_DEPTH_MM, MIN_LIGHT_COSINE
from renderer.eye.sunlight import (
    RELIEF_SHADE_PX,
    relief_shade_map,
    rims_texture,
    scattered_sun,
    shade_map,
    sunlight_values,
)
from renderer.iris.source import iris_of
from renderer.light import Light
from renderer.program import Program, build_program, detail_constants

Array = npt.NDArray[np.float64]

CHAMBER_PX: Final = 32  # ambient light varies slowly over the iris

# Iris maps hold colours as photographs show them: through a cornea, half flash, half sky. Under a
# flash the cornea returns 0.57 of what a bare iris would, under a sky nearly all of it.
APPARENT_GAIN: Final = 1.3


@dataclass
class EyeModel:
    """One eye: its program, mesh and every uniform that stays for the clip.

    ``silhouette`` is there where the fine mesh only places the silhouette: ``mesh`` is then a
    coarse hull of the globe, shaded into a picture of its own.
    """

    program: Program
    mesh: moderngl.VertexArray
    values: dict[str, Any]
    silhouette: Silhouette | None = None


class Eyes:
    """The eyes of a clip. ``rims``, like everything here, are the viewer's left, then right."""

    def __init__(
        self,
        gl: moderngl.Context,
        spec: ClipSpec,
        *,
        rims: tuple[LidRims, LidRims],
        light: Light,
        static_cube: Callable[[int], moderngl.TextureCube],
        crowd_cube: moderngl.TextureCube | None,
        has_face: bool = True,
    ) -> None:
        """Build both eyes in their light; ``static_cube`` gives the surroundings at a size.

        Without a face (``has_face``) they mirror all of the surroundings.
        """
        self._gl = gl
        self._has_face = has_face
        self.models = tuple(
            self._build(
                eye,
                detail,
                spec,
                rims=rims[eye],
                light=light,
                cubes=_cubes(detail, static_cube, crowd_cube),
            )
            for eye, detail in enumerate((spec.left, spec.right))
        )

    def draw(self, eye: int, *, view_matrix: Any, projection: Any, camera_mm: Any) -> None:
        """Draw the viewer's left (0) or right (1) eye, opaque and depth-tested."""
        model = self.models[eye]
        camera = {"u_view_matrix": view_matrix, "u_projection": projection}
        if model.silhouette and model.silhouette.camera is not camera_mm:
            self.shade(eye, view_matrix=view_matrix, projection=projection, camera_mm=camera_mm)
        self._gl.enable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        if model.silhouette:
            model.silhouette.draw(camera | {"u_eye_to_world": model.values["u_eye_to_world"]})
        else:
            self._set(eye, camera, camera_mm)
            model.mesh.render()

    def shade(self, eye: int, *, view_matrix: Any, projection: Any, camera_mm: Any) -> None:
        """Prepare ``draw`` for a camera, outside of its queries and wire frames.

        The picture goes to a target of its own, as large as the current viewport. ``draw`` does
        this itself for a camera that was not announced; levels that need nothing do nothing.
        """
        silhouette = self.models[eye].silhouette
        if silhouette is None:
            return
        target, wireframe = self._gl.fbo, self._gl.wireframe
        self._set(eye, {"u_view_matrix": view_matrix, "u_projection": projection}, camera_mm)
        placed = np.asarray(view_matrix) @ self.models[eye].values["u_eye_to_world"]
        silhouette.begin(self._gl, target.viewport, eye_to_clip=np.asarray(projection) @ placed)
        self._gl.wireframe = False
        self._gl.enable_only(moderngl.CULL_FACE)
        self.models[eye].mesh.render()
        self._gl.wireframe = wireframe
        self._gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        target.use()
        silhouette.camera = camera_mm

    def _set(self, eye: int, camera: dict[str, Any], camera_mm: Any) -> None:
        distance_mm = float(np.linalg.norm(np.asarray(camera_mm) - eye_centre_mm(eye)))
        lines = self._gl.fbo.viewport[3]
        self.models[eye].program.set(
            **self.models[eye].values,
            **camera,
            u_camera_mm=camera_mm,
            u_mm_per_px=2 * distance_mm / (float(camera["u_projection"][1][1]) * lines),
        )

    def is_active(self, eye: int, uniform: str) -> bool:
        """Whether the eye's program still reads a uniform: off levels leave none behind."""
        return self.models[eye].program.is_active(uniform)

    def _build(
        self,
        eye: int,
        detail: Detail,
        spec: ClipSpec,
        *,
        rims: LidRims,
        light: Light,
        cubes: dict[str, moderngl.TextureCube],
    ) -> EyeModel:
        constants = eye_constants(detail, spec) | {"OWN_FACE": int(self._has_face)}
        program = build_program(self._gl, "eye.vert", fragment="eye.frag", constants=constants)
        turn = gaze_rotation(*gaze_deg(spec, eye))
        is_gathered = detail.caustics in {"high", "ultra"} and spec.caustic_pattern == "computed"
        mirror = 1.0 if eye == 0 else -1.0
        gain = APPARENT_GAIN if is_gathered else 1.0
        map_px = min(CHAMBER_PX, int(detail.setting("texture", "iris_map_px")))
        iris = iris_of(spec).maps(map_px)
        albedo = gain * flat_iris(iris, spec.pupil_mm, size_px=CHAMBER_PX, mirror=mirror)
        placed = {
            **light.uniforms(),
            "u_lid_rims": rims_texture(self._gl, rims),
            "u_eye_to_world": _placed(turn, eye_centre_mm(eye)),
        }
        values = {
            **placed,
            **cubes,
            **iris_values(
                self._gl, spec, detail, sun_eye=np.asarray(light.sky.sun_direction) @ turn
            ),
            **sclera_values(self._gl, spec, detail),
            **sunlight_values(
                self._gl,
                detail,
                light.sky,
                eye_to_world=turn,
                rims=rims,
                albedo=albedo,
                caustic_pattern=spec.caustic_pattern,
            ),
            "u_shade_map": shade_map(self._gl, placed),
            "u_mirror": mirror,
            "u_iris_gain": np.full(3, gain),
        }
        values["u_scattered_sun"] = scattered_sun(self._gl, values["u_shade_map"])
        values["u_relief_shade"] = relief_shade_map(
            self._gl, values, constants=constants, size_px=RELIEF_SHADE_PX.get(detail.texture, 0)
        )
        is_fine = detail.setting("tessellation", "normals") == "analytic"
        mesh = vertex_array(self._gl, program, hull_mesh() if is_fine else detail_mesh(detail))
        if spec.preset == "calibrated":
            values["u_iris_gain"] = calibrated_gain(
                self._gl,
                program,
                mesh=mesh,
                values=values,
                open_rims=rims_texture(self._gl, open_lids()),
                mean_albedo=np.asarray(values["u_iris_mean"]),
                albedo=albedo,
            )
        silhouette = Silhouette(self._gl, detail_mesh(detail), rims=rims) if is_fine else None
        return EyeModel(program, mesh, values, silhouette)


def eye_constants(detail: Detail, spec: ClipSpec) -> dict[str, int | float]:
    """Return the header of an eye's program: levels, their settings, the eye's numbers."""
    samples = spec.subsurface_samples or int(detail.setting("subsurface", "samples"))
    return {
        **detail_constants(detail),
        **shader_constants(),
        **tissue_constants(),
        "SUBSURFACE_NODES": int(detail.setting("subsurface", "nodes")),
        "SUBSURFACE_SAMPLES": samples,
        "SUBSURFACE_LEFT_SUM": int(spec.subsurface_samples > 0),
        "CAUSTICS_PAINTED": int(spec.caustic_pattern == "painted"),
        "MAX_DEPTH_MM": MAX_DEPTH_MM,
        "DEPTH_MARGIN": DEPTH_MARGIN,
        "MIN_LIGHT_COSINE": MIN_LIGHT_COSINE,
    }


def gaze_rotation(yaw_deg: float, pitch_deg: float) -> Array:
    """Return the eye-to-world rotation (3, 3): yaw to the viewer's right, pitch upwards."""
    yaw, pitch = math.radians(yaw_deg), math.radians(pitch_deg)
    forward = np.array(
        [math.sin(yaw) * math.cos(pitch), math.sin(pitch), math.cos(yaw) * math.cos(pitch)]
    )
    right = np.array([math.cos(yaw), 0.0, -math.sin(yaw)])
    return np.column_stack([right, np.cross(forward, right), forward])


def _placed(turn: Array, centre_mm: Array) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, centre_mm
    return matrix


def _cubes(
    detail: Detail,
    static_cube: Callable[[int], moderngl.TextureCube],
    crowd_cube: moderngl.TextureCube | None,
) -> dict[str, moderngl.TextureCube]:
    """Return the cubes that a LoD mirrors; raises ValueError where ultra finds no crowd."""
    size = int(detail.setting("reflection", "cube_px"))
    if size == 0:
        return {}
    cubes = {"u_static_cube": static_cube(size)}
    if detail.setting("reflection", "mode") == "dynamic":
        if crowd_cube is None:
            raise ValueError("reflection=ultra mirrors moving people: it needs a crowd cube")
        cubes["u_crowd_cube"] = crowd_cube
    return cubes
