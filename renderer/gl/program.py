"""Linked programs with uniforms that are set by name and checked against their sources."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Final

import moderngl

from renderer.gl.assembly import Constants, assemble, explain
from renderer.gl.uniforms import PlainUniform, plain_uniform

_UNIFORM: Final = re.compile(r"^\s*uniform\s+(\w+)\s+(\w+)\s*(\[[^\]]*\])?\s*;", re.MULTILINE)


@dataclass
class Program:
    """A linked program whose uniforms are set by name and checked against its sources.

    A frame sets thousands of them, most to what they were: ``set`` writes those that change.
    """

    gl_program: moderngl.Program
    declared: dict[str, str]
    units: dict[str, int] = field(default_factory=dict)
    _active: frozenset[str] = field(init=False, repr=False)
    _plain: dict[str, PlainUniform] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._active = frozenset(self.gl_program)  # asking GL's program walks through all its names
        self._plain = {
            name: PlainUniform(plain_uniform(self.gl_program, name), kind)
            for name, kind in self.declared.items()
            if name in self._active and name not in self.units
        }

    def set(self, **values: Any) -> None:
        """Set uniforms and bind textures; a name that no source declares raises KeyError.

        A declared uniform that the chosen levels never read is skipped. Matrices are given as
        (4, 4) arrays of column-vector convention; textures get a unit of their own. Read-only
        arrays (see ``constant``) that a program has already are not looked into again.
        """
        for name, value in values.items():
            plain = self._plain.get(name)
            if plain is not None:
                if value is not plain.given:
                    plain.write(value)
            elif name in self.units:
                value.use(location=self.units[name])
            elif name not in self.declared:
                raise KeyError(f"{name}: no shader of this program declares such a uniform")

    def is_active(self, name: str) -> bool:
        """Whether the linked program still reads this uniform."""
        return name in self._active


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
        raise RuntimeError(explain(str(error), sources)) from error
    declared = {
        name: kind for source in sources.values() for kind, name, _ in _UNIFORM.findall(source.text)
    }
    samplers = [name for name, kind in declared.items() if "sampler" in kind and name in program]
    units = {name: unit for unit, name in enumerate(samplers)}
    for name, unit in units.items():
        plain_uniform(program, name).value = unit
    return Program(program, declared, units)
