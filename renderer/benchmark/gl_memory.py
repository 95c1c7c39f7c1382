"""How much memory GL's objects and the process take.

GL is asked for every texture, buffer and renderbuffer that it holds, by name: what a module of ours
forgot to count is counted too. Sizes are those of the contents; a driver may round them up.
"""

from __future__ import annotations

import ctypes
import resource
from collections.abc import Callable
from pathlib import Path
from typing import Final

import moderngl

from renderer.gl.functions import gl_function

LARGEST_NAME: Final = 20_000  # names are given out from 1 upwards
LARGEST_LEVEL: Final = 16
_CUBE_MAP: Final = 0x8513
_TARGET: Final = 0x1006
_TEXTURE_SIDES: Final = (0x1000, 0x1001, 0x8071)  # width, height, depth or layers
_TEXTURE_BITS: Final = (0x805C, 0x805D, 0x805E, 0x805F, 0x884A, 0x88F1)  # r g b a depth stencil
_TEXTURE_SAMPLES: Final = 0x9106
_RENDERBUFFER_SIDES: Final = (0x8D42, 0x8D43)
_RENDERBUFFER_BITS: Final = (0x8D50, 0x8D51, 0x8D52, 0x8D53, 0x8D54, 0x8D55)
_RENDERBUFFER_SAMPLES: Final = 0x8CAB
_BUFFER_SIZE: Final = 0x8764

Ask = Callable[[int], int]


def gl_bytes(gl: moderngl.Context) -> dict[str, int]:
    """Return the bytes of all textures, buffers and renderbuffers of the current context.

    Empty where the driver has no OpenGL 4.5, which alone can be asked by name.
    """
    if gl.version_code < 450:
        return {}
    return {
        "textures": sum(map(_texture_bytes, _names("glIsTexture"))),
        "buffers": sum(map(_buffer_bytes, _names("glIsBuffer"))),
        "renderbuffers": sum(map(_renderbuffer_bytes, _names("glIsRenderbuffer"))),
    }


def resident_bytes(status: Path = Path("/proc/self/status")) -> int:
    """Return the process's resident set: as Linux tells it now, elsewhere its largest so far."""
    try:
        lines = status.read_text(encoding="utf-8").splitlines()
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("VmRSS:"))


def _names(question: str) -> list[int]:
    is_one = gl_function(question, ctypes.c_uint, result=ctypes.c_ubyte)
    return [name for name in range(1, LARGEST_NAME) if is_one(name)]


def _texture_bytes(name: int) -> int:
    faces = 6 if _asking("glGetTextureParameteriv", name)(_TARGET) == _CUBE_MAP else 1
    total = 0
    for level in range(LARGEST_LEVEL):
        ask = _asking("glGetTextureLevelParameteriv", name, level)
        width, height, depth = (ask(side) for side in _TEXTURE_SIDES)
        if width == 0:
            break
        texels = width * height * depth * max(ask(_TEXTURE_SAMPLES), 1)
        total += texels * _bits(ask, _TEXTURE_BITS) // 8
    return faces * total


def _renderbuffer_bytes(name: int) -> int:
    ask = _asking("glGetNamedRenderbufferParameteriv", name)
    width, height = (ask(side) for side in _RENDERBUFFER_SIDES)
    samples = max(ask(_RENDERBUFFER_SAMPLES), 1)
    return width * height * samples * _bits(ask, _RENDERBUFFER_BITS) // 8


def _buffer_bytes(name: int) -> int:
    return _asking("glGetNamedBufferParameteriv", name)(_BUFFER_SIZE)


def _bits(ask: Ask, names: tuple[int, ...]) -> int:
    bits = sum(ask(name) for name in names)
    return 32 if bits == 24 else bits  # 24 bits of depth or colour lie in words of 32


def _asking(function: str, *place: int) -> Ask:
    """Return a question about one object (and level): a parameter's name to its value."""
    asked = gl_function(function, *[ctypes.c_int] * (len(place) + 1), ctypes.POINTER(ctypes.c_int))

    def ask(parameter: int) -> int:
        answer = ctypes.c_int(0)
        asked(*place, parameter, ctypes.byref(answer))
        return answer.value

    return ask
