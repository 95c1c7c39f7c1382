"""PostgreSQL servers of one's own: private while they run, gone afterwards, or why not."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import psycopg
import pytest

from study.load import postgresql as module
from study.load.postgresql import NoServerError, TemporaryServer, programs

KEEPER = """
import os, sys, time
from study.load.postgresql import TemporaryServer
with TemporaryServer() as server:
    print(server.process.pid, server.folder, flush=True)
    time.sleep(600)
"""


def test_a_server_listens_on_its_own_socket_alone(postgresql: Any) -> None:
    where = f"host={postgresql.folder} user=ocularist dbname=empty"
    with psycopg.connect(where) as connection:
        assert connection.execute("SHOW listen_addresses").fetchone() == ("",)
        assert connection.execute("SHOW server_encoding").fetchone() == ("UTF8",)
    assert postgresql.folder.stat().st_mode & 0o077 == 0


def test_a_server_ends_with_its_keeper_even_if_that_is_killed() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", KEEPER],
        stdout=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[1],
    ) as keeper:
        assert keeper.stdout is not None
        pid, folder = keeper.stdout.readline().split()
        with psycopg.connect(f"host={folder} user=ocularist dbname=postgres") as connection:
            keeper.send_signal(signal.SIGKILL)
            keeper.wait()
            # The server lets those who are there finish, and takes nobody new.
            connection.close()
        server = Path(f"/proc/{pid}")
        for _ in range(2000):
            if not server.exists() or "(postgres) Z" in (server / "stat").read_text():
                break
            subprocess.run(["true"], check=True)
        else:
            pytest.fail("the server outlived its keeper")
        shutil.rmtree(folder)


def test_without_the_programs_it_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "DEBIAN", tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(NoServerError, match=r"not installed here .* apt-get install postgresql"):
        programs()


def test_the_newest_server_is_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for version in ("9.6", "15", "17"):
        (tmp_path / version / "bin").mkdir(parents=True)
        (tmp_path / version / "bin" / "initdb").touch()
    monkeypatch.setattr(module, "DEBIAN", tmp_path)
    assert programs() == tmp_path / "17" / "bin"


def test_a_server_that_cannot_start_says_why_and_leaves_nothing(tmp_path: Path) -> None:
    tmp_path.chmod(0o755)
    server = TemporaryServer(more=("no_such_setting=1",))
    with pytest.raises(NoServerError, match=r"PostgreSQL did not start: .*no_such_setting"), server:
        pass
    assert not server.folder.exists()
