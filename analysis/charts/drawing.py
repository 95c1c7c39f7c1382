"""Draw all charts into the bytes of their files, in this process or shared with a second one."""

from __future__ import annotations

import multiprocessing
import sys
import warnings
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Final

from analysis.charts.catalogue import CHARTS, Chart
from analysis.charts.material import Material
from analysis.charts.style import figure_bytes

_SHARED: Final[dict[str, Material]] = {}


def draw_charts(material: Material, *, processes: int = 1) -> dict[str, bytes]:
    """Return every chart as SVG and PNG by file name; one figure serves both.

    With two ``processes`` a fork of this one draws every other chart, where the system can fork.
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


def _draw_shared(material: Material) -> dict[str, bytes]:
    """Draw one half while a fork draws the other; alone if the fork dies.

    A fork has the libraries and the material at no cost: a fresh process would take as long to
    start as it would save.
    """
    _SHARED["material"] = material
    try:
        with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("fork")) as pool:
            with warnings.catch_warnings():
                # Python warns of forking beside threads: the child draws, and takes no lock.
                warnings.simplefilter("ignore", DeprecationWarning)
                other = pool.submit(_draw_odd)
            own = _draw(material, CHARTS[::2])
            try:
                return own | other.result()
            except BrokenProcessPool:  # killed, as where memory ran out
                return own | _draw(material, CHARTS[1::2])
    finally:
        _SHARED.clear()


def _draw_odd() -> dict[str, bytes]:
    return _draw(_SHARED["material"], CHARTS[1::2])
