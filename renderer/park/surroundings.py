"""The surroundings of a clip, the park or a picture: as light, as reflection and as background.

``environment_radiance`` in the environment's shader is the one truth; everything here is drawn from
it once per scene: static cube maps for the cornea and a panorama out of focus as background.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, replace
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.camera import IRIS_PX, radius_of_px
from renderer.clip import ClipSpec
from renderer.frame.boxes import Box, Boxes
from renderer.gl.program import build_program
from renderer.light import Sky
from renderer.park.cube_faces import FACE_AXES, read_face
from renderer.park.cube_lookup import halve
from renderer.park.cube_target import CubeTarget
from renderer.park.environments import AMBIENT_PX, Environment, make_environment

SMALLEST_LEVEL_PX: Final = 32
CHAMBER_FACE_PX: Final = 16  # 5.6 degrees: as fine as the rays that gather light on the iris
BACKGROUND_CUBE_PX: Final = 1024


@dataclass(frozen=True)
class Defocus:
    """How far the background is out of focus for cameras up to a distance from the face.

    ``diameter_deg`` of the circle of confusion; a panorama ``width`` texels around holds it,
    blurred with ``points`` lookups.
    """

    farthest_mm: float
    diameter_deg: float
    width: int
    points: int


# 30 mm of aperture seen from the plane in focus, a portrait lens wide open, at the four distances;
# a table, so that nothing changes during an orbit. Nearer than 0.8 m a real lens blurs even more.
DEFOCUS: Final = (
    Defocus(270.0, 6.0, 512, 96),
    Defocus(800.0, 4.0, 768, 64),
    Defocus(2700.0, 1.15, 1536, 32),
    Defocus(np.inf, 0.5, 2048, 16),
)


class Surroundings:
    """The surroundings of a clip: ``sky`` (light), ``cube(size)`` and ``draw_background``."""

    def __init__(self, gl: moderngl.Context, spec: ClipSpec) -> None:
        self.gl = gl
        self._environment: Environment = make_environment(gl, spec)
        self._program = build_program(gl, "screen.vert", fragment=self._environment.face_shader)
        self._screen = gl.vertex_array(self._program.gl_program, [])
        self._cubes: dict[int, moderngl.TextureCube] = {}
        self._panoramas: dict[Defocus, moderngl.Texture] = {}
        self._background = build_program(gl, "direction.vert", fragment="background.frag")
        self._background_screen = gl.vertex_array(self._background.gl_program, [])
        self._gaps = build_program(gl, "direction_boxes.vert", fragment="background.frag")

    @functools.cached_property
    def sky(self) -> Sky:
        """The light: the sun, and the surroundings' ambient light without it."""
        drawn = self.cube(AMBIENT_PX)
        faces = np.stack([read_face(drawn, face)[..., :3] for face in range(6)])
        return replace(self._environment.sky(self.cube), faces=halve(faces, CHAMBER_FACE_PX))

    def cube(self, size: int) -> moderngl.TextureCube:
        """Return the surroundings as a static cube map of ``size`` pixels a face, with levels."""
        if size not in self._cubes:
            self._cubes[size] = self._draw_cube(size)
        return self._cubes[size]

    def prepare_background(self, distance_mm: float) -> None:
        """Draw the panorama for a camera distance now, before any frame: a frame draws no other."""
        self._panorama(_defocus(distance_mm))

    def draw_background(
        self,
        *,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
        is_smooth: bool = False,
        gaps: Boxes | None = None,
        rectangle: Box = (0, 0, 0, 0),
    ) -> None:
        """Fill what nothing else covered, at the far plane; draw it after all opaque things.

        ``is_smooth`` lets the blur change evenly with the camera's distance instead of in steps.
        Given ``gaps`` it looks for such places within them alone: the target's viewport is then
        the whole picture, in which the view has a ``rectangle``.
        """
        distance_mm = _distance_mm(view_matrix)
        near, far, share = _defocus(distance_mm), _defocus(distance_mm), 0.0
        if is_smooth:
            near, far, share = _between(distance_mm)
        values = {
            "u_view_matrix": view_matrix,
            "u_projection": projection,
            "u_panorama": self._panorama(near),
            "u_farther_panorama": self._panorama(far),
            "u_farther_share": share,
        }
        self.gl.depth_func = "<="
        if gaps is not None:
            gaps.draw(self._gaps, z=1.0, u_view=rectangle, **values)
        else:
            self._background.set(**values)
            self._background_screen.render(moderngl.TRIANGLES, vertices=3)
        self.gl.depth_func = "<"

    def _draw_cube(self, size: int) -> moderngl.TextureCube:
        cube = CubeTarget(self.gl, size, levels=level_count(size))
        self.gl.enable_only(moderngl.NOTHING)
        for face in range(6):
            cube.attach(face)
            self._program.set(
                u_face=FACE_AXES[face],
                u_face_size=(size, size),
                **self._environment.uniforms(2.0 / size),
            )
            self._screen.render(moderngl.TRIANGLES, vertices=3)
        cube.build_levels()
        return cube.texture

    def _panorama(self, defocus: Defocus) -> moderngl.Texture:
        if defocus not in self._panoramas:
            self._panoramas[defocus] = self._draw_panorama(defocus)
        return self._panoramas[defocus]

    def _draw_panorama(self, defocus: Defocus) -> moderngl.Texture:
        """Draw the panorama in a state of its own: this happens amid a frame's first view."""
        radius = float(np.radians(defocus.diameter_deg) / 2)
        size = (defocus.width, defocus.width // 2)
        panorama = self.gl.texture(size, 4, dtype="f2")
        panorama.repeat_y = False
        target = self.gl.framebuffer([panorama])
        with self.gl.scope(target, moderngl.NOTHING):
            cube, sky = self.cube(BACKGROUND_CUBE_PX), self.sky  # both may draw themselves first
            target.use()
            self._spread(cube, sky, defocus=defocus, radius=radius)
        return panorama

    def _spread(
        self, cube: moderngl.TextureCube, sky: Sky, *, defocus: Defocus, radius: float
    ) -> None:
        program = build_program(self.gl, "screen.vert", fragment="defocus.frag")
        # Points on the disc are this far apart, in texels of the cube's finest level.
        spacing = radius * math.sqrt(math.pi / defocus.points) * BACKGROUND_CUBE_PX / 2
        program.set(
            u_cube=cube,
            u_panorama_size=(defocus.width, defocus.width // 2),
            u_radius_rad=radius,
            u_points=defocus.points,
            u_lod=max(0.0, math.log2(spacing) + 0.5),
            u_sun_towards=sky.sun_direction,
            u_sun_radiance=np.minimum(sky.sun_irradiance / (np.pi * radius**2), 6.0e4),
        )
        self.gl.vertex_array(program.gl_program, []).render(moderngl.TRIANGLES, vertices=3)


def _between(distance_mm: float) -> tuple[Defocus, Defocus, float]:
    """Return the steps that a distance lies between and the farther one's share, in log distance.

    A step rules alone where clips of its distance have their camera.
    """
    at = np.interp(
        math.log(distance_mm),
        np.log([radius_of_px(px) for px in IRIS_PX.values()]),
        np.arange(len(DEFOCUS)),
    )
    near = min(int(at), len(DEFOCUS) - 2)
    return DEFOCUS[near], DEFOCUS[near + 1], float(at - near)


def level_count(size: int) -> int:
    """Return how many levels a static cube map has: down to SMALLEST_LEVEL_PX."""
    return max(1, (size // SMALLEST_LEVEL_PX).bit_length())


def _distance_mm(view_matrix: npt.NDArray[np.floating]) -> float:
    matrix = np.asarray(view_matrix, dtype=float)
    return float(np.linalg.norm(matrix[:3, :3].T @ matrix[:3, 3]))


def _defocus(distance_mm: float) -> Defocus:
    return next(step for step in DEFOCUS if distance_mm <= step.farthest_mm)
