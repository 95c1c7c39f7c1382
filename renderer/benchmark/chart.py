"""The benchmark as one figure, PNG and SVG. Matplotlib is loaded only to draw it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Final

from renderer.benchmark.panels import (
    QUIET,
    SMALL,
    draw_crowd,
    draw_cubes,
    draw_effects,
    draw_lods,
    draw_samples,
)
from renderer.benchmark.processor_panel import asking_rows, draw_processor
from renderer.benchmark.result import Bench, Cost

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK: Final = "#222222"

Draw = Callable[["Axes", list[Cost]], None]
_PANELS: Final[tuple[tuple[str, str, Draw], ...]] = (
    ("lods", "Frames by LoD", draw_lods),
    ("effects", "Each effect at each level", draw_effects),
    ("samples", "Subsurface: error against time", draw_samples),
    ("cubes", "Cube maps by size", draw_cubes),
    ("crowd", "Crowd", draw_crowd),
)


def write_chart(bench: Bench, stem: Path) -> list[Path]:
    """Write ``stem.png`` and ``stem.svg`` with a panel for every part that has one; maybe none."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    panels = [(title, draw, rows) for part, title, draw in _PANELS if (rows := bench.of_part(part))]
    if asking := asking_rows(bench):
        panels.append(("The processor's part of a frame", draw_processor, asking))
    if not panels:
        return []
    across = min(len(panels), 2)
    down = -(-len(panels) // across)
    figure = Figure(figsize=(5.8 * across, 4.3 * down + 0.4), layout="constrained")
    figure.suptitle(
        f"{bench.about.renderer}, {bench.about.size}, {bench.about.clock}",
        fontsize=SMALL,
        color=QUIET,
        x=0.01,
        ha="left",
    )
    for place, (title, draw, rows) in enumerate(panels):
        axes = figure.add_subplot(down, across, place + 1)
        axes.set_title(title, loc="left", fontsize=10, color=INK)
        draw(axes, rows)
        _tidy(axes)
    paths = [stem.with_suffix(suffix) for suffix in (".png", ".svg")]
    stem.parent.mkdir(parents=True, exist_ok=True)
    with rc_context({"svg.hashsalt": "ocularist", "svg.fonttype": "path"}):
        for path in paths:
            date = {"Date": None} if path.suffix == ".svg" else {}
            figure.savefig(path, dpi=160, metadata=date)
    return paths


def _tidy(axes: Axes) -> None:
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.tick_params(labelsize=SMALL, labelcolor=INK, color="#999999", length=3)
    axes.grid(color="#ececec", lw=0.8)
    axes.set_axisbelow(True)
