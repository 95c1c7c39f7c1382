"""Surroundings as a latitude-longitude picture, as other renderers take them."""

from __future__ import annotations

from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.gl.program import build_program

WIDTH_PX: Final = 2048
CUBE_PX: Final = 512  # a quarter of the width: texels of both are equally large at the horizon


def lat_long_of(
    gl: moderngl.Context, cube: moderngl.TextureCube, *, width_px: int = WIDTH_PX
) -> npt.NDArray[np.float32]:
    """Return a cube map as a picture (width / 2, width, 3); ``park.lat_long`` has its layout."""
    size = (width_px, width_px // 2)
    program = build_program(gl, "screen.vert", fragment="lat_long.frag")
    target = gl.framebuffer([gl.texture(size, 4, dtype="f4")])
    with gl.scope(target, moderngl.NOTHING):
        target.use()
        program.set(u_cube=cube, u_picture_size=size)
        gl.vertex_array(program.gl_program, []).render(moderngl.TRIANGLES, vertices=3)
        data = np.frombuffer(target.read(components=3, dtype="f4"), np.float32)
    return data.reshape(size[1], size[0], 3).copy()
