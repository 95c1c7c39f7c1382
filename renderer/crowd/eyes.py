"""The eyes of a large crowd: real ones, each at the LoD that its size on the picture asks for.

Eyes of one LoD and one iris are drawn with one call; what is an eye's own stands in a record. Eyes
too small for any LoD stay what the body's mesh has painted.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.crowd.eye_groups import EyeGroups, Kind
from renderer.crowd.figures import Figure
from renderer.crowd.gaze import CrowdGaze, iris_px
from renderer.crowd.sockets import Socket, sockets
from renderer.crowd.turns import Floats
from renderer.detail import Detail
from renderer.eye.anatomy import GLOBE_RADIUS_MM
from renderer.eye.sunlight import rims_table
from renderer.light import Light
from renderer.lod.choice import LodPolicy

PAINTED_PX: Final = 4.0  # smaller irises than this are painted: no mesh of a LoD has as few facets
MOST_EYES: Final = 64  # crowd_eyes.glsl's
_BINDING: Final = 0


@dataclass(frozen=True)
class DrawnEye:
    """An eye of the crowd in a frame: ``eye`` is the viewer's left (0) or right (1) of a figure."""

    figure: int
    eye: int
    iris_px: float
    lod: str
    detail: Detail


class CrowdEyes:
    """All eyes of a crowd: ``choose`` for a view, then ``draw``."""

    def __init__(
        self,
        gl: moderngl.Context,
        figures: Sequence[Figure],
        *,
        shares: Sequence[Floats],
        static_cube: Callable[[int], moderngl.TextureCube],
        policy: LodPolicy,
    ) -> None:
        """``shares`` are each figure's vertices' (n, 2) shares of sky and sun."""
        self._gl = gl
        self._policy = policy
        self._figures = figures
        self._groups = EyeGroups(gl, static_cube)
        bodies = {figure.member.person.body: figure.body for figure in figures}
        fitted = {name: sockets(body) for name, body in bodies.items()}
        pairs = [fitted[figure.member.person.body] for figure in figures]
        self.gaze = CrowdGaze.of(figures, pairs)
        rows = {name: 2 * row for row, name in enumerate(fitted)}
        self._rims = _rims_texture(gl, [socket for pair in fitted.values() for socket in pair])
        self._facts = np.zeros((2 * len(figures), 8), dtype=np.float32)
        for number, (figure, pair) in enumerate(zip(figures, pairs, strict=True)):
            for eye, socket in enumerate(pair):
                sky, sun = shares[number][socket.rows].mean(axis=0)
                radius = self.gaze.radii_mm[2 * number + eye]
                row = rows[figure.member.person.body] + eye
                self._facts[2 * number + eye, :5] = 1.0 - 2.0 * eye, radius, sun, sky, row
        self._records = gl.buffer(reserve=MOST_EYES * 96)
        self._drawn: list[tuple[Kind, int]] = []

    def choose(
        self,
        bones: Floats,
        *,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
        lines: int,
        among: Sequence[int],
    ) -> list[DrawnEye]:
        """Return the eyes of the figures ``among`` that a view needs, with the LoD of each."""
        self._placed, aside_deg = self.gaze.placed(bones)
        # Lids stay where they are while the globe turns under them.
        self._facts[:, 5:7] = GLOBE_RADIUS_MM * np.sin(np.radians(aside_deg))
        sizes = iris_px(self._placed, view_matrix=view_matrix, projection=projection, lines=lines)
        found = []
        for figure in among:
            pair = sizes[2 * figure : 2 * figure + 2]
            # Both eyes or none: the paint is one part of the body.
            if pair.max() < PAINTED_PX:
                continue
            for eye in np.flatnonzero(pair > 0).tolist():
                step = self._policy.steps[self._policy.choose(float(pair[eye]))]
                found.append(DrawnEye(figure, eye, float(pair[eye]), step.lod, step.detail))
        return found

    def draw(
        self,
        eyes: Sequence[DrawnEye],
        *,
        light: Light,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
        camera_mm: npt.NDArray[np.floating],
        lines: int,
    ) -> None:
        """Draw eyes that ``choose`` returned last, opaque and depth-tested."""
        ordered = sorted(eyes, key=lambda eye: (eye.lod, self._iris(eye), eye.figure, eye.eye))
        rows = [2 * eye.figure + eye.eye for eye in ordered]
        records = np.empty((len(rows), 24), dtype=np.float32)
        records[:, :16] = np.swapaxes(self._placed[rows], 1, 2).reshape(-1, 16)
        records[:, 16:] = self._facts[rows]
        self._records.write(records.tobytes())
        self._records.bind_to_uniform_block(_BINDING)
        values: dict[str, Any] = {
            **light.uniforms(),
            "u_view_matrix": view_matrix,
            "u_projection": projection,
            "u_camera_mm": camera_mm,
            "u_pixel_rad": 2.0 / (float(projection[1][1]) * lines),
            "u_lid_rims": self._rims,
        }
        kinds = groupby(ordered, key=lambda eye: (eye.detail, self._iris(eye)))
        counts = [(kind, len(list(eyes))) for kind, eyes in kinds]
        self._groups.prepare(kind for kind, _ in counts)
        self._drawn = counts
        first = 0
        for kind, count in counts:
            self._groups.draw(kind, first=first, count=count, values=values)
            first += count

    def draw_outlines(
        self, *, view_matrix: npt.NDArray[np.floating], projection: npt.NDArray[np.floating]
    ) -> None:
        """Draw the eyes of the last ``draw`` as bare triangles that mark their samples."""
        values = {"u_view_matrix": view_matrix, "u_projection": projection}
        self._records.bind_to_uniform_block(_BINDING)
        first = 0
        for kind, count in self._drawn:
            self._groups.draw_outlines(kind, first=first, count=count, values=values)
            first += count

    def _iris(self, eye: DrawnEye) -> str:
        return self._figures[eye.figure].member.person.eye


def _rims_texture(gl: moderngl.Context, fitted: Sequence[Socket]) -> moderngl.Texture:
    table = np.concatenate([rims_table(socket.rims) for socket in fitted])
    texture = gl.texture(table.shape[1::-1], 4, table.tobytes(), dtype="f4")
    texture.repeat_x = texture.repeat_y = False
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    return texture
