"""Beside the worker's rendering: starts a process that draws the dashboard's figures when due.

Rendering goes on meanwhile. A drawing that is killed or takes far too long is told on the
dashboard and tried again later; of several workers on one database one draws at a time.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, Protocol

from study.data import figures
from study.data.database import Database
from study.data.figures import Claim
from study.worker_names import is_dead, worker_name

POLL_S: Final = 5.0
LONGEST_S: Final = 1800.0
STOP_S: Final = 5.0


class Process(Protocol):
    """What is kept: the part of subprocess.Popen that is used here."""

    def poll(self) -> int | None:
        """Return the exit status, or None while it runs."""
        ...

    def terminate(self) -> None:
        """Ask it to end."""
        ...

    def kill(self) -> None:
        """End it."""
        ...

    def wait(self, timeout: float | None = None) -> int:
        """Wait for the end; raises subprocess.TimeoutExpired."""
        ...


@dataclass
class FigureKeeper:
    """Claims what is due and has it drawn. ``start`` starts the drawing of a claim, by its name.

    ``ending`` words an exit status; ``clock`` is in seconds.
    """

    db: Database
    start: Callable[[str], Process]
    ending: Callable[[int], str] = str
    say: Callable[[str], None] = lambda _line: None
    clock: Callable[[], float] = time.monotonic
    worker: str = field(default_factory=worker_name)
    _process: Process | None = None
    _claim: Claim | None = None
    _since: float = 0.0

    def tick(self) -> None:
        """Start a drawing if one is due; note the end of one."""
        if self._process is not None and self._claim is not None:
            self._look(self._process, self._claim)
            return
        figures.free_dead(self.db, is_dead)
        self._claim = figures.claim(self.db, worker=self.worker)
        if self._claim is not None:
            self._process, self._since = self.start(self.worker), self.clock()

    def stop(self) -> None:
        """End a drawing and give its claim back."""
        if self._process is not None and self._claim is not None:
            self._process.terminate()
            try:
                self._process.wait(STOP_S)
            except Exception:
                self._process.kill()
                self._process.wait()
            figures.release(self.db, self._claim, worker=self.worker)
        self._process = self._claim = None

    def _look(self, process: Process, claim: Claim) -> None:
        status = process.poll()
        if status is None:
            if self.clock() - self._since < LONGEST_S:
                return
            process.kill()
            process.wait()
            reason = f"drawing took longer than {LONGEST_S / 60:.0f} minutes and was ended"
        else:
            reason = f"the process that draws ended ({self.ending(status)})" if status else ""
        if reason:
            figures.fail(self.db, claim, worker=self.worker, error=reason)
            self.say(f"Figures of the dashboard: {reason}; they will be tried again.")
        else:  # what it stored is stored; what it could not keep is free again
            figures.release(self.db, claim, worker=self.worker)
        self._process = self._claim = None


def keep_figures(keeper: FigureKeeper, stop: threading.Event, *, poll_s: float = POLL_S) -> None:
    """Look now and then until told to stop; for a thread beside the worker's."""
    try:
        while not stop.wait(poll_s):
            try:
                keeper.tick()
            except Exception as error:  # a database that is away for a while ends no figures
                keeper.say(f"Figures of the dashboard: {error}; looking again.")
    finally:
        keeper.stop()
