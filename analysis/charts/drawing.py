"""Draw all charts into the bytes of their files, in this process or shared with a second one."""

from __future__ import annotations

import multiprocessing
import sys
import warnings
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.sharedctypes import Synchronized
from typing import Final

from analysis.charts.catalogue import CHARTS, Chart
from analysis.charts.material import Material
from analysis.charts.style import figure_bytes

_SHARED: Final[dict[str, Material]] = {}
_TAKEN: Final[dict[str, Synchronized[int]]] = {}  # how many charts somebody has taken


def draw_charts(material: Material, *, processes: int = 1) -> dict[str, bytes]:
    """Return every chart as SVG and PNG by file name; one figure serves both.

    With two ``processes`` a fork of this one draws beside it, where the system can fork.
    """
    if processes > 1 and sys.platform == "linux":
        return _draw_shared(material)
    return _draw(material, CHARTS)


def _draw(material: Material, charts: Iterable[Chart]) -> dict[str, bytes]:
    files: dict[str, bytes] = {}
    for chart in charts:
        figure = chart.draw(material)
        files |= {f"{chart.name}.{kind}": figure_bytes(figure, kind) for kind in ("svg", "png")}
    return files


def _untaken(taken: Synchronized[int]) -> Iterator[Chart]:
    """Yield the next chart that nobody has taken, until none is left."""
    while True:
        with taken.get_lock():
            place = taken.value
            taken.value += 1
        if place >= len(CHARTS):
            return
        yield CHARTS[place]


def _draw_shared(material: Material) -> dict[str, bytes]:
    """Draw while a fork draws too, each the next chart that is left; alone if the fork dies.

    A fork has the libraries and the material at no cost: a fresh process would take as long to
    start as it would save.
    """
    context = multiprocessing.get_context("fork")
    taken = context.Value("i", 0)
    _SHARED["material"], _TAKEN["charts"] = material, taken
    try:
        with ProcessPoolExecutor(1, mp_context=context) as pool:
            with warnings.catch_warnings():
                # Python warns of forking beside threads: the child draws, and takes no lock.
                warnings.simplefilter("ignore", DeprecationWarning)
                other = pool.submit(_draw_beside)
            own = _draw(material, _untaken(taken))
            try:
                return own | other.result()
            except BrokenProcessPool:  # killed, as where memory ran out
                left = [chart for chart in CHARTS if f"{chart.name}.png" not in own]
                return own | _draw(material, left)
    finally:
        _SHARED.clear()
        _TAKEN.clear()


def _draw_beside() -> dict[str, bytes]:
    return _draw(_SHARED["material"], _untaken(_TAKEN["charts"]))
