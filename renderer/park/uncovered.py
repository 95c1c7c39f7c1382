"""Which parts of a view nothing covers yet: hidden pixels cost software GL as much as seen ones.

llvmpipe runs a multisampled draw's fragment shader before it looks at the depth: a background that
a face hides costs as much as one that is seen. Counting the samples that an empty shader would
draw, tile by tile, costs a third of it.
"""

from __future__ import annotations

import itertools
from typing import Final

import moderngl

from renderer.program import build_program

TILES: Final = 8  # per side of the view
Box = tuple[int, int, int, int]


class Uncovered:
    """Find the tiles of the current view where something at the far plane would be seen."""

    def __init__(self, gl: moderngl.Context) -> None:
        self._gl = gl
        self._queries = [gl.query(samples=True) for _ in range(TILES * TILES)]
        program = build_program(gl, "direction.vert", fragment="depth.frag").gl_program
        self._screen = gl.vertex_array(program, [])

    def tiles(self) -> list[Box]:
        """Return scissor boxes x, y, width, height in pixels of the target, from the lower left.

        The depth test in force decides. The target's scissor box is left as it was; nothing is
        drawn, and depth stays.
        """
        target = self._gl.fbo
        kept, boxes = target.scissor, tiles_of(target.viewport)
        masks = target.color_mask, target.depth_mask
        target.color_mask, target.depth_mask = (False,) * 4, False
        for box, query in zip(boxes, self._queries, strict=True):
            target.scissor = box
            with query:
                self._screen.render(moderngl.TRIANGLES, vertices=3)
        target.scissor = kept
        target.color_mask, target.depth_mask = masks
        counts = [int(query.samples) for query in self._queries]
        return [box for box, count in zip(boxes, counts, strict=True) if count]


def tiles_of(viewport: Box) -> list[Box]:
    """Return TILES x TILES boxes that cover a viewport once; small ones may be empty."""
    x, y, width, height = viewport
    across = [x + width * n // TILES for n in range(TILES + 1)]
    up = [y + height * n // TILES for n in range(TILES + 1)]
    return [
        (left, bottom, right - left, top - bottom)
        for bottom, top in itertools.pairwise(up)
        for left, right in itertools.pairwise(across)
    ]
