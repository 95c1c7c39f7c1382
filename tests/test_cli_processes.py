"""A process that ends is started again, later each time; the others go on; stopping stops all."""

from __future__ import annotations

import signal
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from study.commands.errors import CommandError
from study.commands.processes import LONGEST_WAIT_S, STEADY_S, Kept, ending, start_all, stop_all


@dataclass
class FakeProcess:
    status: int | None = None
    ignores_terminate: bool = False
    told: list[str] = field(default_factory=list)

    def poll(self) -> int | None:
        return self.status

    def wait(self, timeout: float | None = None) -> int:
        if self.status is None:
            raise subprocess.TimeoutExpired("fake", timeout or 0.0)
        return self.status

    def terminate(self) -> None:
        self.told.append("terminate")
        if not self.ignores_terminate:
            self.status = -signal.SIGTERM

    def kill(self) -> None:
        self.told.append("kill")
        self.status = -signal.SIGKILL


@dataclass
class Scene:
    """A kept process, a clock that is moved by hand, and what was said."""

    now: float = 0.0
    said: list[str] = field(default_factory=list)
    started: list[FakeProcess] = field(default_factory=list)

    def start(self) -> FakeProcess:
        self.started.append(FakeProcess())
        return self.started[-1]

    def keep(self, name: str) -> Kept:
        return Kept(name, self.start, self.said.append, clock=lambda: self.now)


def crash_and_wait(scene: Scene, kept: Kept) -> float:
    """End the process, then tick every half second; return how long it stayed away in s."""
    count = len(scene.started)
    scene.started[-1].status = 1
    ended = scene.now
    kept.tick()
    while len(scene.started) == count:
        scene.now += 0.5
        kept.tick()
    return scene.now - ended


def test_a_process_that_ends_again_and_again_is_started_ever_later() -> None:
    scene = Scene()
    kept = scene.keep("renderer")
    kept.tick()
    waits = [crash_and_wait(scene, kept) for _ in range(8)]
    assert waits == [1, 2, 4, 8, 16, 32, LONGEST_WAIT_S, LONGEST_WAIT_S]
    assert scene.said[1] == "The renderer ended (status 1); starting it again in 2 s."


def test_a_first_process_that_never_comes_up_is_told_and_not_started_again() -> None:
    scene = Scene()
    site, renderer = scene.keep("site"), scene.keep("renderer")

    def is_up() -> bool:
        if len(scene.started) == 2:
            scene.started[0].status = 1
        return False

    with pytest.raises(CommandError, match=r"^the site ended before it answered \(status 1\)"):
        start_all([site, renderer], is_up, poll_s=0)
    assert len(scene.started) == 2
    scene.started[0].status = None
    start_all([site, renderer], lambda: True, poll_s=0)


def test_a_process_that_ran_for_a_while_is_started_at_once() -> None:
    scene = Scene()
    kept = scene.keep("site")
    kept.tick()
    for _ in range(4):
        crash_and_wait(scene, kept)
    scene.now += STEADY_S
    assert crash_and_wait(scene, kept) == 1


def test_a_crash_of_one_leaves_the_other_standing() -> None:
    scene = Scene()
    site, renderer = scene.keep("site"), scene.keep("renderer")
    site.tick()
    renderer.tick()
    scene.started[1].status = -signal.SIGSEGV
    site.tick()
    renderer.tick()
    assert site.process is scene.started[0]
    assert renderer.process is None
    assert scene.said == ["The renderer ended (SIGSEGV); starting it again in 1 s."]


def test_stopping_kills_what_does_not_end_when_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("study.commands.processes.STOP_S", 0.0)
    scene = Scene()
    kept = [scene.keep("site"), scene.keep("renderer"), scene.keep("absent")]
    for entry in kept[:2]:
        entry.tick()
    scene.started[1].ignores_terminate = True
    stop_all(kept)
    assert [process.told for process in scene.started] == [["terminate"], ["terminate", "kill"]]


@pytest.mark.parametrize(
    ("status", "words"), [(0, "status 0"), (3, "status 3"), (-9, "SIGKILL"), (-999, "signal 999")]
)
def test_an_end_is_named(status: int, words: str) -> None:
    assert ending(status) == words


def test_a_started_command_ends_when_its_keeper_is_killed(tmp_path: Path) -> None:
    # The keeper starts a child that only waits, says so and is killed; the child has to go.
    waiting = tmp_path / "waiting"
    waiting.write_text("#!/bin/sh\nexec sleep 300\n")
    waiting.chmod(0o755)
    keeper = (
        "import os, signal, sys\n"
        "from study.commands import starting\n"
        "starting.sys.executable = sys.argv[1]\n"
        "starting.start_command([])\n"
        "print('started', flush=True)\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", keeper, str(waiting)],
        capture_output=True,
        text=True,
        check=False,
        timeout=30,
    )
    # run() came back because nobody holds the child's output open any more: the child is gone.
    assert (done.returncode, done.stdout) == (-signal.SIGKILL, "started\n")
