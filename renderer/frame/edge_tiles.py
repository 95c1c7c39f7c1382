"""Which parts of a picture may have edges, or show the background: most of a face does neither.

What is opaque, drawn with one sample per pixel, tells it. A tile without edges needs no outlines,
and nothing to be smoothed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.frame.boxes import Box, Boxes
from renderer.gl.context import chooses_parts
from renderer.gl.program import build_program
from renderer.view import View

TILE_PX: Final = 8  # edge_tiles.frag reads blocks of two by two such tiles
OPEN, EDGE = 64, 192  # it answers from here on where nothing was drawn, and where edges may be

Mask = npt.NDArray[np.bool_]
Floats = npt.NDArray[np.float64]
Runs = npt.NDArray[np.int64]


@dataclass(frozen=True)
class EdgeTiles:
    """Where a view may have edges: ``mask`` (rows from below, columns) of its tiles.

    Without a mask that is everywhere. ``runs`` are the same tiles on the GPU; beyond ``gaps``
    something opaque covers every pixel.
    """

    mask: Mask | None
    runs: Boxes
    size_px: tuple[int, int]  # of the view
    gaps: Boxes | None = None

    @cached_property
    def _sums(self) -> npt.NDArray[np.int64]:
        """How many tiles are marked before and below each corner."""
        assert self.mask is not None
        return np.pad(self.mask.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))

    def touched(self, to_clip: Floats, centres: Floats, radii: Floats) -> Mask:
        """Return which spheres (n, 3) and (n,) may cover a marked tile; ``to_clip`` is (4, 4)."""
        if self.mask is None:
            return np.ones(len(radii), dtype=bool)
        clip = centres @ to_clip[:, :3].T + to_clip[:, 3]
        half = np.array(self.size_px) / 2
        depth = np.maximum(clip[:, 3], 1e-6)
        # Seen off the axis a sphere is a little wider than its middle's distance says.
        px = 1.0 + 1.1 * radii * (half * np.linalg.norm(to_clip[:2, :3], axis=1)).max() / depth
        middle = (clip[:, :2] / depth[:, None] + 1.0) * half
        limit = self.mask.shape[::-1]
        low = np.clip(np.floor((middle - px[:, None]) / TILE_PX), 0, limit).astype(np.int64)
        high = np.clip(np.floor((middle + px[:, None]) / TILE_PX) + 1, low, limit).astype(np.int64)
        sums, (x0, y0), (x1, y1) = self._sums, low.T, high.T
        count = sums[y1, x1] - sums[y0, x1] - sums[y1, x0] + sums[y0, x0]
        return np.asarray((count > 0) & (clip[:, 3] > radii))


class EdgeFinder:
    """Find the tiles of a picture's views that may have edges: on a GPU, which need not wait, all.

    A GPU skips pixels without edges as fast as it could be told where they are.
    """

    def __init__(
        self, gl: moderngl.Context, radiance: moderngl.Texture, depth: moderngl.Texture
    ) -> None:
        """``radiance`` and ``depth`` are of one sample per pixel and stay the same."""
        self._gl = gl
        self._chooses = chooses_parts(gl)
        self._everywhere: dict[Box, EdgeTiles] = {}
        self._boxes: list[tuple[Boxes, Boxes]] = []
        self._size = radiance.size
        self._textures = {"u_radiance": radiance, "u_depth": depth}
        self._target = gl.framebuffer([gl.texture((1, 1), 4)])
        self._program = build_program(
            gl, "screen.vert", fragment="edge_tiles.frag", constants={"TILE_PX": TILE_PX}
        )
        self._screen = gl.vertex_array(self._program.gl_program, [])

    def find(self, views: Sequence[View]) -> list[EdgeTiles]:
        """Return for each view where it may have edges."""
        if not self._chooses:
            return [self._all(view.rectangle) for view in views]
        sizes = [_blocks(view.rectangle[2:]) for view in views]
        firsts = np.cumsum([0] + [columns for columns, _ in sizes]).tolist()
        size = (firsts[-1], max(rows for _, rows in sizes))
        if self._target.size != size:
            self._target = self._gl.framebuffer([self._gl.texture(size, 4)])
        self._target.use()
        self._gl.enable_only(moderngl.NOTHING)
        for view, first, (columns, rows) in zip(views, firsts, sizes, strict=False):
            self._target.scissor = (first, 0, columns, rows)
            self._program.set(
                **self._textures,
                u_view=view.rectangle,
                u_first_column=first,
                u_depth_step=depth_step(view),
            )
            self._screen.render(moderngl.TRIANGLES, vertices=3)
        found = np.frombuffer(self._target.read(components=4, alignment=1), np.uint8)
        blocks = found.reshape(size[1], size[0], 2, 2)
        answers = blocks.transpose(0, 2, 1, 3).reshape(2 * size[1], 2 * size[0])
        tiles = []
        for number, (view, first, (columns, rows)) in enumerate(
            zip(views, firsts, sizes, strict=False)
        ):
            if number == len(self._boxes):
                self._boxes.append((Boxes(self._gl, self._size), Boxes(self._gl, self._size)))
            own = answers[: 2 * rows, 2 * first : 2 * (first + columns)]
            runs, gaps = self._boxes[number]
            # Where things end a pixel may be open between those that were read.
            gaps.write(runs_of(own >= OPEN, view.rectangle))
            runs.write(runs_of(own >= EDGE, view.rectangle))
            tiles.append(EdgeTiles(own >= EDGE, runs, view.rectangle[2:], gaps))
        return tiles

    def _all(self, rectangle: Box) -> EdgeTiles:
        if rectangle not in self._everywhere:
            whole = Boxes(self._gl, self._size)
            whole.write(np.array([rectangle]))
            self._everywhere[rectangle] = EdgeTiles(None, whole, rectangle[2:], whole)
        return self._everywhere[rectangle]


def runs_of(mask: Mask, rectangle: Box) -> Runs:
    """Return the runs of a mask's rows: x, y, width, height in pixels within a rectangle."""
    step = np.diff(mask.astype(np.int8), axis=1, prepend=0, append=0)
    row, first = np.nonzero(step > 0)
    _, end = np.nonzero(step < 0)
    low = TILE_PX * np.column_stack([first, row])
    high = np.minimum(TILE_PX * np.column_stack([end, row + 1]), rectangle[2:])
    low = np.minimum(low, high)  # a block may reach beyond the view
    return np.concatenate([low + rectangle[:2], high - low], axis=1)


def depth_step(view: View) -> tuple[float, float]:
    """Return a and b: at a depth d of the buffer, one pixel's width is a depth of a (b - d).

    A pixel is z / f wide at a distance z, f being the focal length in pixels, and the buffer's
    depth is b - c / z.
    """
    projection = np.asarray(view.projection, dtype=float)
    focal_px = projection[1, 1] * view.rectangle[3] / 2
    return float(1.0 / focal_px), float(0.5 * (1.0 - projection[2, 2]))


def _blocks(size: tuple[int, int]) -> tuple[int, int]:
    return -(-size[0] // (2 * TILE_PX)), -(-size[1] // (2 * TILE_PX))
