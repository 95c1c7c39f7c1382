"""One eye of one LoD on the GPU: its program, its mesh and every uniform that stays for a clip.

A LoD's levels become constants of its program, so an effect that is off costs nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.anatomy import shader_constants
from renderer.eye.calibration import calibrated_gain, open_lids
from renderer.eye.flat_iris import flat_iris
from renderer.eye.kept import Kept, Same, fingerprint
from renderer.eye.lids import LidRims
from renderer.eye.maps import iris_values, sclera_values, tissue_constants
from renderer.eye.place import eye_centre_mm
from renderer.eye.silhouette import (
    Outline,
    Shaded,
    Silhouette,
    detail_mesh,
    hull_mesh,
    vertex_array,
)
from renderer.eye.subsurface import DEPTH_MARGIN, MAX_DEPTH_MM, MIN_LIGHT_COSINE
from renderer.eye.sunlight import (
    RELIEF_SHADE_PX,
    relief_shade_map,
    rims_texture,
    scattered_sun,
    shade_map,
    sunlight_values,
)
from renderer.gl.assembly import detail_constants
from renderer.gl.program import Program, build_program
from renderer.gl.uniforms import constant
from renderer.iris.source import iris_of
from renderer.light import Light
from renderer.spherical_harmonics import terms_irradiance

Array = npt.NDArray[np.float64]

CHAMBER_PX: Final = 32  # ambient light varies slowly over the iris

# Iris maps hold colours as photographs show them: through a cornea, half flash, half sky. Under a
# flash the cornea returns 0.57 of what a bare iris would, under a sky nearly all of it.
APPARENT_GAIN: Final = 1.3


@dataclass
class EyeModel:
    """One eye: its program, mesh and every uniform that stays for the clip.

    ``silhouette`` is there where the fine mesh only places the silhouette: ``mesh`` is then a
    coarse hull of the globe, shaded into ``shaded``, a picture of its own. Where an eye blends, a
    coarse mesh is shaded into it too.
    """

    detail: Detail
    program: Program
    mesh: moderngl.VertexArray
    values: dict[str, Any]
    shaded: Shaded
    outline: Outline
    silhouette: Silhouette | None = None


def build_model(
    gl: moderngl.Context,
    eye: int,
    *,
    detail: Detail,
    spec: ClipSpec,
    rims: LidRims,
    light: Light,
    cubes: dict[str, moderngl.TextureCube],
    has_face: bool,
    kept: Kept,
) -> EyeModel:
    """Build the viewer's left (0) or right (1) eye with a LoD's levels in its light."""
    constants = eye_constants(detail, spec) | {"OWN_FACE": int(has_face)}
    program = kept.get(
        ("eye.frag", *sorted(constants.items())),
        lambda: build_program(gl, "eye.vert", fragment="eye.frag", constants=constants),
    )
    turn = gaze_rotation(*spec.gaze_deg(eye))
    is_gathered = detail.caustics in {"high", "ultra"} and spec.caustic_pattern == "computed"
    mirror = 1.0 if eye == 0 else -1.0
    gain = APPARENT_GAIN if is_gathered else 1.0
    map_px = min(CHAMBER_PX, int(detail.setting("texture", "iris_map_px")))
    iris, flat_px = iris_of(spec), CHAMBER_PX
    albedo = gain * kept.get(
        ("flat iris", iris, map_px, spec.pupil_mm, flat_px, mirror),
        lambda: flat_iris(iris.maps(map_px), spec.pupil_mm, size_px=flat_px, mirror=mirror),
    )
    placed = {
        **light.uniforms(),
        "u_lid_rims": rims_texture(gl, rims),
        "u_eye_to_world": _placed(turn, eye_centre_mm(eye)),
    }
    rims_and_place = (rims.upper_mm, rims.lower_mm, placed["u_eye_to_world"])
    values = {
        **placed,
        **cubes,
        **iris_values(
            gl, spec, detail, sun_eye=np.asarray(light.sky.sun_direction) @ turn, kept=kept
        ),
        **sclera_values(gl, spec, detail, kept=kept),
        **sunlight_values(
            gl,
            detail,
            light.sky,
            eye_to_world=turn,
            rims=rims,
            albedo=albedo,
            caustic_pattern=spec.caustic_pattern,
            kept=kept,
        ),
        **_shades(gl, placed, kept=kept, key=(Same(light), fingerprint(*rims_and_place))),
        "u_plane_irradiance": terms_irradiance(placed["u_ambient_terms"], turn[:, 2]),
        "u_mirror": mirror,
        "u_iris_gain": np.full(3, gain),
    }
    values["u_relief_shade"] = relief_shade_map(
        gl, values, constants=constants, size_px=RELIEF_SHADE_PX.get(detail.texture, 0)
    )
    is_fine = detail.setting("tessellation", "normals") == "analytic"
    mesh = vertex_array(gl, program, hull_mesh() if is_fine else detail_mesh(detail))
    if spec.preset == "calibrated":
        values["u_iris_gain"] = calibrated_gain(
            gl,
            program,
            mesh=mesh,
            values=values,
            open_rims=rims_texture(gl, open_lids()),
            mean_albedo=np.asarray(values["u_iris_mean"]),
            albedo=albedo,
        )
    values = {
        name: constant(value) if isinstance(value, np.ndarray) else value
        for name, value in values.items()
    }
    shaded = Shaded(rims)
    silhouette = Silhouette(gl, detail_mesh(detail)) if is_fine else None
    return EyeModel(
        detail, program, mesh, values, shaded, Outline(gl, detail_mesh(detail)), silhouette
    )


def _shades(
    gl: moderngl.Context, placed: dict[str, Any], *, kept: Kept, key: tuple[object, ...]
) -> dict[str, Any]:
    """Return the maps of sun and sky on the globe, which every LoD of an eye reads.

    With the head's shadow, which the key keeps: it counts too.
    """

    def made() -> dict[str, Any]:
        shade = shade_map(gl, placed)
        return {
            "u_shade_map": shade,
            "u_scattered_sun": scattered_sun(gl, shade),
            "u_sun_shadow": placed["u_sun_shadow"],
        }

    return kept.get(("shade", *key), made)


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
