"""The dashboard's figures: drawn when due, by one drawer, and never lost or shown when they go."""

from __future__ import annotations

import json
import signal
import threading
from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from analysis import Tables
from study.commands.processes import ending
from study.commands.starting import start_drawing
from study.data import erasure, export, figures, figures_shown, logbook, participants, researchers
from study.data.database import Database
from study.data.figures import Claim
from study.data.researchers import Researcher
from study.data.studies import Study
from study.figure_keeper import LONGEST_S, FigureKeeper, keep_figures
from study.figures import draw as draw_figures
from study.settings import Settings, read_settings
from study.simulate import simulate

SUMMARY = {"people": 2, "charts": []}


@pytest.fixture
def ada(db: Database, study: Study) -> Researcher:
    """A researcher who has the results of the study switched on."""
    found = researchers.add(db, "ada", "correct horse battery")
    logbook.show_results(db, found, study, shown=True)
    return found


def answer(db: Database, study: Study, seed: int = 1) -> None:
    simulate(db, study.definition, participants=1, seed=seed)


def claim(db: Database, worker: str = "w") -> Claim:
    own = figures.claim(db, worker=worker)
    assert own is not None
    return own


def draw(db: Database, worker: str = "w", **files: bytes) -> None:
    own = claim(db, worker)
    assert figures.store(db, own, worker=worker, summary=SUMMARY, files=files)


def test_nothing_is_drawn_before_somebody_asks_to_see_results(db: Database, study: Study) -> None:
    answer(db, study)
    assert figures.due(db) == []
    ada = researchers.add(db, "ada", "correct horse battery")
    logbook.show_results(db, ada, study, shown=True)
    assert figures.due(db) == [(study.id, "simulated")]  # and no person has answered
    logbook.show_results(db, ada, study, shown=False)
    assert figures.due(db) == []


@pytest.mark.usefixtures("ada")
def test_figures_are_drawn_once_a_minute_and_only_of_new_answers(
    db: Database, study: Study, clock: Any
) -> None:
    answer(db, study)
    draw(db)
    found = figures_shown.latest(db, study.id, "simulated")
    assert (found.summary, found.as_of, found.is_stale) == (SUMMARY, clock.now, False)
    answer(db, study, seed=2)
    assert figures_shown.latest(db, study.id, "simulated").is_stale
    clock.move(seconds=59)
    assert figures.due(db) == []
    clock.move(seconds=1)
    assert figures.due(db) == [(study.id, "simulated")]
    draw(db)
    clock.move(hours=1)
    assert figures.due(db) == []


@pytest.mark.usefixtures("ada")
def test_a_drawing_that_takes_long_rests_four_times_as_long(
    db: Database, study: Study, clock: Any
) -> None:
    answer(db, study)
    own = claim(db)
    clock.move(seconds=80)
    assert figures.store(db, own, worker="w", summary=SUMMARY, files={})
    answer(db, study, seed=2)
    clock.move(seconds=239)
    assert figures.due(db) == []
    clock.move(seconds=1)
    assert figures.due(db)


@pytest.mark.usefixtures("ada")
def test_of_several_workers_one_draws(db: Database, study: Study) -> None:
    answer(db, study)
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda n: figures.claim(db, worker=f"w{n}"), range(4)))
    assert sum(own is not None for own in found) == 1
    assert figures_shown.latest(db, study.id, "simulated").is_being_made
    assert figures_shown.latest(db, study.id, "people").is_being_made is False


@pytest.mark.usefixtures("ada")
def test_a_claim_whose_holder_is_silent_passes_on_and_the_late_one_stores_nothing(
    db: Database, study: Study, clock: Any
) -> None:
    answer(db, study)
    late = claim(db, "late")
    clock.move(seconds=89)
    assert figures.renew(db, late, worker="late")
    clock.move(seconds=89)
    assert figures.claim(db, worker="next") is None
    clock.move(seconds=2)
    draw(db, "next", **{"a.svg": b"next"})
    assert not figures.renew(db, late, worker="late")
    assert not figures.store(db, late, worker="late", summary={}, files={"a.svg": b"late"})
    assert figures_shown.content(db, late.id, "a.svg") == b"next"


@pytest.mark.usefixtures("ada")
def test_a_dead_workers_claim_is_free_at_once(db: Database, study: Study) -> None:
    answer(db, study)
    claim(db, "dead")
    assert figures.free_dead(db, lambda name: name == "living") == 0
    assert figures.free_dead(db, lambda name: name == "dead") == 1
    assert figures.claim(db, worker="living") is not None


@pytest.mark.usefixtures("ada")
def test_a_failure_is_told_beside_the_older_figures_and_tried_again_later(
    db: Database, study: Study, clock: Any
) -> None:
    answer(db, study)
    draw(db, **{"a.svg": b"old"})
    answer(db, study, seed=2)
    clock.move(minutes=1)
    figures.fail(db, claim(db), worker="w", error="no room on the disk")
    found = figures_shown.latest(db, study.id, "simulated")
    assert (found.error, found.failed_at, found.summary) == (
        "no room on the disk",
        clock.now,
        SUMMARY,
    )
    assert found.id is not None
    assert figures_shown.content(db, found.id, "a.svg") == b"old"
    clock.move(seconds=299)
    assert figures.due(db) == []
    clock.move(seconds=1)
    draw(db)
    assert figures_shown.latest(db, study.id, "simulated").error is None


@pytest.mark.usefixtures("ada")
def test_files_of_the_set_before_are_gone(db: Database, study: Study, clock: Any) -> None:
    answer(db, study)
    draw(db, **{"a.svg": b"<svg>", "b.csv": b"1"})
    answer(db, study, seed=2)
    clock.move(minutes=1)
    draw(db, **{"a.svg": b"<svg> new"})
    found = figures_shown.latest(db, study.id, "simulated")
    assert found.id is not None
    assert figures_shown.content(db, found.id, "a.svg") == b"<svg> new"
    assert figures_shown.content(db, found.id, "b.csv") is None


@pytest.mark.usefixtures("ada")
def test_whoever_withdraws_is_in_no_figure_any_more(db: Database, study: Study, clock: Any) -> None:
    answer(db, study)
    answer(db, study, seed=2)
    draw(db, **{"a.svg": b"everybody"})
    names = export.tables(db, study).participants["participant"]
    first, second = (participants.by_public_id(db, study, str(name)) for name in names)
    assert first is not None
    assert second is not None
    erasure.withdraw(db, first)
    found = figures_shown.latest(db, study.id, "simulated")
    assert (found.id, found.summary, found.is_stale) == (None, None, True)
    being_drawn = claim(db)
    erasure.withdraw(db, second)
    assert not figures.store(db, being_drawn, worker="w", summary=SUMMARY, files={})
    clock.move(hours=1)
    assert figures_shown.latest(db, study.id, "simulated").is_stale is False  # nobody is left


class Drawing:
    """A drawing that ends when it is told to."""

    def __init__(self) -> None:
        self.status: int | None = None

    def poll(self) -> int | None:
        return self.status

    def terminate(self) -> None:
        self.status = -signal.SIGTERM

    def kill(self) -> None:
        self.status = -signal.SIGKILL

    def wait(self, timeout: float | None = None) -> int:
        del timeout
        return self.status or 0


@pytest.mark.usefixtures("ada")
def test_the_keeper_starts_one_drawing_and_tells_how_it_ended(db: Database, study: Study) -> None:
    answer(db, study)
    started: list[Drawing] = []
    said: list[str] = []

    def start(_name: str) -> Drawing:
        started.append(Drawing())
        return started[-1]

    keeper = FigureKeeper(db, start, ending=ending, say=said.append)
    keeper.tick()
    keeper.tick()
    assert len(started) == 1
    assert figures_shown.latest(db, study.id, "simulated").is_being_made
    started[0].status = -signal.SIGKILL
    keeper.tick()
    found = figures_shown.latest(db, study.id, "simulated")
    assert found.error == "the process that draws ended (SIGKILL)"
    assert not found.is_being_made
    assert said == [
        "Figures of the dashboard: the process that draws ended (SIGKILL); they will be tried "
        "again."
    ]


@pytest.mark.usefixtures("ada")
def test_the_keeper_ends_a_drawing_that_takes_for_ever_and_gives_back_when_stopped(
    db: Database, study: Study, clock: Any
) -> None:
    answer(db, study)
    drawing, passed = Drawing(), [0.0]
    keeper = FigureKeeper(db, lambda _name: drawing, clock=lambda: passed[0])
    keeper.tick()
    passed[0] = LONGEST_S
    keeper.tick()
    error = figures_shown.latest(db, study.id, "simulated").error
    assert error == "drawing took longer than 30 minutes and was ended"
    clock.move(minutes=5)
    again = FigureKeeper(db, lambda _name: Drawing())
    again.tick()
    stop = threading.Event()
    stop.set()
    keep_figures(again, stop, poll_s=0.0)
    found = figures_shown.latest(db, study.id, "simulated")
    assert not found.is_being_made
    assert figures.due(db)


@pytest.mark.usefixtures("ada")
def test_a_killed_drawing_is_told(
    db: Database, study: Study, database_url: str, tmp_path: Path
) -> None:
    answer(db, study)
    settings = Settings(database_url=database_url, data_folder=tmp_path)
    processes = []

    def start(name: str) -> Any:
        processes.append(start_drawing(settings, name))
        return processes[-1]

    keeper = FigureKeeper(db, start, ending=ending)
    keeper.tick()
    processes[0].kill()
    processes[0].wait()
    keeper.tick()
    error = figures_shown.latest(db, study.id, "simulated").error
    assert error == "the process that draws ended (SIGKILL)"


@pytest.mark.usefixtures("ada")
def test_two_who_see_results_have_one_set_drawn(db: Database, study: Study) -> None:
    grace = researchers.add(db, "grace", "another long password")
    logbook.show_results(db, grace, study, shown=True)
    answer(db, study)
    assert figures.due(db) == [(study.id, "simulated")]
    logbook.show_results(db, grace, study, shown=False)
    assert figures.due(db) == [(study.id, "simulated")]  # ada still looks


def test_a_lease_outlives_the_pauses_between_its_renewals() -> None:
    from study.figures import BEAT_S

    assert timedelta(seconds=2 * BEAT_S) < figures.LEASE


def test_a_database_that_is_away_for_a_moment_ends_no_figures() -> None:
    said: list[str] = []
    stop = threading.Event()

    class Away:
        say = staticmethod(said.append)
        looks = 0

        def tick(self) -> None:
            self.looks += 1
            if self.looks == 2:
                stop.set()
            raise OSError("the server is gone")

        def stop(self) -> None:
            said.append("stopped")

    away: Any = Away()
    keep_figures(away, stop, poll_s=0.0)
    gone = "Figures of the dashboard: the server is gone; looking again."
    assert said == [gone, gone, "stopped"]


def test_costs_of_the_data_folder_are_shown_and_a_faulty_file_is_told(
    db: Database, study: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given: list[Path | None] = []

    def found(_tables: Tables, _folder: str, *, bench: Path | None) -> SimpleNamespace:
        given.append(bench)
        names = dict.fromkeys(
            ("verdicts", "findings", "limits", "design", "quality", "chart_notes", "files"), ()
        )
        return SimpleNamespace(people=0, ratings=0, **names)

    monkeypatch.setattr("study.figures.analyse", found)
    answer(db, study)
    settings = read_settings({}, data_folder=tmp_path)
    assert settings.bench_file == tmp_path / "bench.json"
    elsewhere = {"OCULARIST_BENCH": "costs/bench.json"}
    assert read_settings(elsewhere, data_folder=tmp_path).bench_file == Path("costs/bench.json")
    told: list[list[str]] = []
    row = {"renderer": "r", "size": "1280x720", "distance": "near", "iris_px": 160.0, "eyes": 2}
    good = json.dumps([row | {"lod": "low", "ms_median": 2.0, "ms_mad": 0.1, "n": 20}])
    for text in (None, good, '[{"lod": "low"'):
        if text is not None:
            settings.bench_file.write_text(text)
        summary, _ = draw_figures(db, study, "simulated", bench=settings.bench_file)
        told.append(summary["limits"])
    assert given == [None, settings.bench_file, None]
    assert told[:2] == [[], []]
    (fault,) = told[2]
    assert fault.startswith(
        "What the LoDs cost is left out, for bench.json cannot be used: bench.json: not JSON"
    )
