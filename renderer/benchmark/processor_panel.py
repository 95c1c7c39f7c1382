"""The panel of what frames ask of the processor, beside what a GPU does meanwhile."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from renderer.benchmark.panels import QUIET, SMALL, TWO, label
from renderer.benchmark.result import Bench, Cost
from renderer.benchmark.verdicts import GPU_AIMS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HEIGHT: Final = 0.36  # of a bar


def asking_rows(bench: Bench) -> list[Cost]:
    """Return the rows to draw: two eyes of each LoD at macroscopic, the largest group, the aims."""
    told = [row for row in bench.rows if row.processor_ms is not None]
    lods = [row for row in told if (row.part, row.distance, row.eyes) == ("lods", "macroscopic", 2)]
    groups = [row for row in told if row.part == "crowd" and row.distance == "group"]
    return [*lods, *groups[-1:], *(row for row in told if row.part == "aims")]


def draw_processor(axes: Axes, rows: list[Cost]) -> None:
    """The processor's ms, on a GPU above the GPU's; lines at the longest that the aims leave."""
    for place, row in enumerate(reversed(rows)):
        asked_ms = row.processor_ms or 0.0
        is_gpu = row.row_ms is not None
        up = HEIGHT / 2 if is_gpu else 0.0
        axes.barh(place + up, asked_ms, HEIGHT, color=TWO[1])
        label(axes, asked_ms, place + up, f"{asked_ms:.1f}, {row.draw_calls} draws", TWO[1])
        if is_gpu:
            axes.barh(place - up, row.ms_median, HEIGHT, color=TWO[0])
            label(axes, row.ms_median, place - up, f"{row.ms_median:.1f} on the GPU", TWO[0])
    rates = sorted({aim.frames_per_s for aim in GPU_AIMS.values()})
    for per_s in rates:
        axes.axvline(1000.0 / per_s, color=QUIET, lw=0.8, ls="--")
    axes.set_yticks(range(len(rows)), [_name(row) for row in reversed(rows)])
    axes.set_ylim(-0.6, len(rows) - 0.4)
    axes.set_xlabel(
        "ms of the submitting thread per frame; dashed: "
        + " and ".join(f"{per_s:.0f}/s" for per_s in rates),
        fontsize=SMALL,
    )
    axes.margins(x=0.3)
    axes.set_xlim(left=0.0)


def _name(row: Cost) -> str:
    who = f"{row.crowd} people" if row.distance == "group" else f"two {row.lod} eyes"
    if row.part == "aims":
        return f"{who}, as on a GPU" if row.row_ms is None else f"{who}, aim"
    return who
