"""Processes of this machine: a death breaks one future, stopping leaves nothing behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import BrokenExecutor, CancelledError
from pathlib import Path
from types import SimpleNamespace

import pytest

from study.cli import main
from study.commands import render
from study.commands.pool import Pool

ROOT = Path(__file__).parent.parent
LIMIT_S = 120.0  # for a busy machine; a process starts within a second


def is_alive(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"


def test_a_killed_process_breaks_its_own_call_alone(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with Pool(2, threads=1) as pool:
        long = pool.submit(Path.read_text, pipe)  # until somebody writes
        killed = pool.submit(signal.raise_signal, signal.SIGKILL)
        with pytest.raises(BrokenExecutor):
            killed.result(LIMIT_S)
        assert pool.submit(os.getpid).result(LIMIT_S) != os.getpid()  # a fresh process
        pipe.write_text("whole")
        assert long.result(LIMIT_S) == "whole"


def test_a_process_that_is_killed_between_calls_is_replaced() -> None:
    with Pool(1, threads=1) as pool:
        first = pool.submit(os.getpid).result(LIMIT_S)
        assert pool.submit(os.getpid).result(LIMIT_S) == first
        os.kill(first, signal.SIGKILL)
        while is_alive(first):
            time.sleep(0.01)
        for _ in range(2):  # its pool may notice in the first call or before it
            try:
                assert pool.submit(os.getpid).result(LIMIT_S) != first
                return
            except BrokenExecutor:
                continue
    raise AssertionError("the pool stays broken")


def test_every_process_has_its_share_of_threads_and_a_folder_that_goes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("LP_NUM_THREADS", raising=False)
    with Pool(1, threads=3) as pool:
        assert pool.submit(os.getenv, "LP_NUM_THREADS").result(LIMIT_S) == "3"
        folder = Path(pool.submit(tempfile.mkdtemp).result(LIMIT_S))
        assert folder.is_dir()
    assert not folder.parent.exists()
    assert folder.parent != Path(tempfile.gettempdir())


def test_who_sets_the_threads_is_left_to_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LP_NUM_THREADS", "7")
    with Pool(1, threads=3) as pool:
        assert pool.submit(os.getenv, "LP_NUM_THREADS").result(LIMIT_S) == "7"


def test_an_error_ends_the_processes_at_once() -> None:
    pool = Pool(2, threads=1)
    pid = pool.submit(os.getpid).result(LIMIT_S)
    calls = [pool.submit(time.sleep, 1000.0) for _ in range(4)]
    with pytest.raises(KeyboardInterrupt), pool:
        raise KeyboardInterrupt
    assert not is_alive(pid)
    assert all(call.done() for call in calls)
    for call in calls:
        with pytest.raises(CancelledError):
            call.result()


KEEPER = """
import multiprocessing, time
from concurrent.futures import wait
from study.commands.pool import Pool

if __name__ == "__main__":
    with Pool(2, threads=1) as pool:
        for call in [pool.submit(time.sleep, 0.0) for _ in range(2)]:
            call.result()
        print(*(child.pid for child in multiprocessing.active_children()), flush=True)
        calls = [pool.submit(time.sleep, 1000.0) for _ in range(2)]
        while wait(calls, timeout=1.0).not_done:  # as the batch does: a wait can miss a signal
            pass
"""


MASKED = """
import signal
from study.commands.pool import Pool

if __name__ == "__main__":
    with Pool(2, threads=1) as pool:
        for call in [pool.submit(signal.pthread_sigmask, signal.SIG_BLOCK, []) for _ in range(4)]:
            assert signal.SIGINT in call.result()
"""


def test_even_the_first_process_leaves_ctrl_c_to_its_keeper(tmp_path: Path) -> None:
    script = tmp_path / "masked.py"  # a fresh process: here others have started Python's tracker
    script.write_text(MASKED)
    subprocess.run(
        [sys.executable, str(script)], env=os.environ | {"PYTHONPATH": str(ROOT)}, check=True
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_no_process_outlives_its_keeper(tmp_path: Path, number: signal.Signals) -> None:
    script = tmp_path / "keeper.py"
    script.write_text(KEEPER)
    keeper = subprocess.Popen(
        [sys.executable, str(script)],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert keeper.stdout is not None
    try:
        pids = [int(word) for word in keeper.stdout.readline().split()]
        assert len(pids) == 2
        if number == signal.SIGINT:  # Ctrl-C reaches everybody in the terminal
            os.killpg(keeper.pid, number)
        else:
            os.kill(keeper.pid, number)
        # communicate() comes back when nobody holds the keeper's output open any more.
        said = keeper.communicate(timeout=LIMIT_S)[1]
    finally:
        if keeper.poll() is None:
            os.killpg(keeper.pid, signal.SIGKILL)
            keeper.communicate()
    assert [pid for pid in pids if is_alive(pid)] == []
    if number == signal.SIGINT:
        assert said.count("Traceback") == 1  # the keeper's own: no process has one
        assert said.rstrip().endswith("KeyboardInterrupt")


@pytest.mark.parametrize(("workers", "threads"), [(2, 4), (3, 2), (8, 1), (20, 1)])
def test_software_rendering_shares_the_cores(
    workers: int, threads: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _pid: set(range(8)))
    assert render.fair_share(workers) == threads


def test_clips_of_different_gl_renderers_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    drawn = [
        SimpleNamespace(file_bytes=500_000, gl_renderer=name, gl_version="4.6", missed=[])
        for name in ("llvmpipe", "NVIDIA H100", "llvmpipe")
    ]
    monkeypatch.setattr(render, "_render_here", lambda *_: drawn)
    assert main(["render", "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        f"3 clips, 1.5 MB, in {tmp_path}",
        "Drawn by different GL renderers, which may differ in the last bit: "
        "NVIDIA H100, 4.6; llvmpipe, 4.6",
    ]
