"""The preset "calibrated": every LoD's iris as bright and as coloured as its map, in diffuse light.

An effect changes an iris's mean colour as well as its looks. Where a study asks about looks alone,
each eye is measured once, seen along its gaze under a uniform sky with nothing to mirror, and
scaled per channel so that the iris's mean equals the map's.
"""

from __future__ import annotations

import math
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import IRIS_Z_MM
from renderer.eye.caustics import MAP_EDGE_MM
from renderer.eye.chamber import chamber_irradiance
from renderer.eye.lids import LidRims
from renderer.gl.program import Program
from renderer.spherical_harmonics import ambient_uniforms
from renderer.view import look_at, perspective

Array = npt.NDArray[np.float64]

MEASURE_PX: Final = 160
CAMERA_MM: Final = 600.0
OUTER_MM: Final = 4.9  # the limbus's soft edge stays outside
RUFF_MM: Final = 0.35  # the pupil's edge likewise
_UNIFORM_SH: Final = np.concatenate([np.full((1, 3), 1 / 0.282095), np.zeros((8, 3))])


def calibrated_gain(
    gl: moderngl.Context,
    program: Program,
    *,
    mesh: moderngl.VertexArray,
    values: dict[str, Any],
    open_rims: moderngl.Texture,
    mean_albedo: Array,
    albedo: Array,
) -> Array:
    """Return the iris's gain per channel (3,) that gives it its map's mean colour.

    ``values`` are the eye's uniforms for the clip. ``mean_albedo`` is linear Rec. 709, ``albedo``
    (n, n, 3) that of the iris on its plane.
    """
    values = values | {"u_chamber_map": _uniform_chamber(gl, albedo)}
    pixels = _diffuse_picture(gl, program, mesh=mesh, values=values, open_rims=open_rims)
    seen = pixels[_annulus(float(values["u_pupil_mm"]))].mean(axis=0)
    start = np.asarray(values["u_iris_gain"], dtype=np.float64)
    return np.asarray(start * mean_albedo / np.maximum(seen, 1e-6))


def open_lids() -> LidRims:
    """Return rims so far away that they shade nothing."""
    return LidRims(*(np.array([[-40.0, y, 0.0], [40.0, y, 0.0]]) for y in (60.0, -60.0)))


def _diffuse_picture(
    gl: moderngl.Context,
    program: Program,
    *,
    mesh: moderngl.VertexArray,
    values: dict[str, Any],
    open_rims: moderngl.Texture,
) -> npt.NDArray[np.float32]:
    """Draw the eye along its gaze under a uniform sky of radiance 1; (n, n, 3)."""
    eye_to_world = np.asarray(values["u_eye_to_world"], dtype=np.float64)
    gaze, centre = eye_to_world[:3, 2], eye_to_world[:3, 3]
    camera = centre + CAMERA_MM * gaze
    half_angle = math.degrees(math.atan(MAP_EDGE_MM / (CAMERA_MM - IRIS_Z_MM)))
    projection = perspective(2 * half_angle, 1.0, 0.5 * CAMERA_MM, 2 * CAMERA_MM)
    target = gl.framebuffer([gl.texture((MEASURE_PX, MEASURE_PX), 4, dtype="f4")])
    black = gl.texture_cube((1, 1), 4, np.zeros((6, 4), np.float16).tobytes(), dtype="f2")
    # Held until drawn: a texture that nothing refers to is released.
    diffuse = (
        values
        | {name: black for name in ("u_static_cube", "u_crowd_cube") if name in values}
        | {
            "u_sun_irradiance": np.zeros(3),
            **ambient_uniforms(_UNIFORM_SH),
            "u_plane_irradiance": np.full(3, math.pi),
            "u_shade_map": _texture(gl, np.ones((1, 1, 4))),
            "u_lid_rims": open_rims,
            "u_view_matrix": look_at(camera, centre),
            "u_projection": projection,
            "u_camera_mm": camera,
            "u_mm_per_px": 2 * MAP_EDGE_MM / MEASURE_PX,
        }
    )
    program.set(**diffuse)
    with gl.scope(target, moderngl.CULL_FACE):
        target.clear()
        mesh.render()
    pixels = np.frombuffer(target.read(components=3, dtype="f4"), np.float32)
    return pixels.reshape(MEASURE_PX, MEASURE_PX, 3)


def _uniform_chamber(gl: moderngl.Context, albedo: Array) -> moderngl.Texture:
    chamber = chamber_irradiance(
        np.ones_like, np.eye(3), rims=None, albedo=albedo, size_px=len(albedo)
    )
    return _texture(gl, np.pad(chamber, ((0, 0), (0, 0), (0, 1))))


def _annulus(pupil_mm: float) -> npt.NDArray[np.bool_]:
    """Mark the pixels that show iris at every LoD: the cornea widens the pupil by 1.12."""
    axis = ((np.arange(MEASURE_PX) + 0.5) / MEASURE_PX * 2 - 1) * MAP_EDGE_MM
    radius = np.hypot(*np.meshgrid(axis, axis))
    return np.asarray((radius > min(0.56 * pupil_mm + RUFF_MM, 4.6)) & (radius < OUTER_MM))


def _texture(gl: moderngl.Context, values: npt.NDArray[Any]) -> moderngl.Texture:
    data = np.ascontiguousarray(values, dtype=np.float32).tobytes()
    texture = gl.texture(values.shape[1::-1], 4, data, dtype="f4")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture
