"""What all tests share: databases of both kinds, a Ctrl-C that reaches the programs they start.

A test that asks for ``database_url``, itself or through another fixture, runs twice: on SQLite and
on a real PostgreSQL server, which the first of them starts. Browser tests and those that name
``database_kind`` themselves run on what they name.
"""

from __future__ import annotations

import itertools
import os
import shutil
import signal
from collections.abc import Iterator
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
