"""``ocularist run`` as people use it: two processes, a crash of one, Ctrl-C, a second start."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from threading import Timer

import pytest

from study.cli import main

ROOT = Path(__file__).parent.parent
LIMIT_S = 300.0  # for a busy machine; a whole run takes a few seconds


@dataclass
class Running:
    """A started ``ocularist run`` with its output, both streams in one."""

    process: subprocess.Popen[str]
    address: str

    def line_with(self, words: str) -> str:
        """Read the output up to a line with these words."""
        assert self.process.stdout is not None
        read = []
        for line in self.process.stdout:
            read.append(line)
            if words in line:
                return line
        raise AssertionError(f"it ended without saying {words!r}:\n{''.join(read)}")

    def child(self, command: str) -> int:
        """Return the process id of the child that runs a command."""
        pid = self.process.pid
        for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
            words = Path(f"/proc/{child}/cmdline").read_text().split("\0")
            if words[1:4] == ["-m", "study", command]:
                return int(child)
        raise AssertionError(f"no child runs {command}")

    def get(self, path: str = "/") -> int:
        """Fetch a page, waiting until somebody answers; return the status."""
        deadline = time.monotonic() + LIMIT_S
        while True:
            try:
                with urllib.request.urlopen(self.address + path, timeout=10) as answer:
                    return int(answer.status)
            except OSError:
                assert time.monotonic() < deadline, "the site does not answer"
                time.sleep(0.1)


@pytest.fixture
def tiny_study(write_short_study: Callable[..., Path]) -> Path:
    """A study of one clip of one small frame."""
    return write_short_study(("1", "far", "low", "medium"), size="64x64", duration_s=0.1)


@contextmanager
def running(study: Path, data: Path) -> Iterator[Running]:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    process = subprocess.Popen(
        [sys.executable, "-m", "study", "run", str(study), "--data", str(data)]
        + ["--port", str(port)],
        cwd=data.parent,
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    watchdog = Timer(LIMIT_S, process.kill)
    watchdog.start()
    try:
        yield Running(process, f"http://127.0.0.1:{port}")
    finally:
        process.terminate()  # in order, so that its children end too
        process.communicate()
        watchdog.cancel()


def is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_site_and_renderer_stand_beside_each_other(tiny_study: Path, tmp_path: Path) -> None:
    with running(tiny_study, tmp_path / "data") as run:
        assert run.address in run.line_with("participants")
        assert f"{run.address}/researcher" in run.line_with("researchers")
        assert "password" in run.line_with("name researcher")
        assert run.get() == 200
        site, renderer = run.child("serve"), run.child("worker")

        os.kill(site, signal.SIGKILL)
        assert "starting it again" in run.line_with("The site ended (SIGKILL)")
        assert run.get() == 200
        assert run.child("serve") != site
        assert run.child("worker") == renderer

        children = [run.child("serve"), renderer]
        run.process.send_signal(signal.SIGTERM)
        assert run.process.wait(30) == 0
        assert [pid for pid in children if is_alive(pid)] == []

    with running(tiny_study, tmp_path / "data") as run:
        run.line_with("researchers")
        assert "stop" in (run.process.stdout.readline() if run.process.stdout else "")


def test_a_clip_is_rendered_once_and_shown_to_simulated_people(
    tiny_study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    clips, ready = tmp_path / "data" / "clips", "The clip is ready; people can take part."
    with running(tiny_study, tmp_path / "data") as run:
        run.line_with(ready)
        run.process.send_signal(signal.SIGINT)
        assert run.process.wait(30) == 0
    (clip,) = clips.glob("*.mp4")
    rendered = clip.stat().st_mtime_ns

    walk = ["simulate", str(tiny_study), "--through-site", "--participants", "2"]
    assert main([*walk, "--data", str(tmp_path / "data")]) == 0
    said = capsys.readouterr().out
    assert said.startswith("2 simulated participants took thesis, version 2;")
    assert main(["export", "--data", str(tmp_path / "data"), "--out", str(tmp_path / "out")]) == 0
    rows = (tmp_path / "out" / "ratings.csv").read_text(encoding="utf-8").splitlines()
    assert len(rows) == 1 + 2 * 2  # two people, one clip, two eyes
    assert all(row.startswith("thesis,2,true,") for row in rows[1:])

    with running(tiny_study, tmp_path / "data") as run:
        run.line_with(ready)
    assert clip.stat().st_mtime_ns == rendered
