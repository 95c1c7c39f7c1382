"""``ocularist load``: a table of what a site of its own stood."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from study.cli import main
from study.load.crowd import Timings
from study.load.report import figures_of, table

SQLITE = ("--people", "2", "--seconds", "1", "--database", "sqlite", "--no-fsync-cost")


def test_a_small_crowd_is_measured_and_nothing_it_was_told_is_lost(tmp_path: Path) -> None:
    out = tmp_path / "load.json"
    done = subprocess.run(
        [sys.executable, "-m", "study", "load", *SQLITE, "--out", str(out)],
        capture_output=True,
        text=True,
        check=False,
        cwd=Path(__file__).parents[1],
        timeout=200,
    )
    assert done.returncode == 0, done.stderr
    assert "cores, load" in done.stdout
    [figures] = json.loads(out.read_text())
    assert (figures["database"], figures["people"], figures["fsync"]) == ("sqlite", 2, True)
    assert (figures["errors"], figures["lost"]) == (0, 0)
    assert figures["requests_per_s"] > 0
    assert figures["p50_ms"] <= figures["p95_ms"] <= figures["p99_ms"]


def test_a_pause_before_the_beginning_of_time_is_refused(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["load", "--pause", "-1"]) == 1
    assert "--pause -1: a pause lasts 0 s or longer" in capsys.readouterr().err


def test_only_what_ends_while_we_measure_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr("study.load.crowd.time.perf_counter", lambda: now[0])
    timings = Timings(began=10.0, ended=12.0, site_s=0.003, crowd_s=0.0005)
    for moment, seconds, status in ((9, 1, 200), (10, 0.1, 200), (11, 0.3, 303), (11, 9, 500)):
        now[0] = moment
        timings.note("answer", seconds, status)
    now[0] = 12.0
    timings.note("answer", 5, 200)
    assert timings.seconds == {"answer": [0.1, 0.3]}
    assert timings.errors == {"answer: 500": 1}
    facts = {"database": "x", "processes": 1, "fsync": True, "people": 1, "pause_s": 0.0}
    found = figures_of(timings, lost=2, seconds=2, **facts)
    assert (found.answers_per_s, found.requests_per_s, found.errors) == (1.0, 1.0, 1)
    assert found.p50_ms == pytest.approx(200)
    last = [cell.strip() for cell in table([found]).splitlines()[-1].strip("|").split("|")]
    assert last == ["x", "1", "on", "1", "0", "1", "1", "200", "290", "298", "1", "2"] + [
        *("1.50", "0.25"),
    ]
