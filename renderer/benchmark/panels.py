"""The panels of the benchmark's figure, one for each part that is drawn.

Direct labels instead of legends; colours of Okabe and Ito, which people with colour-blindness tell
apart, with a marker each.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from renderer.benchmark.result import Cost
from renderer.detail import EFFECTS, STANDARD_LODS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS: Final = {"low": "#D55E00", "medium": "#B07800", "high": "#2F9ED8", "ultra": "#0072B2"}
MARKERS: Final = {"low": "o", "medium": "s", "high": "D", "ultra": "^"}
TWO: Final = ("#0072B2", "#D55E00")
QUIET: Final = "#6b6b6b"
SMALL: Final = 8


def draw_lods(axes: Axes, rows: list[Cost]) -> None:
    """Frame time against the iris's size: filled with two eyes, open with one."""
    for lod in STANDARD_LODS:
        for eyes in (2, 1):
            own = sorted(
                (row for row in rows if row.lod == lod and row.eyes == eyes),
                key=lambda row: row.iris_px,
            )
            if not own:
                continue
            x, y = [row.iris_px for row in own], [row.ms_median for row in own]
            style: dict[str, Any] = {"color": COLOURS[lod], "marker": MARKERS[lod], "ms": 4.5}
            if eyes == 1:
                style |= {"ls": ":", "mfc": "white"}
            axes.plot(x, y, lw=1.3, **style)
            if eyes == 2:
                label(axes, x[-1], y[-1], lod, COLOURS[lod])
    axes.set_xscale("log")
    axes.set_yscale("log")
    sizes = sorted({row.iris_px for row in rows})
    axes.set_xticks(sizes, [f"{size:.0f}" for size in sizes])
    axes.minorticks_off()
    _plain_log(axes, [row.ms_median for row in rows])
    axes.set_xlabel("iris, pixels (filled: two eyes; open, dotted: one)", fontsize=SMALL)
    axes.set_ylabel("ms per frame", fontsize=SMALL)
    axes.margins(x=0.18)


def draw_effects(axes: Axes, rows: list[Cost]) -> None:
    """Each effect's levels, from ultra where that was measured."""
    base = "ultra" if any(row.base == "ultra" for row in rows) else rows[0].base
    levels = [level for level in STANDARD_LODS if any(row.level == level for row in rows)]
    for place, effect in enumerate(reversed(EFFECTS)):
        for step, level in enumerate(levels):
            for row in rows:
                if (row.base, row.effect, row.level) != (base, effect, level):
                    continue
                y = place + 0.2 * ((len(levels) - 1) / 2 - step)
                axes.errorbar(
                    row.ms_median, y, xerr=row.ms_mad, color=COLOURS[level], marker=MARKERS[level],
                    ms=4.5, lw=1.0,
                )  # fmt: skip
                label(axes, row.ms_median + row.ms_mad, y, level, COLOURS[level])
    axes.axvline(0.0, color=QUIET, lw=0.8)
    axes.set_yticks(range(len(EFFECTS)), list(reversed(EFFECTS)))
    axes.set_ylim(-0.6, len(EFFECTS) - 0.4)
    axes.set_xlabel(f"ms with minus without, others at {base}, one eye", fontsize=SMALL)
    axes.margins(x=0.16)


def draw_samples(axes: Axes, rows: list[Cost]) -> None:
    """Error against time: down and left is better."""
    for is_ours, colour, marker in ((False, TWO[1], "o"), (True, TWO[0], "^")):
        own = [row for row in rows if (row.samples == 0) is is_ours]
        x, y = [row.ms_median for row in own], [row.rms_percent or 0.0 for row in own]
        axes.plot(x, y, color=colour, marker=marker, ms=5, lw=0.0 if is_ours else 1.0)
        for row, ms, rms in zip(own, x, y, strict=True):
            name = f"ours, {row.level}" if is_ours else f"{row.samples} samples"
            below = is_ours and row.level == "ultra"  # both of ours may lie at the same height
            label(axes, ms, rms, name, colour, up=-8 if below else 7)
    axes.set_yscale("log")
    axes.minorticks_off()
    _plain_log(axes, [row.rms_percent or 0.0 for row in rows])
    axes.set_xlabel("ms of subsurface, one eye", fontsize=SMALL)
    axes.set_ylabel("rms error, %", fontsize=SMALL)
    axes.margins(x=0.3, y=0.12)
    axes.set_xlim(left=min(0.0, axes.get_xlim()[0]))


def draw_cubes(axes: Axes, rows: list[Cost]) -> None:
    """Static and dynamic cube maps by size."""
    for kind, colour, marker in (("static", TWO[0], "o"), ("dynamic", TWO[1], "s")):
        own = [row for row in rows if row.cube == kind]
        x, y = [row.cube_px or 0 for row in own], [row.ms_median for row in own]
        error = [row.ms_mad for row in own]
        axes.errorbar(x, y, yerr=error, color=colour, marker=marker, ms=4.5, lw=1.3)
        if own:
            label(axes, x[-1], y[-1], kind, colour)
    axes.set_xscale("log", base=2)
    sizes = sorted({row.cube_px or 0 for row in rows if row.effect})
    axes.set_xticks(sizes, [str(size) for size in sizes])
    axes.minorticks_off()
    axes.set_xlabel("pixels of a face", fontsize=SMALL)
    axes.set_ylabel("ms of reflection, one eye", fontsize=SMALL)
    axes.margins(x=0.18)


def draw_crowd(axes: Axes, rows: list[Cost]) -> None:
    """A frame's time by the number of people: around the main character, and as a group."""
    for distance, colour, marker in zip(
        dict.fromkeys(row.distance for row in rows), TWO, ("o", "s"), strict=False
    ):
        own = [row for row in rows if row.distance == distance]
        x, y = [row.crowd or 0 for row in own], [row.ms_median for row in own]
        error = [row.ms_mad for row in own]
        axes.errorbar(x, y, yerr=error, color=colour, marker=marker, ms=4.5, lw=1.3)
        told = (
            "group, all eyes by size"
            if distance == "group"
            else f"{distance}, two {own[-1].lod} eyes"
        )
        label(axes, x[-1], y[-1], told, colour)
    axes.set_xticks(sorted({row.crowd or 0 for row in rows}))
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("people: others in the scene, or in the group", fontsize=SMALL)
    axes.set_ylabel("ms per frame", fontsize=SMALL)
    axes.margins(x=0.1)
    axes.set_xlim(right=1.75 * max(row.crowd or 0 for row in rows) or None)  # room for labels


def label(axes: Axes, x: float, y: float, text: str, colour: str, *, up: float = 0.0) -> None:
    """Write beside a point, ``up`` points of type above its middle."""
    axes.annotate(
        text, (x, y), xytext=(6, up), textcoords="offset points", va="center", fontsize=SMALL,
        color=colour,
    )  # fmt: skip


def _plain_log(axes: Axes, values: list[float]) -> None:
    """Mark a logarithmic axis at 1, 2 and 5 times powers of ten, as plain numbers."""
    low, high = min(values) * 0.85, max(values) * 1.15
    marks = [m * 10.0**p for p in range(-3, 6) for m in (1, 2, 5) if low <= m * 10.0**p <= high]
    axes.set_yticks(marks, [f"{mark:g}" for mark in marks])
