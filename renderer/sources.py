"""Which code made a thing: digests of the renderer's own sources.

A clip is stale when any source changes. A bake on disk is stale when a source changes that it was
made from: its module and whatever of the renderer that module imports, however indirectly.
"""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).parent
SHADERS: Final = frozenset({".glsl", ".vert", ".frag", ".comp"})


@cache
def code_version() -> str:
    """Return 16 hexadecimal digits over the renderer's own sources: same code, same frames."""
    return _digest(path for path in ROOT.rglob("*") if path.suffix in SHADERS | {".py", ".json"})


@cache
def module_version(module: str) -> str:
    """Return 16 hexadecimal digits over a module and what it imports of the renderer.

    ``module`` is a dotted name. Shaders count where ``renderer.gl.assembly`` is among the imported.
    A module outside of the renderer depends on all of it.
    """
    start = _source(module)
    if start is None:
        return code_version()
    found, waiting = set[Path](), [start]
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting += _imported(path)
    if ROOT / "gl" / "assembly.py" in found:
        found |= {path for path in ROOT.rglob("*") if path.suffix in SHADERS}
    return _digest(found)


def _digest(paths: Iterable[Path]) -> str:
    digest = hashlib.sha256()
    for path in sorted(paths):
        digest.update(path.relative_to(ROOT).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _imported(path: Path) -> list[Path]:
    """Return the renderer's modules that a module imports, anywhere in it."""
    names: list[str] = []
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.Import):
            names += [item.name for item in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names += [node.module, *(f"{node.module}.{item.name}" for item in node.names)]
    return [source for name in names if (source := _source(name)) is not None]


def _source(module: str) -> Path | None:
    """Return the file of a module of the renderer, None for any other name."""
    package, *parts = module.split(".")
    if package != ROOT.name:
        return None
    base = ROOT.joinpath(*parts)
    candidates = (base.with_suffix(".py"), base / "__init__.py")
    return next((path for path in candidates if path.is_file()), None)
