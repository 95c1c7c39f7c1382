"""Processor time of running programs, from /proc: what a request costs, not how long it takes.

How long a request takes depends on everything else on the machine; this hardly does.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Final

TICKS_PER_S: Final = os.sysconf("SC_CLK_TCK")
PROC: Final = Path("/proc")


def processor_s(*roots: int) -> float:
    """Return the processor seconds that programs and all that they started have used so far.

    Children that have ended count with whoever waited for them; 0 where there is no /proc.
    """
    found = dict(_programs())
    wanted = set(roots) & found.keys()
    while more := {pid for pid, (parent, _) in found.items() if parent in wanted} - wanted:
        wanted |= more
    return sum(found[pid][1] for pid in wanted) / TICKS_PER_S


def _programs() -> Iterable[tuple[int, tuple[int, int]]]:
    """Yield every program's number, its parent's, and its ticks."""
    if not PROC.is_dir():
        return
    for entry in PROC.iterdir():
        if not entry.name.isdecimal():
            continue
        try:
            text = (entry / "stat").read_text()
        except (FileNotFoundError, ProcessLookupError):  # it has just ended
            continue
        # The name, in brackets, may hold anything; proc(5) numbers the rest from 3.
        rest = text.rpartition(")")[2].split()
        yield int(entry.name), (int(rest[1]), sum(map(int, rest[11:15])))
