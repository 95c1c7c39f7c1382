"""The fold of conjunctiva behind the globe: what shows where a coarse globe leaves the lids a gap.

A mesh of few triangles lies inside the globe that the lids were fitted to, by 0.4 mm at the lowest
tessellation. Past its edge one looks at pink tissue in shade, never through the head.
"""

from __future__ import annotations

from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats
from renderer.eye.place import eye_centre_mm
from renderer.gl.program import build_program
from renderer.gl.uniforms import constant
from renderer.light import Sky
from renderer.spherical_harmonics import sh_basis

RADIUS_MM: Final = 12.6  # a little more than the globe's
NASAL_MM: Final = 26.0  # towards the nose, which hides it: one looks far in from the temple
DEPTH_MM: Final = -0.5  # behind the globe's centre
WALL_MM: Final = 3.0  # towards the temple the fold comes so far before the globe's centre
WALL_RADIUS_MM: Final = 12.35  # under the lids there
SIDES: Final = 48
TISSUE: Final = (0.52, 0.33, 0.28)  # reflectance of conjunctiva
REACHED: Final = 0.65  # share of the light from in front that comes so far
COSINE_LOBE: Final = np.array([1.0] + 3 * [2 / 3] + 5 * [1 / 4])  # Ramamoorthi, Hanrahan 2001


class Fornix:
    """Both eyes' folds, each a flat patch that faces forwards and a wall on the temple's side."""

    def __init__(self, gl: moderngl.Context) -> None:
        self._program = build_program(gl, "depth.vert", fragment="fornix.frag")
        self._sky: Sky | None = None
        self._radiance = np.zeros(3)
        corners = gl.buffer(fold_triangles().astype(np.float32).tobytes())
        self._folds = gl.vertex_array(self._program.gl_program, [(corners, "3f", "in_position")])

    def draw(self, world_to_clip: npt.ArrayLike, sky: Sky) -> None:
        """Draw both, opaque, into the current target."""
        if sky is not self._sky:
            self._sky, self._radiance = sky, constant(radiance(sky))
        self._program.set(u_world_to_clip=world_to_clip, u_radiance=self._radiance)
        self._folds.render(moderngl.TRIANGLES)


def fold_triangles() -> Floats:
    """Return the corners (3 n, 3) of both folds' triangles in world space."""
    return np.concatenate([part(eye) for eye in (0, 1) for part in (disc, wall)])


def radiance(sky: Sky) -> Floats:
    """Return the fold's linear radiance (3,) under a sky."""
    ahead = sh_basis(np.array([0.0, 0.0, 1.0]))
    white = np.maximum((COSINE_LOBE * ahead) @ sky.ambient_sh, 0.0)  # irradiance / pi
    return np.asarray(REACHED * np.array(TISSUE) * white)


def disc(eye: int) -> Floats:
    """Return the triangles' corners (3 n, 3) in world space, counter-clockwise from the front."""
    turn = np.linspace(0.0, 2 * np.pi, SIDES + 1)
    rim = RADIUS_MM * np.column_stack([np.cos(turn), np.sin(turn), np.zeros(SIDES + 1)])
    is_nasal = rim[:, 0] * (0.5 - eye) > 0
    rim[is_nasal, 0] *= NASAL_MM / RADIUS_MM
    corners = np.stack([np.zeros((SIDES, 3)), rim[:-1], rim[1:]], axis=1).reshape(-1, 3)
    return np.asarray(corners + eye_centre_mm(eye) + [0.0, 0.0, DEPTH_MM])


def wall(eye: int) -> Floats:
    """Return a zone of a sphere, seen from inside, on the temple's side: corners (3 n, 3).

    From the nose one looks past the globe and beside the disc.
    """
    outer = np.pi if eye == 0 else 0.0
    turn, z = np.meshgrid(
        outer + np.linspace(-np.pi / 2, np.pi / 2, SIDES // 2 + 1),
        np.linspace(DEPTH_MM, WALL_MM, 5),
        indexing="ij",
    )
    radius = np.sqrt(WALL_RADIUS_MM**2 - z**2)
    grid = np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=-1)
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    corners = np.stack([a, c, b, a, d, c], axis=2).reshape(-1, 3)
    return np.asarray(corners + eye_centre_mm(eye))
