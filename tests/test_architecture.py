"""The house's rules, read from the sources: who may import whom, and what lies at the top."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
OURS = ("analysis", "renderer", "study")
PURE_RENDERER = (
    "renderer",
    *(
        f"renderer.{name}"
        for name in (
            "atomic_file",
            "camera",
            "clip",
            "clip_checks",
            "clip_values",
            "detail",
            "eye",
            "eye.place",
            "lod",
            "lod.choice",
            "lod.policy",
            "manifest",
            "sources",
            "view",
        )
    ),
)
# What study may know of the renderer; the entry point alone starts GL.
STIMULI = set(PURE_RENDERER)
ENTRY_POINT = ("study.cli", "study.commands")
# The rooms of study, each with the rooms it may import from.
ROOMS = {
    "study.texts": {"study.texts"},
    "study.design": {"study.design", "study.texts"},
    "study.data": {"study.data", "study.design"},
    "study.site": {"study.site", "study.data", "study.design", "study.settings", "study.texts"},
    "study.inspection": {"study.inspection", "study.site.headers", "study.site.resources"},
}
TOP = {
    *("analysis", "renderer", "study", "templates", "static", "tests", "docs", "deploy"),
    *("pyproject.toml", "requirements.lock", "requirements-test.lock", "Makefile", "LICENSE"),
    *("README.md", "CHANGELOG.md", ".ci", ".gitignore", ".gitattributes"),
}
MADE = {
    *(".git", ".venv", "out", "build", "dist", "ocularist-data"),
    *(".mypy_cache", ".pytest_cache", ".ruff_cache", ".hypothesis", "__pycache__"),
}


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def is_within(module: str, packages: tuple[str, ...] | set[str]) -> bool:
    return any(module == package or module.startswith(package + ".") for package in packages)


SOURCES = {
    module_name(path): ast.parse(path.read_text(encoding="utf-8"), filename=str(path))
    for package in OURS
    for path in sorted((ROOT / package).rglob("*.py"))
}


def imported(module: str, nodes: Iterator[ast.AST]) -> Iterator[str]:
    """Yield the absolute dotted names that a module's import statements mention."""
    is_package = any(name.startswith(module + ".") for name in SOURCES)
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parent = module.split(".")
                parent = parent[: len(parent) - node.level + (1 if is_package else 0)]
                base = ".".join([*parent, base] if base else parent)
            yield from (f"{base}.{alias.name}" for alias in node.names)


def own_modules(names: Iterator[str]) -> set[str]:
    """Reduce names to our modules: ``renderer.clip.ClipSpec`` is ``renderer.clip``."""
    found = set()
    for name in names:
        module = name
        while module and module not in SOURCES:
            module = module.rpartition(".")[0]
        found.add(module)
    return found - {""}


def all_imports(module: str) -> set[str]:
    return own_modules(imported(module, ast.walk(SOURCES[module])))


def imports_at_load(module: str) -> set[str]:
    return own_modules(imported(module, iter(SOURCES[module].body)))


def offences(package: str, allowed: set[str]) -> list[str]:
    return [
        f"{module} imports {name}"
        for module in SOURCES
        if is_within(module, (package,))
        for name in sorted(all_imports(module))
        if not is_within(name, allowed)
    ]


@pytest.mark.parametrize("package", ["analysis", "renderer"])
def test_analysis_and_renderer_import_nothing_of_ours(package: str) -> None:
    assert offences(package, {package}) == []


@pytest.mark.parametrize("room", ROOMS)
def test_inside_study_the_site_reads_data_and_data_reads_the_design(room: str) -> None:
    allowed = ROOMS[room] | {"study", "analysis"} | STIMULI
    assert [line for line in offences(room, allowed) if "study" in line.split()[-1]] == []


def test_study_knows_clips_and_manifests_but_no_gl() -> None:
    found = [
        f"{module} imports {name}"
        for module in SOURCES
        if is_within(module, ("study",)) and not is_within(module, ENTRY_POINT)
        for name in sorted(all_imports(module))
        if is_within(name, ("renderer",)) and name not in STIMULI
    ]
    assert found == []


def test_nobody_takes_a_private_name_from_another_package() -> None:
    found = [
        f"{module} imports {name}"
        for module, tree in SOURCES.items()
        for name in imported(module, ast.walk(tree))
        if is_within(name, OURS)
        and any(part.startswith("_") for part in name.split("."))
        and name.rpartition(".")[0].split(".")[:2] != module.split(".")[:2]
    ]
    assert found == []


def test_the_pure_part_of_the_renderer_needs_no_gl() -> None:
    allowed = set(sys.stdlib_module_names) | {"numpy", "renderer"}
    found = [
        f"{module} imports {name}"
        for module in PURE_RENDERER
        for name in imported(module, ast.walk(SOURCES[module]))
        if name.partition(".")[0] not in allowed
    ]
    found += [
        f"{module} imports {name}"
        for module in PURE_RENDERER
        for name in all_imports(module) - set(PURE_RENDERER)
    ]
    assert found == []


def test_the_design_of_a_study_knows_neither_web_nor_database() -> None:
    forbidden = {"fastapi", "starlette", "sqlalchemy", "alembic", "uvicorn", "jinja2"}
    found = [
        f"{module} imports {name}"
        for module, tree in SOURCES.items()
        if is_within(module, ("study.design",))
        for name in imported(module, ast.walk(tree))
        if name.partition(".")[0] in forbidden
    ]
    assert found == []


def test_only_the_data_room_speaks_sql() -> None:
    found = [
        module
        for module, tree in SOURCES.items()
        if not is_within(module, ("study.data",))
        and any(
            name.partition(".")[0] in {"sqlalchemy", "sqlite3", "alembic"}
            for name in imported(module, ast.walk(tree))
        )
    ]
    assert found == []


def test_modules_do_not_import_each_other_in_a_circle() -> None:
    # A package's own __init__ gathers what its modules offer: that is no circle.
    graph = {
        module: {
            name
            for name in imports_at_load(module)
            if name != module and not module.startswith(name + ".")
        }
        for module in SOURCES
    }
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail("import circle: " + " -> ".join(error.args[1]))


@pytest.mark.parametrize("package", OURS)
def test_importing_a_package_loads_no_gl_web_framework_or_plotting(package: str) -> None:
    heavy = "moderngl glcontext fastapi starlette sqlalchemy uvicorn matplotlib"
    code = f"import sys, {package}; print(*(set({heavy.split()!r}) & set(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == []


def test_nothing_new_stands_at_the_top() -> None:
    found = {path.name for path in ROOT.iterdir() if path.suffix != ".egg-info"}
    assert found - TOP - MADE == set()
