"""The renderer at scale: the same bytes whoever draws them, workers that share, one killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from threading import Timer

import pytest
from distributed import LocalCluster

from renderer.manifest import MANIFEST_NAME, read_manifest
from study.cli import main
from study.commands.preparing import prepare
from study.data import jobs
from study.settings import Settings

ROOT = Path(__file__).parent.parent
LIMIT_S = 300.0  # for a busy machine; building a scene takes seconds


@pytest.fixture
def small_study(write_short_study: Callable[..., Path]) -> Path:
    """A study of three clips of two small frames."""
    clips = [(right, "near", "low", right) for right in ("low", "medium", "high")]
    return write_short_study(*clips, size="96x64", duration_s=0.2)


def hashes(folder: Path) -> dict[str, tuple[str, str]]:
    records = read_manifest(folder).clips
    return {name: (record.raw_sha256, record.file_sha256) for name, record in records.items()}


def test_the_bytes_are_the_same_whoever_renders_them(
    small_study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    low = ["render", str(small_study), "--only", "low", "--out"]
    render = [*low[:-1], "--only", "high", "--out"]
    assert main([*render, str(tmp_path / "one")]) == 0
    assert main([*render, str(tmp_path / "two"), "--workers", "2"]) == 0
    with LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address="127.0.0.1:0", memory_limit=0
    ) as cluster:
        address = cluster.scheduler_address
        assert main([*low, str(tmp_path / "cluster"), "--scheduler", address]) == 0
    alone = hashes(tmp_path / "one")
    assert len(set(alone.values())) == 2
    assert hashes(tmp_path / "two") == alone
    far = hashes(tmp_path / "cluster")
    assert len(far) == 1
    assert far.items() < alone.items()
    out = capsys.readouterr().out.splitlines()
    assert [line.split(",")[0] for line in out] == ["2 clips", "2 clips", "1 clip"]
    for folder, brought in (("two", alone), ("cluster", far)):
        names = {path.name for path in (tmp_path / folder).iterdir()}
        assert names == {f"{name}.mp4" for name in brought} | {MANIFEST_NAME, ".manifest.lock"}


def start(*arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "study", *arguments],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def children(pid: int) -> list[int]:
    """Return the processes that a process's threads have started."""
    tasks = Path(f"/proc/{pid}/task")
    return [
        int(child) for task in tasks.iterdir() for child in (task / "children").read_text().split()
    ]


def test_three_workers_share_a_database_and_one_is_killed(
    small_study: Path, tmp_path: Path, database_url: str
) -> None:
    prepared = prepare(Settings(data_folder=tmp_path, database_url=database_url), str(small_study))
    arguments = ["worker", "--data", str(tmp_path), "--database", database_url, "--until-empty"]
    workers = [start(*arguments) for _ in range(3)]
    watchdog = Timer(LIMIT_S, lambda: [worker.kill() for worker in workers])
    watchdog.start()
    victim = None
    while victim is None and workers[0].poll() is None:
        claims = [job.claimed_by for job in jobs.all_jobs(prepared.db) if job.claimed_by]
        pids = {int(claim.split("|")[1]) for claim in claims}
        victim = next((worker for worker in workers if worker.pid in pids), None)
        time.sleep(0.01)
    assert victim is not None
    victim.kill()  # it has just begun: building its scene takes longer than this
    said = [worker.communicate() for worker in workers]
    watchdog.cancel()
    statuses = [worker.returncode for worker in workers]
    assert sorted(statuses) == [-signal.SIGKILL, 0, 0], said
    brought = [int(out.split()[0]) for out, _ in said if out]
    assert sum(brought) == 3
    done = jobs.all_jobs(prepared.db)
    assert [job.state for job in done] == ["done"] * 3
    assert sorted(job.attempts for job in done) == [1, 1, 2]
    manifest = read_manifest(tmp_path / "clips")
    assert sorted(manifest.clips) == sorted(job.clip_id for job in done)
    prepared.db.close()


def test_ctrl_c_ends_every_process_in_one_moment(small_study: Path, tmp_path: Path) -> None:
    render = start("render", str(small_study), "--out", str(tmp_path / "clips"), "--workers", "2")
    watchdog = Timer(LIMIT_S, render.kill)
    watchdog.start()
    while len(started := children(render.pid)) < 3 and render.poll() is None:
        time.sleep(0.01)  # two workers and what Python tracks shared resources with
    os.killpg(render.pid, signal.SIGINT)  # as a terminal does
    # communicate() comes back when nobody holds the output open any more: no orphan.
    out, err = render.communicate()
    watchdog.cancel()
    assert (render.returncode, out) == (130, "")
    assert "Traceback" not in err
    assert len(started) == 3


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--workers", "0"], 'argument --workers: "0" is no count'),
        (
            ["--workers", "2", "--scheduler", "tcp://host:8786"],
            "argument --scheduler: not allowed with argument --workers",
        ),
    ],
)
def test_options_that_make_no_sense_are_told(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main(["render", *arguments])
    assert words in capsys.readouterr().err


def test_without_dask_the_extra_to_install_is_named(tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules['distributed'] = None\n"
        "from study.cli import main; sys.exit(main(['render', '--scheduler', 'tcp://a:1']))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr == (
        "ocularist render: --scheduler needs distributed, which is not installed here; "
        "pip install 'ocularist[cluster]'\n"
    )
