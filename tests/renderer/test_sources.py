"""Bakes are stale when the code that made them changes, and only then."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from renderer import cache, sources


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A small renderer: iris.maps imports iris.noise; eye imports the assembly and the maps."""
    root = tmp_path / "renderer"
    files = {
        "iris/__init__.py": "",
        "iris/maps.py": "from renderer.iris import noise\n",
        "iris/noise.py": "def f() -> None:\n    import numpy\n",
        "eye.py": "from renderer.iris.maps import x\nimport renderer.gl.assembly\n",
        "gl/__init__.py": "",
        "gl/assembly.py": "",
        "shaders/eye.frag": "void main() {}",
    }
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    monkeypatch.setattr(sources, "ROOT", root)
    forget()
    yield root
    forget()


def forget() -> None:
    sources.module_version.cache_clear()
    sources.code_version.cache_clear()


def versions(tree: Path, changed: str) -> dict[str, bool]:
    """Which versions a change of one file changes."""
    names = ("renderer.iris.maps", "renderer.eye", "renderer.iris.noise")
    before = {name: sources.module_version(name) for name in names}
    whole = sources.code_version()
    (tree / changed).write_text("# another\n")
    forget()
    moved = {name: sources.module_version(name) != version for name, version in before.items()}
    return moved | {"all": sources.code_version() != whole}


@pytest.mark.parametrize(
    ("changed", "stale"),
    [
        ("iris/noise.py", {"renderer.iris.maps", "renderer.eye", "renderer.iris.noise", "all"}),
        ("iris/maps.py", {"renderer.iris.maps", "renderer.eye", "all"}),
        ("shaders/eye.frag", {"renderer.eye", "all"}),
        ("iris/__init__.py", {"renderer.iris.maps", "renderer.eye", "all"}),
    ],
)
def test_a_change_reaches_who_imports_it(tree: Path, changed: str, stale: set[str]) -> None:
    moved = versions(tree, changed)
    assert {name for name, is_stale in moved.items() if is_stale} == stale


def test_a_bake_does_not_hang_on_what_a_clip_may_be() -> None:
    """Everything that keeps bakes imports the cache: what that imports makes every bake stale."""
    reached, waiting = set[str](), ["cache"]
    while waiting:
        name = waiting.pop()
        if name not in reached:
            reached.add(name)
            waiting += [path.stem for path in sources._imported(sources.ROOT / f"{name}.py")]
    assert reached == {"cache", "sources", "atomic_file"}


def test_strangers_depend_on_everything(tree: Path) -> None:
    assert sources.module_version("tests.renderer.test_sources") == sources.code_version()
    assert tree.is_dir()


def test_both_forms_of_the_cache_ask_for_the_makers_module(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OCULARIST_CACHE", str(tmp_path))
    asked: list[str] = []
    monkeypatch.setattr(cache, "module_version", lambda name: asked.append(name) or "v")
    made = cache.cached_array("a", lambda: np.arange(3))
    np.testing.assert_array_equal(cache.cached_array("a", lambda: np.zeros(3)), made)
    cache.cached_arrays("b", lambda: {"x": made})
    assert set(asked) == {__name__}
