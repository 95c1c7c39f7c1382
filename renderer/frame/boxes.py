"""Boxes of a picture on the GPU, all drawn in one call."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.gl.program import Program

Box = tuple[int, int, int, int]  # x, y, width, height in pixels from the lower left


class Boxes:
    """Boxes for programs that have ``boxes.vert``; the target's viewport is the whole picture."""

    def __init__(self, gl: moderngl.Context, size: tuple[int, int]) -> None:
        """``size`` is the picture's."""
        self._gl = gl
        self._size = size
        self._count = 0
        self._buffer = gl.buffer(reserve=16, dynamic=True)
        self._arrays: dict[int, moderngl.VertexArray] = {}

    def write(self, boxes: npt.NDArray[np.int64]) -> None:
        """Replace them: rows (n, 4) are x, y, width, height."""
        data = boxes.astype(np.float32).tobytes()
        self._count = len(boxes)
        if len(data) > self._buffer.size:
            self._buffer = self._gl.buffer(reserve=2 * len(data), dynamic=True)
            self._arrays.clear()
        if data:
            self._buffer.write(data)

    def draw(self, program: Program, *, z: float = 0.0, **uniforms: Any) -> None:
        """Draw them into the current target at a depth ``z`` in clip space."""
        if not self._count:
            return
        key = program.gl_program.glo
        if key not in self._arrays:
            self._arrays[key] = self._gl.vertex_array(
                program.gl_program, [(self._buffer, "4f/i", "in_box_px")]
            )
        program.set(**uniforms, u_size_px=self._size, u_z=z)
        self._arrays[key].render(moderngl.TRIANGLE_STRIP, vertices=4, instances=self._count)
