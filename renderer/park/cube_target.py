"""A cube map that is drawn into: its faces as targets, and its smaller levels.

moderngl accepts no face of a cube as a target, so the faces are attached through OpenGL itself.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from typing import Final

import moderngl

from renderer.gl.context import chooses_parts
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
        self._depth = gl.depth_renderbuffer((size, size)) if depth else None
        self._targets: dict[tuple[int, int], moderngl.Framebuffer] = {}
        self._halves_parts = chooses_parts(gl)

    def attach(self, face: int, *, level: int = 0) -> moderngl.Framebuffer:
        """Make a face and level the target, with viewport and scissor over all of it."""
        target = self._target(face, level)
        target.use()
        target.scissor = target.viewport
        return target

    def build_levels(self, rectangles: Iterable[tuple[int, Rectangle]] | None = None) -> None:
        """Fill the smaller levels by halving, all or below rectangles (face, (x, y, w, h)).

        A GPU always fills all: that takes it less than being told of parts.
        """
        if self.levels == 1:
            return
        if not self._halves_parts:
            self.texture.build_mipmaps(0, self.levels - 1)
            return
        whole = [(face, (0, 0, self.size, self.size)) for face in range(6)]
        parts: dict[int, list[Rectangle]] = {}
        for face, rectangle in whole if rectangles is None else rectangles:
            parts.setdefault(face, []).append(rectangle)
        for face, own in parts.items():
            self._halve(face, own)

    def _halve(self, face: int, parts: list[Rectangle]) -> None:
        """Fill a face's levels below parts with means of 2 x 2 texels: bilinear blits to half."""
        integer, word = ctypes.c_int, ctypes.c_uint
        bind = gl_function("glBindFramebuffer", word, word)
        blit = gl_function("glBlitFramebuffer", *[integer] * 8, word, word)
        # Below level 1 a pixel costs less than another call.
        joined = [_union(parts)]
        for level in range(1, self.levels):
            source = self._target(face, level - 1)  # making it would bind it, so it comes first
            self.attach(face, level=level)
            bind(_READ_FRAMEBUFFER, source.glo)
            for part in parts if level == 1 else joined:
                ends = _shrunk(part, level, self.size >> level)
                blit(*(2 * end for end in ends), *ends, _COLOR_BUFFER_BIT, _LINEAR)

    def _target(self, face: int, level: int) -> moderngl.Framebuffer:
        if (face, level) not in self._targets:
            self._targets[face, level] = self._make_target(face, level)
        return self._targets[face, level]

    def _make_target(self, face: int, level: int) -> moderngl.Framebuffer:
        target = self.gl.framebuffer([self._stand_in], None if level else self._depth)
        target.use()
        word = ctypes.c_uint
        attach = gl_function("glFramebufferTexture2D", *[word] * 4, ctypes.c_int)
        attach(_FRAMEBUFFER, _COLOR_ATTACHMENT0, _POSITIVE_X + face, self.texture.glo, level)
        status = gl_function("glCheckFramebufferStatus", word, result=word)(_FRAMEBUFFER)
        if status != _FRAMEBUFFER_COMPLETE:
            raise RuntimeError(
                f"cube face {FACES[face]}, level {level}: the driver refuses it as a target "
                f"(framebuffer status {status:#x})"
            )
        target.viewport = (0, 0, self.size >> level, self.size >> level)
        return target

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


def _union(rectangles: list[Rectangle]) -> Rectangle:
    left, low = min(r[0] for r in rectangles), min(r[1] for r in rectangles)
    right, high = max(r[0] + r[2] for r in rectangles), max(r[1] + r[3] for r in rectangles)
    return left, low, right - left, high - low


def _shrunk(rectangle: Rectangle, level: int, side: int) -> Rectangle:
    """Return the first texels (x, y) of a smaller level below a rectangle, and those after."""
    x, y, width, height = rectangle
    right = min(side, ((x + width - 1) >> level) + 1)
    high = min(side, ((y + height - 1) >> level) + 1)
    return x >> level, y >> level, right, high
