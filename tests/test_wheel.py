"""A wheel brings everything that is not Python: pages, studies, shaders, migrations."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent

# Runs where only the wheel is installed beside the dependencies; prints what it finds.
LOOK = """
from importlib import resources
from pathlib import Path

import study
from study.data.database import open_database
from study.design.definition import built_in_names, read_definition
from study.site.resources import resource_folder

for name in built_in_names():
    read_definition(name)
print("package", Path(study.__file__).parent.parent)
print("studies", *built_in_names())
for name in ("templates", "static"):
    print(name, resource_folder(name))
print("shaders", len(list((resources.files("renderer") / "shaders").iterdir())))
open_database("sqlite:///new.sqlite3").close()
print("tables", Path("new.sqlite3").stat().st_size > 0)
"""


def run(arguments: list[str], folder: Path, *, path: Path | None = None) -> str:
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    if path is not None:
        environment["PYTHONPATH"] = str(path)
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder that holds the installed wheel and nothing else."""
    folder = tmp_path_factory.mktemp("wheel")
    run(["-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)], ROOT)
    (wheel,) = folder.glob("*.whl")
    target = folder / "installed"
    run(
        ["-m", "pip", "install", "--no-deps", "--no-index", "--target", str(target), str(wheel)],
        folder,
    )
    return target


def test_an_installed_wheel_finds_its_pages_studies_shaders_and_tables(
    installed: Path, tmp_path: Path
) -> None:
    found = dict(
        line.split(" ", 1) for line in run(["-c", LOOK], tmp_path, path=installed).splitlines()
    )
    assert Path(found["package"]) == installed
    assert "thesis" in found["studies"].split()
    assert Path(found["templates"]) == installed / "study" / "templates"
    assert Path(found["static"]) == installed / "study" / "static"
    assert int(found["shaders"]) == len(list((ROOT / "renderer" / "shaders").iterdir()))
    assert found["tables"] == "True"


def files_in(folder: Path) -> set[Path]:
    return {
        path.relative_to(folder)
        for path in folder.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def test_a_wheel_holds_every_file_of_the_packages_and_pages(installed: Path) -> None:
    pages = {name: files_in(ROOT / name) for name in ("templates", "static")}
    for package in ("analysis", "renderer", "study"):
        here = files_in(ROOT / package)
        if package == "study":
            here |= {Path(name) / path for name, paths in pages.items() for path in paths}
        assert files_in(installed / package) == here


def test_a_wheel_brings_the_command(installed: Path) -> None:
    said = run(["-m", "study", "--help"], installed.parent, path=installed)
    assert said.startswith("usage: ocularist")
