"""The picture's targets: linear radiance with one sample per pixel, then 8-bit sRGB."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.frame.bloom import SHARE, Bloom
from renderer.frame.edge_tiles import EdgeFinder, EdgeTiles
from renderer.frame.edges import Edges
from renderer.frame.outlines import Outlines
from renderer.gl.program import build_program
from renderer.view import View

EXPOSURE: Final = 0.8  # one fixed exposure for every clip: no auto-exposure, fair pairs

Pixels = npt.NDArray[np.uint8]
Radiance = npt.NDArray[np.float32]


class Picture:
    """Draw between ``begin`` and ``finish``; ``finish`` returns the frame.

    ``views`` of the same width stand side by side: none shines into the next. What is opaque is
    drawn twice, the second time into ``outlines``; ``smooth_edges`` stands between it and hair.
    """

    def __init__(self, gl: moderngl.Context, size: tuple[int, int], *, views: int = 1) -> None:
        self.gl = gl
        self.size = size
        self._radiance = gl.texture(size, 4, dtype="f2")
        depth = gl.depth_texture(size)
        depth.compare_func = ""  # it is read as numbers
        depth.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.target = gl.framebuffer([self._radiance], depth)
        self.outlines = Outlines(gl, size)
        self._finder = EdgeFinder(gl, self._radiance, depth)
        self._edges = Edges(gl, self._radiance, depth)
        self._display = gl.framebuffer([gl.texture(size, 4)])
        self._bloom = Bloom(gl, size, views=views)
        self._resolve = build_program(gl, "screen.vert", fragment="resolve.frag")
        self._screen = gl.vertex_array(self._resolve.gl_program, [])

    def begin(self) -> None:
        """Clear the targets and make the radiance's the one that is drawn to."""
        self.target.use()
        self.target.viewport = (0, 0, *self.size)
        self.target.scissor = (0, 0, *self.size)
        self.target.clear(0.0, 0.0, 0.0, 1.0)
        self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)

    def use_rectangle(self, rectangle: tuple[int, int, int, int]) -> None:
        """Confine drawing to one view: x, y, width, height from the lower left in pixels."""
        self.target.use()
        self.target.viewport = rectangle
        self.target.scissor = rectangle

    def find_edges(self, views: Sequence[View]) -> list[EdgeTiles]:
        """Return where each view may have edges, after what is opaque has been drawn."""
        return self._finder.find(views)

    def smooth_edges(
        self, views: Sequence[View], tiles: Sequence[EdgeTiles], *, is_plain: bool = False
    ) -> None:
        """Smooth what ``outlines`` has edges of: for the tone curve, or as the mean of radiance."""
        self._edges.smooth(views, tiles, self.outlines, exposure=EXPOSURE, is_plain=is_plain)

    def radiance(self) -> Radiance:
        """Return the linear radiance, (height, width, 3) float32 Rec. 709, first row on top.

        No exposure, no tone curve, no bloom.
        """
        values = np.frombuffer(self.target.read(components=3, dtype="f4", alignment=1), np.float32)
        return values.reshape(self.size[1], self.size[0], 3)[::-1].copy()

    def show(self) -> None:
        """Tone map what was drawn: the frame stays on the GPU."""
        self.target.scissor = (0, 0, *self.size)
        bloom = self._bloom.blurred(self._radiance)
        self._display.use()
        self._resolve.set(
            u_radiance=self._radiance,
            u_bloom=bloom,
            u_bloom_share=SHARE,
            u_exposure=EXPOSURE,
        )
        self._screen.render(moderngl.TRIANGLES, vertices=3)

    def finish(self) -> Pixels:
        """Tone map and return the frame, (height, width, 3) uint8 sRGB, first row on top."""
        self.show()
        pixels = np.frombuffer(self._display.read(components=3, alignment=1), np.uint8)
        return pixels.reshape(self.size[1], self.size[0], 3)
