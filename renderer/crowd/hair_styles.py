"""How the crowd's people wear their hair: a table. Pure data, millimetres."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True)
class Style:
    """How hair is cut: thickness on top and at the sides, height of its locks or curls, in mm.

    ``tips_mm`` is how unevenly it ends, ``fringe_mm`` how far it falls over the brow's hairline,
    ``bare_mm`` how far the hairline has drawn back at the temples, ``whirl`` how far locks turn
    around the crown on their way, in radians. ``hangs`` where it is long.
    """

    top_mm: float
    side_mm: float
    relief_mm: float
    tips_mm: float = 5.0
    fringe_mm: float = 0.0
    bare_mm: float = 0.0
    whirl: float = 0.25
    is_curled: bool = False
    hangs: bool = False


STYLES: Final = {
    "crop": Style(15.0, 8.0, 3.2, tips_mm=6.0, fringe_mm=4.0),
    "brush": Style(19.0, 9.0, 3.6, tips_mm=7.0, fringe_mm=9.0, whirl=-0.35),
    "curls": Style(12.0, 9.0, 2.4, tips_mm=3.0, is_curled=True, whirl=0.0),
    "thin": Style(7.0, 9.0, 2.0, tips_mm=5.0, bare_mm=17.0, whirl=0.15),
    "pixie": Style(17.0, 14.0, 3.8, tips_mm=9.0, fringe_mm=17.0, whirl=0.55),
    "set": Style(19.0, 19.0, 4.0, tips_mm=4.0, is_curled=True, whirl=0.0),
    "fringe": Style(11.0, 11.0, 2.4, tips_mm=6.0, fringe_mm=26.0, whirl=0.0, hangs=True),
    "shoulder": Style(15.0, 14.0, 3.2, tips_mm=9.0, fringe_mm=13.0, whirl=0.22, hangs=True),
}
