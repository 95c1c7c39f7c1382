"""How far a study's clips are, told in the terminal from what the database says."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Final

from study.commands.progress import ClipBar
from study.data import jobs

if TYPE_CHECKING:
    from study.commands.preparing import Prepared
    from study.data.jobs import Summary

LOOK_S: Final = 1.0


class Rendering:
    """Shows a bar while clips are missing; says when people can start and when all are there."""

    def __init__(self, prepared: Prepared) -> None:
        self._db = prepared.db
        wanted = prepared.study.definition.wanted_specs()
        self._clips = {entry.spec.clip_id for entry in wanted}
        first = (wanted[0].size, wanted[0].orbit_direction)
        self._first = {
            entry.spec.clip_id for entry in wanted if (entry.size, entry.orbit_direction) == first
        }
        self._bar: ClipBar | None = None
        self._said: set[str] = set()
        self._next_look = 0.0

    def show(self) -> None:
        """Look into the database, at most once a second, and tell what is new."""
        if time.monotonic() < self._next_look:
            return
        self._next_look = time.monotonic() + LOOK_S
        found = jobs.summary(self._db, self._clips)
        if found.done + found.failed < found.total:
            self._show_bar(found)
            if _is_whole(jobs.summary(self._db, self._first)):
                self._say_once("People can take part now; the other clips follow.")
            return
        self.close()
        if found.failed:
            self._say_once(
                f"{found.failed} of {found.total} clips could not be rendered; the dashboard shows "
                "why. Starting again tries again."
            )
        else:
            all_clips = "The clip is" if found.total == 1 else f"All {found.total} clips are"
            self._say_once(f"{all_clips} ready; people can take part.")

    def say(self, line: str) -> None:
        """Print a line without breaking the bar."""
        if self._bar is not None:
            self._bar.clear()
        print(line, file=sys.stderr, flush=True)

    def close(self) -> None:
        """Take the bar away."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None

    def _show_bar(self, found: Summary) -> None:
        if self._bar is None:
            self._bar = ClipBar(found.total)
        self._bar.show(found.progress * found.total, left_s=found.left_s)

    def _say_once(self, line: str) -> None:
        if line not in self._said:
            self._said.add(line)
            self.say(line)


def _is_whole(found: Summary) -> bool:
    return found.done == found.total
