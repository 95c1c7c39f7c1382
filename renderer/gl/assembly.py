"""The text of shaders: includes, generated constants, and compilers' messages with our file names.

A level is chosen by a generated header of ``const int`` plus plain ``if`` in the effect's file: a
misspelt constant fails to compile and names itself, dead code still disappears.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final

from renderer.detail import LEVELS, Detail

SHADERS: Final = Path(__file__).parent.parent / "shaders"
VERSION_LINE: Final = "#version 430 core\n"
_INCLUDE: Final = re.compile(r'^\s*#include\s+"([^"]+)"\s*$')
_ERROR_PLACE: Final = re.compile(r"\b(\d+):(\d+)\((\d+)\)|\b(\d+)\((\d+)\)")

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


def explain(message: str, sources: Mapping[str, Source]) -> str:
    """Return a compiler's message about stages with our files in the place of their numbers."""
    stage = "fragment_shader" if "fragment_shader" in message else "vertex_shader"
    if "geometry_shader" in message and "geometry_shader" in sources:
        stage = "geometry_shader"
    files = sources[stage].files if stage in sources else []

    def place(match: re.Match[str]) -> str:
        number, line = (match[1], match[2]) if match[1] else (match[4], match[5])
        return f"{files[int(number)]}:{line}" if int(number) < len(files) else match[0]

    return f"{stage.replace('_', ' ')} does not compile\n" + _ERROR_PLACE.sub(place, message)
