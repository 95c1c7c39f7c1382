"""Uniforms of a linked program, and what GL has of each already."""

from __future__ import annotations

import struct
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

_FLOAT: Final = struct.Struct("f")
_WHOLE: Final = frozenset({"int", "bool", "ivec2", "ivec3", "ivec4"})
_NOTHING: Final = object()


def constant(values: npt.ArrayLike) -> npt.NDArray[Any]:
    """Return numbers as a read-only array of their own, which ``Program.set`` knows again."""
    array = np.array(values)
    array.flags.writeable = False
    return array


class PlainUniform:
    """A uniform that is no texture: what GL has, and the unchangeable object that it was given."""

    def __init__(self, uniform: moderngl.Uniform, kind: str) -> None:
        self.given: Any = _NOTHING
        self._uniform = uniform
        self._written = b""
        self._dtype = np.int32 if kind in _WHOLE else np.float32
        self._is_float = kind == "float"
        self._is_matrix = kind.startswith("mat")

    def write(self, value: Any) -> None:
        """Give GL a value unless it has the same numbers already."""
        data = self._packed(value)
        if data != self._written:
            self._uniform.write(data)
            self._written = data
        self.given = value if _is_constant(value) else _NOTHING

    def _packed(self, value: Any) -> bytes:
        if self._is_float:
            return _FLOAT.pack(value)
        array = np.asarray(value, dtype=self._dtype)
        if self._is_matrix:
            array = array.swapaxes(-1, -2)
        return array.tobytes()


def _is_constant(value: Any) -> bool:
    """Whether an object keeps its numbers: a number, a tuple of them, a ``constant``."""
    if isinstance(value, np.ndarray):
        return value.base is None and not value.flags.writeable
    return isinstance(value, (float, int, tuple))


def plain_uniform(gl_program: moderngl.Program, name: str) -> moderngl.Uniform:
    """Return a linked program's uniform; raises TypeError for a block or an attribute."""
    member = gl_program[name]
    if not isinstance(member, moderngl.Uniform):
        raise TypeError(f"{name}: a {type(member).__name__}, not a plain uniform")
    return member
