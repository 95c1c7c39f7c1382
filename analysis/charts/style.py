"""How every chart looks: colours, sizes, panels, the label of simulated data.

Figures are built without pyplot and its global state, so they can be drawn in any thread. Colours
are those of Okabe and Ito and of ColorBrewer's PuOr, which people with colour-blindness tell apart;
LoDs differ in marker too.
"""

from __future__ import annotations

import io
import textwrap
from collections.abc import Sequence
from typing import Any, Final, Literal
from zlib import crc32

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

INK: Final = "#222222"
QUIET: Final = "#6b6b6b"
FAINT: Final = "#dddddd"
ALARM: Final = "#b3261e"
SIMULATED: Final = "SIMULATED DATA"
_GAP_IN: Final = 0.08  # between a title and that mark
NO_RATINGS: Final = "No rating has been given yet."

LOD_COLOURS: Final = {"low": "#D55E00", "medium": "#E69F00", "high": "#56B4E9", "ultra": "#0072B2"}
_LOD_MARKERS: Final = {"low": "o", "medium": "s", "high": "D", "ultra": "^"}
_OTHER_COLOURS: Final = ("#009E73", "#CC79A7", "#7F7F7F", "#8C6D31", "#5254A3", "#AD494A")
_OTHER_MARKERS: Final = ("v", "P", "X", "<", ">", "h")

CHOICE_COLOURS: Final = ("#7570B3", "#E2E2E2", "#1B9E77")
NOTICE_COLOURS: Final = ("#1F3A5F", "#9DB4CE", "#E8E8E8")
# By the names of analysis.decision.verdicts; markers differ too.
VERDICT_COLOURS: Final = {"equivalent": "#0072B2", "different": "#D55E00", "not shown": "#7a7a7a"}
VERDICT_MARKERS: Final = {"equivalent": "o", "different": "D", "not shown": "s"}
_SCALE_COLOURS: Final = ("#B35806", "#F1A340", "#EDEDED", "#A79FCC", "#542788")

# What an A4 page holds between its margins; a wider figure would be printed smaller.
PAGE_WIDTH_IN: Final = 7.0

SMALL: Final = 8.0
NORMAL: Final = 9.0
LARGE: Final = 11.0
PNG_DPI: Final = 160
_MESSAGE_CHARS: Final = 84  # a line across a figure that only says something


def lod_colour(lod: str, lods: Sequence[str]) -> str:
    """Return a LoD's colour; LoDs that a study names take theirs in the order of ``lods``."""
    return LOD_COLOURS.get(lod) or _OTHER_COLOURS[_place(lod, lods) % len(_OTHER_COLOURS)]


def lod_marker(lod: str, lods: Sequence[str]) -> str:
    """Return a LoD's marker."""
    return _LOD_MARKERS.get(lod) or _OTHER_MARKERS[_place(lod, lods) % len(_OTHER_MARKERS)]


def _place(lod: str, lods: Sequence[str]) -> int:
    own = [name for name in lods if name not in LOD_COLOURS]
    # One that was compared and never rated is in no order: its place is its name's.
    return own.index(lod) if lod in own else len(own) + crc32(lod.encode())


def scale_colours(steps: int) -> list[str]:
    """Return one colour per rating, from lowest to highest, neutral in the middle."""
    if steps == len(_SCALE_COLOURS):
        return list(_SCALE_COLOURS)
    shades = mpl.colormaps["PuOr"](np.linspace(0.08, 0.92, steps))
    return [mpl.colors.to_hex(shade) for shade in shades]


def shade(share: float) -> str:
    """Return a blue for a share from 0 (nearly white) to 1, as #rrggbb."""
    return str(mpl.colors.to_hex(mpl.colormaps["Blues"](0.03 + 0.72 * share)))


def new_figure(width_in: float, height_in: float, title: str, *, is_simulated: bool) -> Figure:
    """Return an empty figure with its title, labelled across if the data are simulated."""
    figure = Figure(
        figsize=(width_in, height_in), dpi=PNG_DPI, layout="constrained", facecolor="white"
    )  # laid out as the PNG is drawn: texts are measured once for both
    FigureCanvasAgg(figure)
    heading = figure.suptitle(
        title, x=0.01, ha="left", fontsize=LARGE, fontweight="bold", color=INK
    )
    if is_simulated:
        mark = figure.text(
            0.995,
            0.995,
            SIMULATED,
            ha="right",
            va="top",
            fontsize=NORMAL,
            fontweight="bold",
            color=ALARM,
        )
        if heading.get_window_extent().x1 > mark.get_window_extent().x0 - _GAP_IN * figure.dpi:
            heading.set_text(_in_two_lines(title))
        size = 11.0 * min(width_in, 2.2 * height_in) / 2.6
        figure.text(
            0.5,
            0.48,
            "SIMULATED",
            ha="center",
            va="center",
            fontsize=size,
            rotation=18,
            color=ALARM,
            alpha=0.07,
            fontweight="bold",
            zorder=0,
        )
    return figure


def _in_two_lines(title: str) -> str:
    """Break a title at the space nearest its middle."""
    spaces = [i for i, letter in enumerate(title) if letter == " "]
    if not spaces:
        return title
    place = min(spaces, key=lambda i: abs(i - len(title) / 2))
    return f"{title[:place]}\n{title[place + 1 :]}"


def message_figure(title: str, message: str, *, is_simulated: bool = False) -> Figure:
    """Return a figure that says why there is nothing to draw."""
    lines = textwrap.wrap(message, _MESSAGE_CHARS)
    height = 0.85 + 0.17 * len(lines)
    figure = new_figure(6.5, height, title, is_simulated=is_simulated)
    figure.text(0.5, 0.3 / height, "\n".join(lines), ha="center", va="bottom", fontsize=NORMAL,
                color=QUIET)  # fmt: skip
    return figure


def tidy(axes: Axes, *, grid: Literal["x", "y", ""] = "y") -> None:
    """Give a panel its quiet frame, ticks and grid."""
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color("#999999")
    axes.tick_params(labelsize=SMALL, color="#999999", labelcolor=INK, length=3)
    axes.set_axisbelow(True)
    axes.patch.set_visible(False)  # lets the label of simulated data show through
    if grid:
        axes.grid(axis=grid, color="#ececec", linewidth=0.8)


def rating_axis(
    axes: Axes, scale: tuple[int, int], *, is_labelled: bool = True, is_short: bool = False
) -> None:
    """Let the vertical axis show the whole rating scale."""
    low, high = scale
    axes.set_ylim(low - 0.3, high + 0.45)
    axes.set_yticks(range(low, high + 1))
    if is_labelled:
        name = "realism" if is_short else "perceived realism"
        axes.set_ylabel(f"{name}, {low} to {high}", fontsize=SMALL, color=INK)


def beeswarm(values: Sequence[float] | np.ndarray, *, step: float) -> np.ndarray:
    """Return sideways offsets that lay equal values next to each other, around zero."""
    x = np.asarray(values, dtype=float)
    offsets = np.zeros(x.size)
    for value in np.unique(x):
        same = np.flatnonzero(x == value)
        offsets[same] = (np.arange(same.size) - (same.size - 1) / 2) * step
    return offsets


def figure_bytes(figure: Figure, kind: str) -> bytes:
    """Return a figure as ``png`` or ``svg``; equal figures give equal bytes.

    Names are anybody's, so a dollar sign in one begins no formula.
    """
    # The salt of SVG ids is a setting of the whole process; nothing else here depends on it.
    # Labels of ticks are made while a figure is drawn, so that they ask for a setting, too.
    settings: Any = {"text.parse_math": False, "svg.hashsalt": "ocularist", "svg.fonttype": "path"}
    more: dict[str, Any] = {"metadata": {"Date": None}}
    if kind == "png":
        more = {"pil_kwargs": {"compress_level": 1}}  # a third of the time of 6, a fifth more bytes
    buffer = io.BytesIO()
    with mpl.rc_context(settings):
        _lay_out(figure)
        figure.savefig(buffer, format=kind, dpi=PNG_DPI, **more)
    return buffer.getvalue()


def _lay_out(figure: Figure) -> None:
    """Lay a figure out once for all kinds of file, without drawing for it."""
    engine = figure.get_layout_engine()
    if engine is None:  # it was laid out before
        return
    for text in figure.findobj(Text):
        text.set_parse_math(False)
    if figure.axes:
        engine.execute(figure)
    figure.set_layout_engine(None)  # "none" would leave an engine that costs two more draws
