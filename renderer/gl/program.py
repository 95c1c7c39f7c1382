"""Shader assembly: includes, generated constants, readable errors and checked uniforms.

A level is chosen by a generated header of ``const int`` plus plain ``if`` in the effect's file: a
misspelt constant fails to compile and names itself, dead code still disappears.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import moderngl
import numpy as np

from renderer.detail import LEVELS, Detail

SHADERS: Final = Path(__file__).parent.parent / "shaders"
VERSION_LINE: Final = "#version 430 core\n"
_INCLUDE: Final = re.compile(r'^\s*#include\s+"([^"]+)"\s*$')
_UNIFORM: Final = re.compile(r"^\s*uniform\s+(\w+)\s+(\w+)\s*(\[[^\]]*\])?\s*;", re.MULTILINE)
_ERROR_PLACE: Final = re.compile(r"\b(\d+):(\d+)\((\d+)\)|\b(\d+)\((\d+)\)")

_FLOAT: Final = struct.Struct("f")

Constants = Mapping[str, int | float]


@dataclass
class Source:
    """One stage's text with the files that its ``#line`` numbers mean."""

    text: str
    files: list[str]


def detail_constants(detail: Detail) -> dict[str, int]:
    """Return the header of one LoD: ``OFF .. ULTRA`` and the level of each effect."""
    numbers = {level.upper(): rank for rank, level in enumerate(LEVELS)}
    return numbers | {
        effect.upper(): LEVELS.index(level) for effect, level in detail.levels().items()
    }


def assemble(
    name: str,
    constants: Constants | None = None,
    *,
    swapped: Mapping[str, str] = MappingProxyType({}),
) -> Source:
    """Read a shader, its includes (depth first, each file once) and the constants' header.

    ``swapped`` gives the file that stands in for another: many eyes drawn together tell their
    places otherwise than one eye does. Raises FileNotFoundError naming the including file and line.
    """
    files: list[str] = []
    body = _expand(name, files, included_from="the program", swapped=swapped)
    header = "".join(_constant(key, value) for key, value in (constants or {}).items())
    return Source(VERSION_LINE + header + body, files)


def _constant(name: str, value: int | float) -> str:
    if isinstance(value, int):
        return f"const int {name} = {value};\n"
    return f"const float {name} = {float(value)!r};\n"


def _expand(name: str, files: list[str], *, included_from: str, swapped: Mapping[str, str]) -> str:
    path = SHADERS / name
    if not path.is_file():
        raise FileNotFoundError(f"{included_from}: no shader file {name} in {SHADERS.name}/")
    number = len(files)
    files.append(name)
    lines = [f"#line 1 {number}"]
    for row, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        match = _INCLUDE.match(line)
        wanted = swapped.get(match[1], match[1]) if match else ""
        if not match:
            lines.append(line)
        elif wanted not in files:
            place = f"{name}:{row}"
            lines.append(_expand(wanted, files, included_from=place, swapped=swapped))
            lines.append(f"#line {row + 1} {number}")
    return "\n".join(lines) + "\n"


@dataclass
class Program:
    """A linked program whose uniforms are set by name and checked against its sources.

    A frame sets thousands of them, most to what they were: ``set`` writes those that change.
    """

    gl_program: moderngl.Program
    declared: dict[str, str]
    units: dict[str, int] = field(default_factory=dict)
    _active: frozenset[str] = field(init=False, repr=False)
    _written: dict[str, bytes] = field(init=False, repr=False, default_factory=dict)

    def __post_init__(self) -> None:
        self._active = frozenset(self.gl_program)  # asking GL's program walks through all its names

    def set(self, **values: Any) -> None:
        """Set uniforms and bind textures; a name that no source declares raises KeyError.

        A declared uniform that the chosen levels never read is skipped. Matrices are given as
        (4, 4) arrays of column-vector convention; textures get a unit of their own.
        """
        for name, value in values.items():
            if name not in self.declared:
                raise KeyError(f"{name}: no shader of this program declares such a uniform")
            if name not in self._active:
                continue
            if name in self.units:
                value.use(location=self.units[name])
                continue
            data = _pack(value, self.declared[name])
            if data != self._written.get(name):
                plain_uniform(self.gl_program, name).write(data)
                self._written[name] = data

    def is_active(self, name: str) -> bool:
        """Whether the linked program still reads this uniform."""
        return name in self._active


def plain_uniform(gl_program: moderngl.Program, name: str) -> moderngl.Uniform:
    """Return a linked program's uniform; raises TypeError for a block or an attribute."""
    member = gl_program[name]
    if not isinstance(member, moderngl.Uniform):
        raise TypeError(f"{name}: a {type(member).__name__}, not a plain uniform")
    return member


def _pack(value: Any, kind: str) -> bytes:
    if kind == "float":
        return _FLOAT.pack(value)
    if kind in {"int", "bool", "ivec2", "ivec3", "ivec4"}:
        return np.ascontiguousarray(value, dtype=np.int32).tobytes()
    array = np.asarray(value, dtype=np.float32)
    if kind.startswith("mat"):
        array = np.swapaxes(array, -1, -2)
    return np.ascontiguousarray(array).tobytes()


def build_program(
    gl: moderngl.Context,
    vertex: str,
    *,
    fragment: str | None = None,
    geometry: str | None = None,
    constants: Constants | None = None,
    rewrite_fragment: Callable[[str], str] | None = None,
    swapped: Mapping[str, str] = MappingProxyType({}),
) -> Program:
    """Compile and link shader files of ``renderer/shaders``; ``swapped`` as in ``assemble``.

    ``rewrite_fragment`` changes the assembled fragment shader before it is compiled.
    Raises RuntimeError with our file names and lines when GLSL does not compile.
    """
    stages = {
        "vertex_shader": vertex,
        "fragment_shader": fragment,
        "geometry_shader": geometry,
    }
    sources = {
        stage: assemble(name, constants, swapped=swapped) for stage, name in stages.items() if name
    }
    try:
        texts: dict[str, Any] = {stage: source.text for stage, source in sources.items()}
        if rewrite_fragment:
            texts["fragment_shader"] = rewrite_fragment(texts["fragment_shader"])
        program = gl.program(**texts)
    except moderngl.Error as error:
        raise RuntimeError(_explain(str(error), sources)) from error
    declared = {
        name: kind for source in sources.values() for kind, name, _ in _UNIFORM.findall(source.text)
    }
    samplers = [name for name, kind in declared.items() if "sampler" in kind and name in program]
    units = {name: unit for unit, name in enumerate(samplers)}
    for name, unit in units.items():
        plain_uniform(program, name).value = unit
    return Program(program, declared, units)


def _explain(message: str, sources: Mapping[str, Source]) -> str:
    stage = "fragment_shader" if "fragment_shader" in message else "vertex_shader"
    if "geometry_shader" in message and "geometry_shader" in sources:
        stage = "geometry_shader"
    files = sources[stage].files if stage in sources else []

    def place(match: re.Match[str]) -> str:
        number, line = (match[1], match[2]) if match[1] else (match[4], match[5])
        return f"{files[int(number)]}:{line}" if int(number) < len(files) else match[0]

    return f"{stage.replace('_', ' ')} does not compile\n" + _ERROR_PLACE.sub(place, message)
