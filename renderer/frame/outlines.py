"""Where things end within a pixel: depth and a mark, four samples per pixel, no colour.

Shading is software GL's cost, and with four samples it pays for hidden ones too. So colours are
shaded once per pixel, and what is opaque is drawn again into these targets, as bare triangles;
``renderer.frame.edges`` makes smooth edges of both.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

import moderngl

from renderer.frame.boxes import Box
from renderer.frame.edge_tiles import EdgeTiles
from renderer.gl.program import build_program

SAMPLES: Final = 4  # llvmpipe's maximum
# What meets other things at the same depth has a mark; in the picture alpha is one more. Parts of
# bystanders count on from BYSTANDER.
EYE, HAIR, CLOTH, BYSTANDER = 1, 2, 3, 4


class Outlines:
    """The targets that outlines are drawn into."""

    def __init__(self, gl: moderngl.Context, size: tuple[int, int]) -> None:
        self._gl = gl
        self._size = size
        self._marks = gl.texture(size, 1, samples=SAMPLES)
        self._depth = gl.depth_texture(size, samples=SAMPLES)
        # Two targets, not one with colours masked: llvmpipe 22 writes masked samples all the same.
        self._bare = gl.framebuffer([], self._depth)
        self._marked = gl.framebuffer([self._marks], self._depth)
        self._nothing = build_program(gl, "boxes.vert", fragment="mark.frag")

    def begin(self, rectangle: Box, tiles: EdgeTiles) -> None:
        """Draw depth alone from now on, into a view's rectangle; its ``tiles`` are cleared.

        What lies elsewhere is never read.
        """
        self._marked.use()
        self._marked.viewport = self._marked.scissor = (0, 0, *self._size)
        self._gl.enable_only(moderngl.DEPTH_TEST)
        self._gl.depth_func = "1"
        tiles.runs.draw(self._nothing, z=1.0, u_mark=0.0)
        self._gl.depth_func = "<"
        for target in (self._marked, self._bare):
            target.use()
            target.viewport = rectangle
            target.scissor = rectangle
        self._gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)

    @contextmanager
    def marking(self) -> Iterator[None]:
        """Have what is drawn within marked: its shader writes 1/255 of the mark.

        What it covers loses its mark, so draw what has none before.
        """
        self._marked.use()
        try:
            yield
        finally:
            self._bare.use()

    def uniforms(self) -> dict[str, Any]:
        """Return what ``edges.glsl`` reads of them."""
        return {"u_sample_depth": self._depth, "u_sample_mark": self._marks}
