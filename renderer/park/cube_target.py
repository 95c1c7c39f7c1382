"""A cube map that is drawn into: its faces as targets, and its smaller levels.

moderngl accepts no face of a cube as a target, so the faces are attached through OpenGL itself.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from typing import Final

import moderngl

from renderer.gl.functions import gl_function
from renderer.park.cube_faces import FACES

Rectangle = tuple[int, int, int, int]

_FRAMEBUFFER: Final = 0x8D40
_READ_FRAMEBUFFER: Final = 0x8CA8
_COLOR_BUFFER_BIT: Final = 0x4000
_LINEAR: Final = 0x2601
_COLOR_ATTACHMENT0: Final = 0x8CE0
_FRAMEBUFFER_COMPLETE: Final = 0x8CD5
_POSITIVE_X: Final = 0x8515
_TEXTURE_CUBE_MAP: Final = 0x8513
_TEXTURE_MAX_LEVEL: Final = 0x813D
_RGBA16F: Final = 0x881A
_RGBA: Final = 0x1908
_HALF_FLOAT: Final = 0x140B
_TEXTURE0: Final = 0x84C0
_SPARE_UNIT: Final = 15  # no program of ours uses so many textures


class CubeTarget:
    """An RGBA16F cube map with levels whose faces can be drawn into.

    ``attach`` makes one face and level the target of drawing. With ``depth`` level 0 has a depth
    buffer, which all faces share: clear it for each.
    """

    def __init__(
        self, gl: moderngl.Context, size: int, *, levels: int = 1, depth: bool = False
    ) -> None:
        self.gl = gl
        self.size = size
        self.levels = levels
        self.texture = gl.texture_cube((size, size), 4, dtype="f2")
        self._allocate_levels()
        self.texture.filter = (
            (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
            if levels > 1
            else (moderngl.LINEAR, moderngl.LINEAR)
        )
        # moderngl wants a colour attachment of its own; a face takes its place at once.
        self._stand_in = gl.renderbuffer((size, size), 4, dtype="f2")
        self._target = self._make_target(depth=depth)
        self._small = self._make_target(depth=False) if depth else self._target
        self._source = self._make_target(depth=False) if levels > 1 else self._target

    def attach(self, face: int, *, level: int = 0) -> moderngl.Framebuffer:
        """Make a face and level the target, with viewport and scissor over all of it."""
        target = self._target if level == 0 else self._small
        target.use()
        _attach(_FRAMEBUFFER, face, self.texture.glo, level)
        check = gl_function("glCheckFramebufferStatus", ctypes.c_uint, result=ctypes.c_uint)
        status = check(_FRAMEBUFFER)
        if status != _FRAMEBUFFER_COMPLETE:
            raise RuntimeError(
                f"cube face {FACES[face]}, level {level}: the driver refuses it as a target "
                f"(framebuffer status {status:#x})"
            )
        side = self.size >> level
        target.viewport = (0, 0, side, side)
        target.scissor = (0, 0, side, side)
        return target

    def build_levels(self, rectangles: Iterable[tuple[int, Rectangle]] | None = None) -> None:
        """Fill the smaller levels by halving, all or below rectangles (face, (x, y, w, h))."""
        whole = [(face, (0, 0, self.size, self.size)) for face in range(6)]
        wanted = whole if rectangles is None else list(rectangles)
        for face in sorted({face for face, _ in wanted}):
            parts = [rectangle for where, rectangle in wanted if where == face]
            for level in range(1, self.levels):
                # Below level 1 a pixel costs less than another call.
                self._halve(face, level, parts=parts if level == 1 else [_union(parts)])

    def _halve(self, face: int, level: int, *, parts: list[Rectangle]) -> None:
        """Fill parts of a level with means of 2 x 2 texels: blits at half size, bilinear."""
        self.attach(face, level=level)
        _bind(_READ_FRAMEBUFFER, self._source.glo)
        _attach(_READ_FRAMEBUFFER, face, self.texture.glo, level - 1)
        integer, word = ctypes.c_int, ctypes.c_uint
        blit = gl_function("glBlitFramebuffer", *[integer] * 8, word, word)
        for part in parts:
            x, y, width, height = _shrunk(part, level, self.size >> level)
            ends = (x, y, x + width, y + height)
            blit(*(2 * end for end in ends), *ends, _COLOR_BUFFER_BIT, _LINEAR)

    def _allocate_levels(self) -> None:
        self._bind_texture()
        integer = ctypes.c_int
        allocate = gl_function(
            "glTexImage2D",
            *[ctypes.c_uint, *[integer] * 5, ctypes.c_uint, ctypes.c_uint, ctypes.c_void_p],
        )
        for level in range(1, self.levels):
            side = self.size >> level
            for face in range(6):
                allocate(
                    _POSITIVE_X + face, level, _RGBA16F, side, side, 0, _RGBA, _HALF_FLOAT, None
                )
        self._limit_levels()

    def _limit_levels(self) -> None:
        """Tell lookups which levels there are; without it they take the texture for incomplete."""
        set_parameter = gl_function("glTexParameteri", ctypes.c_uint, ctypes.c_uint, ctypes.c_int)
        set_parameter(_TEXTURE_CUBE_MAP, _TEXTURE_MAX_LEVEL, self.levels - 1)

    def _bind_texture(self) -> None:
        gl_function("glActiveTexture", ctypes.c_uint)(_TEXTURE0 + _SPARE_UNIT)
        gl_function("glBindTexture", ctypes.c_uint, ctypes.c_uint)(
            _TEXTURE_CUBE_MAP, self.texture.glo
        )

    def _make_target(self, *, depth: bool) -> moderngl.Framebuffer:
        buffer = self.gl.depth_renderbuffer((self.size, self.size)) if depth else None
        return self.gl.framebuffer([self._stand_in], buffer)


def _bind(target: int, framebuffer: int) -> None:
    gl_function("glBindFramebuffer", ctypes.c_uint, ctypes.c_uint)(target, framebuffer)


def _attach(target: int, face: int, texture: int, level: int) -> None:
    attach = gl_function("glFramebufferTexture2D", *[ctypes.c_uint] * 4, ctypes.c_int)
    attach(target, _COLOR_ATTACHMENT0, _POSITIVE_X + face, texture, level)


def _union(rectangles: list[Rectangle]) -> Rectangle:
    left, low = min(r[0] for r in rectangles), min(r[1] for r in rectangles)
    right, high = max(r[0] + r[2] for r in rectangles), max(r[1] + r[3] for r in rectangles)
    return left, low, right - left, high - low


def _shrunk(rectangle: Rectangle, level: int, side: int) -> Rectangle:
    """Return the texels of a smaller level that a rectangle of level 0 touches."""
    x, y, width, height = rectangle
    left, low = x >> level, y >> level
    right = min(side, ((x + width - 1) >> level) + 1)
    high = min(side, ((y + height - 1) >> level) + 1)
    return left, low, max(0, right - left), max(0, high - low)
