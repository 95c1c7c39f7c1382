"""The eyes of a large crowd: real ones, each at the LoD that its size on the picture asks for.

Eyes of one LoD and one iris are drawn with one call; what is an eye's own stands in a record. Eyes
too small for any LoD stay what the body's mesh has painted.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.crowd.eye_groups import EyeGroups, Run, crowd_detail
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

Rows = npt.NDArray[np.int64]


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
        self._limits_px = np.array(policy.limits_px)
        colours = list(dict.fromkeys(figure.member.person.eye for figure in figures))
        irises = [colours.index(figure.member.person.eye) for figure in figures]
        self._irises = np.repeat(irises, 2)
        self._kinds = [
            (crowd_detail(step.detail), colour) for step in policy.steps for colour in colours
        ]
        self._rows: Rows = np.zeros(0, dtype=np.int64)
        self._runs: list[Run] = []

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
        rows = _real_eyes(sizes, among)
        # As the policy chooses: a LoD is enough for its limit itself.
        steps = np.searchsorted(self._limits_px, sizes[rows])
        self._arrange(rows, steps)
        found = []
        for row, number in zip(rows.tolist(), steps.tolist(), strict=True):
            step = self._policy.steps[number]
            found.append(DrawnEye(row // 2, row % 2, float(sizes[row]), step.lod, step.detail))
        return found

    def draw(
        self,
        *,
        light: Light,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
        camera_mm: npt.NDArray[np.floating],
        lines: int,
    ) -> None:
        """Draw the eyes that ``choose`` returned last, opaque and depth-tested."""
        records = np.empty((len(self._rows), 24), dtype=np.float32)
        records[:, :16] = np.swapaxes(self._placed[self._rows], 1, 2).reshape(-1, 16)
        records[:, 16:] = self._facts[self._rows]
        self._records.write(records)
        self._records.bind_to_uniform_block(_BINDING)
        values: dict[str, Any] = {
            **light.uniforms(),
            "u_view_matrix": view_matrix,
            "u_projection": projection,
            "u_camera_mm": camera_mm,
            "u_pixel_rad": 2.0 / (float(projection[1][1]) * lines),
            "u_lid_rims": self._rims,
        }
        self._groups.prepare(run.kind for run in self._runs)
        self._groups.draw(self._runs, values)

    def draw_outlines(
        self, *, view_matrix: npt.NDArray[np.floating], projection: npt.NDArray[np.floating]
    ) -> None:
        """Draw the eyes of the last ``draw`` as bare triangles that mark their samples."""
        self._records.bind_to_uniform_block(_BINDING)
        self._groups.draw_outlines(
            self._runs, {"u_view_matrix": view_matrix, "u_projection": projection}
        )

    def _arrange(self, rows: Rows, steps: Rows) -> None:
        """Put eyes of one LoD and iris side by side, to be drawn together."""
        colours = len(self._kinds) // len(self._policy.steps)
        kinds = steps * colours + self._irises[rows]
        order = np.argsort(kinds, kind="stable")
        self._rows = rows[order]
        numbers, firsts, counts = np.unique(kinds[order], return_index=True, return_counts=True)
        self._runs = [
            Run(self._kinds[kind], first, count)
            for kind, first, count in zip(
                numbers.tolist(), firsts.tolist(), counts.tolist(), strict=True
            )
        ]


def _real_eyes(sizes_px: Floats, among: Sequence[int]) -> Rows:
    """Return the rows of the eyes of figures ``among`` that are not painted."""
    pairs = sizes_px.reshape(-1, 2)
    is_among = np.zeros(len(pairs), dtype=bool)
    is_among[among] = True
    # Both eyes or none: the paint is one part of the body.
    is_real = is_among & (pairs.max(axis=1) >= PAINTED_PX)
    return np.flatnonzero(is_real[:, None] & (pairs > 0.0))


def _rims_texture(gl: moderngl.Context, fitted: Sequence[Socket]) -> moderngl.Texture:
    table = np.concatenate([rims_table(socket.rims) for socket in fitted])
    texture = gl.texture(table.shape[1::-1], 4, table.tobytes(), dtype="f4")
    texture.repeat_x = texture.repeat_y = False
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    return texture
