"""Names too long for a chart: shortened in its texts, whole in the tables beside it.

Names are anybody's: those of a ratings file may be sentences. Charts find room for ``LONGEST``, and
for more in the names of clips, which they break into lines.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Mapping
from functools import partial
from typing import Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

LONGEST: Final = 24  # the longest name of a LoD in our own studies has 21 letters
LONGEST_CLIP: Final = 48  # and of a clip 39
_END: Final = 8  # what tells names apart often stands at their end
_MARK: Final = "…"


def shortened(names: Iterable[str], *, longest: int = LONGEST) -> dict[str, str]:
    """Return what stands in charts for each name that is too long; two never share a short one."""
    whole = sorted(set(names))
    used, short = {name for name in whole if len(name) <= longest}, {}
    for name in whole:
        if len(name) <= longest:
            continue
        plain = " ".join(name.split())
        found, number = _cut(plain, plain[-_END:], longest), 1
        while found in used:
            number += 1
            found = _cut(plain, f" {number}", longest)
        used.add(found)
        short[name] = found
    return short


def _cut(name: str, end: str, longest: int) -> str:
    """Return a name's beginning and ``end``, ``longest`` letters in all."""
    return f"{name[: longest - len(end) - 1].rstrip()}{_MARK}{end.lstrip()}"


def shorten(figure: Figure, short: Mapping[str, str]) -> None:
    """Put short names in the place of long ones, in all of a figure's texts and ticks."""
    if not short:
        return
    # Charts break names into lines, anywhere; a long name may hold a shorter one.
    by_length = sorted(short, key=len, reverse=True)
    patterns = [(re.compile(_spaced(name)), short[name]) for name in by_length]
    for axes in figure.findobj(Axes):
        for axis in (axes.xaxis, axes.yaxis):
            labels = [label.get_text() for label in axis.get_ticklabels()]
            told = [_replaced(label, patterns) for label in labels]
            if told != labels:
                axis.set_ticks(axis.get_ticklocs(), labels=told)
    for text in figure.findobj(Text):
        text.set_text(_replaced(text.get_text(), patterns))


def _spaced(name: str) -> str:
    return r"\s*".join(re.escape(letter) for letter in name if not letter.isspace())


def _replaced(text: str, patterns: Iterable[tuple[re.Pattern[str], str]]) -> str:
    for pattern, short in patterns:
        text = pattern.sub(partial(_as_wide, short), text)
    return text


def _as_wide(short: str, found: re.Match[str]) -> str:
    """Break a short name into lines as wide as those of the long one."""
    lines = found[0].splitlines()
    return short if len(lines) < 2 else textwrap.fill(short, max(map(len, lines)))
