"""``ocularist load``: a table of what a site of its own stood."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from study.cli import main
from study.load.crowd import Timings
from study.load.find import largest
from study.load.report import Figures, figures_of, kinds_table, table

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
    rates = {kind["kind"]: kind["requests_per_s"] for kind in figures["kinds"]}
    assert sum(rates.values()) == pytest.approx(figures["requests_per_s"])
    assert min(rates["answer"], rates["clip page"]) > 0


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
    facts = {
        "database": "x",
        "processes": 1,
        "fsync": True,
        "people": 1,
        "there": 1,
        "pause_s": 0.0,
    }
    found = figures_of(timings, lost=2, seconds=2, **facts)
    assert (found.answers_per_s, found.requests_per_s, found.errors) == (1.0, 1.0, 1)
    assert found.p50_ms == pytest.approx(200)
    last = [cell.strip() for cell in table([found]).splitlines()[-1].strip("|").split("|")]
    assert last == ["x", "1", "on", "1", "0", "1", "1", "200", "290", "298", "1", "2"] + [
        *("1.50", "0.25"),
    ]
    rows = [[c.strip() for c in line.split("|")] for line in kinds_table([found]).splitlines()]
    assert [row[6:11] for row in rows if row[6] in ("all", "answer")] == [
        ["all", "1", "200", "290", "298"],
        ["answer", "1", "200", "290", "298"],
    ]


def figures(people: int, *, p95_ms: float, there: int | None = None, errors: int = 0) -> Figures:
    return Figures(
        database="x",
        processes=1,
        fsync=True,
        people=people,
        there=people if there is None else there,
        pause_s=0.0,
        seconds=1.0,
        answers_per_s=0.0,
        requests_per_s=0.0,
        questionnaires_per_s=0.0,
        p50_ms=0.0,
        p95_ms=p95_ms,
        p99_ms=0.0,
        errors=errors,
        lost=0,
        site_ms=0.0,
        crowd_ms=0.0,
    )


@pytest.mark.parametrize(("limit", "most"), [(70, 200), (1, 200), (200, 200), (37, 37), (0, 50)])
def test_the_largest_crowd_in_time_is_found_in_few_runs(limit: int, most: int) -> None:
    tried: list[int] = []

    def measure(people: int) -> Figures:
        tried.append(people)
        return figures(people, p95_ms=50 if people <= limit else 500)

    found = largest(measure, below_ms=100, most=most)
    assert limit / 1.2 - 1 <= found <= limit
    assert len(tried) <= 9
    assert len(set(tried)) == len(tried)


@pytest.mark.parametrize("spoilt", [{"there": 0}, {"errors": 1}])
def test_a_crowd_that_did_not_come_or_met_an_error_was_not_carried(spoilt: dict[str, int]) -> None:
    def measure(people: int) -> Figures:
        return figures(people, p95_ms=1, there=spoilt.get("there"), errors=spoilt.get("errors", 0))

    assert largest(measure, below_ms=100, most=8) == 0


def test_a_time_for_find_is_longer_than_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["load", "--find", "--below", "0"]) == 1
    assert "--below 0: a time is longer than 0 ms" in capsys.readouterr().err
