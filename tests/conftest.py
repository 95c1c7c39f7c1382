"""What all tests share: databases of both kinds, small studies, a Ctrl-C that reaches programs.

A test that asks for ``database_url``, itself or through another fixture, runs twice: on SQLite and
on a real PostgreSQL server, which the first of them starts. Browser tests and those that name
``database_kind`` themselves run on what they name.
"""

from __future__ import annotations

import itertools
import os
import re
import shutil
import signal
from collections.abc import Callable, Iterator, Mapping
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from study.load.postgresql import TemporaryServer

KINDS = ("sqlite", "postgresql")
BROWSERS = {"chromium", "context", "page"}
MEMORY = Path("/dev/shm")


def pytest_configure() -> None:
    """Heed SIGINT even where whoever started the tests ignores it, as a shell's ``&`` does.

    Programs started from here inherit what is ignored, and some tests press Ctrl-C on them.
    """
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run what uses a database on both kinds; a browser sees no difference, and it is slow."""
    if "database_kind" not in metafunc.fixturenames:
        return
    marks = metafunc.definition.iter_markers("parametrize")
    if not any("database_kind" in mark.args[0] for mark in marks):
        kinds = KINDS[:1] if BROWSERS & set(metafunc.fixturenames) else KINDS
        metafunc.parametrize("database_kind", kinds)


@pytest.fixture(scope="session")
def postgresql() -> Iterator[TemporaryServer]:
    """A PostgreSQL server for all tests, with an empty database of our tables to copy."""
    from study.data.database import open_database
    from study.load.postgresql import TemporaryServer

    in_memory = MEMORY if os.access(MEMORY, os.W_OK) else None
    more = ("max_connections=200", "shared_buffers=32MB", "autovacuum=off")
    with TemporaryServer(parent=in_memory, more=more) as server:
        server.execute("CREATE DATABASE empty")
        open_database(server.url("empty")).close()
        yield server


@pytest.fixture(scope="session")
def empty_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An SQLite file of our tables to copy."""
    from study.data.database import open_database

    path = tmp_path_factory.mktemp("empty") / "study.sqlite3"
    open_database(str(path)).close()
    return path


_numbers = itertools.count()


@pytest.fixture
def database_url(
    request: pytest.FixtureRequest, database_kind: str, tmp_path: Path
) -> Iterator[str]:
    """The address of an empty database of this test alone."""
    if database_kind == "sqlite":
        path = tmp_path / "study.sqlite3"
        shutil.copy(request.getfixturevalue("empty_file"), path)
        yield f"sqlite:///{path}"
        return
    server: TemporaryServer = request.getfixturevalue("postgresql")
    name = f"test_{next(_numbers)}"
    server.execute(f"CREATE DATABASE {name} TEMPLATE empty STRATEGY file_copy")
    yield server.url(name)
    server.execute(f"DROP DATABASE {name} WITH (FORCE)")


@pytest.fixture(scope="session")
def thesis_text() -> str:
    """The thesis's study file without its translations, which lie beside it."""
    file = resources.files("study.design") / "definitions" / "thesis.toml"
    return replaced(file.read_text(encoding="utf-8"), {r"^translations = .*\n": ""})


@pytest.fixture
def thesis_with(thesis_text: str) -> Callable[[str, str], str]:
    """What gives the thesis's study file other contents of one table."""

    def change(table: str, contents: str) -> str:
        old = rf"^\[{table}\].*\n(.|\n)*?(?=^\[)"
        return replaced(thesis_text, {old: f"[{table}]\n{contents}\n\n"})

    return change


@pytest.fixture
def write_short_study(thesis_text: str, tmp_path: Path) -> Callable[..., Path]:
    """What writes a study like the thesis's, but for clips that are rendered in no time."""

    def write(*clips: tuple[str, str, str, str], size: str, duration_s: float) -> Path:
        """``clips`` are each an id, a distance and the LoDs of the left and the right eye."""
        names = ("id", "distance", "left", "right")
        tables = (
            "".join(f'{name} = "{value}"\n' for name, value in zip(names, clip, strict=True))
            for clip in clips
        )
        changes = {
            r"^sizes = .*$": f'sizes = ["{size}"]',
            r"^duration_s = .*$": f"duration_s = {duration_s}",
            r"^fps = .*$": "fps = 10",
            r"^crowd = .*$": "crowd = 0",
            r"^directions = .*$": 'directions = ["rightward"]',
            r"^\[\[practice\]\](.|\n)*?(?=^\[consent\])": "".join(
                f"[[clips]]\n{table}\n" for table in tables
            ),
        }
        path = tmp_path / "short.toml"
        path.write_text(replaced(thesis_text, changes), encoding="utf-8")
        return path

    return write


def replaced(text: str, changes: Mapping[str, str]) -> str:
    """Return a text with each pattern replaced, every one of which is found exactly once."""
    for pattern, value in changes.items():
        text, count = re.subn(pattern, lambda _, value=value: value, text, flags=re.MULTILINE)
        assert count == 1, pattern
    return text
