"""Draw all charts into the bytes of their files, in this process or shared with forks of it.

A fork has the libraries and the tables at no cost: a fresh process would take as long to start as
it would save. What the tables alone tell can be drawn while models are still fitted, and the rest
while tables and sentences are written.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from types import TracebackType
from typing import Final, Self

from analysis.charts.catalogue import CHARTS, Chart
from analysis.charts.fonts import used
from analysis.charts.forks import CAN_FORK, Fork, Queue
from analysis.charts.long_names import shorten
from analysis.charts.material import Material
from analysis.charts.names import fonts_of, short_names
from analysis.charts.style import figure_bytes

EARLY: Final = tuple(chart for chart in CHARTS if chart.is_early)
LATE: Final = tuple(chart for chart in CHARTS if not chart.is_early)


class Drawing:
    """Charts being drawn: some by forks of this process, what these have not taken by itself.

    Without a second process, or where the system cannot fork, ``finish`` draws everything.
    """

    def __init__(self, *, processes: int = 1) -> None:
        self._has_forks = processes > 1 and CAN_FORK
        self._shares: list[tuple[Material, Sequence[Chart], Queue[Chart]]] = []
        self._forks: list[Fork] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for fork in self._forks:
            fork.end()

    def start(self, material: Material, charts: Sequence[Chart]) -> None:
        """Have these charts drawn from the material, by a fork if there is one."""
        queue = Queue(charts)
        self._shares.append((material, charts, queue))
        if self._has_forks:
            self._forks.append(Fork(lambda: _draw(material, queue)))

    def finish(self) -> dict[str, bytes]:
        """Draw with the forks until nothing is left; return SVG and PNG by file name."""
        files: dict[str, bytes] = {}
        for material, _, queue in reversed(self._shares):
            files |= _draw(material, queue)
        for fork in self._forks:
            files |= fork.result()
        # A fork that was killed, as where memory ran out, or met a fault leaves its charts to us.
        for material, charts, _ in self._shares:
            files |= _draw(material, [own for own in charts if f"{own.name}.png" not in files])
        return files


def draw_charts(material: Material, *, processes: int = 1) -> dict[str, bytes]:
    """Return every chart as SVG and PNG by file name."""
    with Drawing(processes=processes) as drawing:
        drawing.start(material, CHARTS)
        return drawing.finish()


def _draw(material: Material, charts: Iterable[Chart]) -> dict[str, bytes]:
    """Draw charts one after another; one figure serves both kinds of file."""
    files: dict[str, bytes] = {}
    short = short_names(material.tables)
    with used(fonts_of(material.tables)):
        for chart in charts:
            figure = chart.draw(material)
            shorten(figure, short)
            files |= {f"{chart.name}.{kind}": figure_bytes(figure, kind) for kind in ("svg", "png")}
    return files
