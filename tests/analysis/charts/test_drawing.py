"""Charts drawn by forks of this process: the same files, and nothing lost with a fork."""

import os
import signal
from collections.abc import Iterator

import pytest

from analysis.charts import CHARTS
from analysis.charts.catalogue import Chart
from analysis.charts.drawing import EARLY, LATE, Drawing, draw_charts
from analysis.charts.forks import Fork, Queue
from analysis.charts.material import Material
from analysis.inference.inferring import Inference
from analysis.tables.reading import Tables

SOME = ("realism-matrix", "rating-spread", "realism-by-distance")


@pytest.fixture
def some() -> list[str]:
    return [f"{name}.{kind}" for name in SOME for kind in ("png", "svg")]


def test_forks_draw_what_one_process_draws(thesis_tables: Tables, some: list[str]) -> None:
    material, own = Material(thesis_tables), [chart for chart in CHARTS if chart.name in SOME]
    with Drawing(processes=2) as drawing:
        drawing.start(material, own[:1])
        drawing.start(material, own[1:])
        together = drawing.finish()
    with Drawing() as drawing:
        drawing.start(material, own)
        alone = drawing.finish()
    assert sorted(together) == sorted(some)
    assert together == alone


def test_every_chart_is_drawn_once(thesis_tables: Tables, monkeypatch: pytest.MonkeyPatch) -> None:
    assert [*EARLY, *LATE] != []
    assert {chart.name for chart in (*EARLY, *LATE)} == {chart.name for chart in CHARTS}
    assert len(EARLY) + len(LATE) == len(CHARTS)
    monkeypatch.setattr("analysis.charts.drawing.CHARTS", EARLY[:1])
    assert list(draw_charts(Material(thesis_tables))) == [
        f"{EARLY[0].name}.svg",
        f"{EARLY[0].name}.png",
    ]


def test_early_charts_need_no_model(thesis_tables: Tables, monkeypatch: pytest.MonkeyPatch) -> None:
    def infer(*_: object, **__: object) -> Inference:
        raise AssertionError("a model was fitted for an early chart")

    monkeypatch.setattr("analysis.charts.material.infer", infer)
    material = Material(thesis_tables)
    assert len(EARLY) > 8
    for chart in EARLY:
        assert chart.draw(material).axes, chart.name


def test_what_a_dead_fork_took_is_drawn_again(
    thesis_tables: Tables, monkeypatch: pytest.MonkeyPatch, some: list[str]
) -> None:
    here = os.getpid()

    def take(_: Queue[Chart]) -> Iterator[Chart]:
        if os.getpid() != here:
            os._exit(1)  # the fork dies with all it has taken
        return iter(())

    monkeypatch.setattr(Queue, "__iter__", take)
    with Drawing(processes=2) as drawing:
        drawing.start(Material(thesis_tables), [own for own in CHARTS if own.name in SOME])
        assert sorted(drawing.finish()) == sorted(some)


def test_a_fork_with_a_fault_sends_nothing() -> None:
    def make() -> dict[str, bytes]:
        raise ValueError("no picture")

    assert Fork(make).result() == {}


def test_a_fork_that_is_not_needed_ends_at_once() -> None:
    def make() -> dict[str, bytes]:
        signal.pause()
        return {}

    fork = Fork(make)
    fork.end()
    assert fork._process.exitcode == -signal.SIGTERM


def test_things_of_a_queue_are_taken_once() -> None:
    queue = Queue("abc")
    assert next(iter(queue)) == "a"
    assert list(queue) == ["b", "c"]
    assert list(queue) == []
