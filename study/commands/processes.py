"""Keep processes running beside each other: a crash of one leaves the others standing.

Knows nothing of what the processes do. A process that ends is started again after a wait that
doubles with every end that follows soon; one that has run for a while starts afresh.
"""

from __future__ import annotations

import signal
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final, Protocol

from study.commands.errors import CommandError

FIRST_WAIT_S: Final = 1.0
LONGEST_WAIT_S: Final = 60.0
STEADY_S: Final = 60.0  # a process that ran this long had a good start
STOP_S: Final = 10.0  # time to end in order before it is killed


class Process(Protocol):
    """What is kept: the part of subprocess.Popen that is used here."""

    def poll(self) -> int | None:
        """Return the exit status, or None while it runs."""
        ...

    def wait(self, timeout: float | None = None) -> int:
        """Wait for the end; raises subprocess.TimeoutExpired."""
        ...

    def terminate(self) -> None:
        """Ask it to end."""
        ...

    def kill(self) -> None:
        """End it."""
        ...


@dataclass
class Kept:
    """One process, started again whenever it ends. ``tick`` has to be called now and then."""

    name: str
    start: Callable[[], Process]
    say: Callable[[str], None]
    clock: Callable[[], float] = time.monotonic
    process: Process | None = None
    _wait_s: float = FIRST_WAIT_S
    _started: float = 0.0
    _due: float = field(default=0.0)

    def tick(self) -> None:
        """Start the process if it is due; note its end and when to start it again."""
        now = self.clock()
        if self.process is None:
            if now >= self._due:
                self.process, self._started = self.start(), now
            return
        status = self.process.poll()
        if status is None:
            return
        if now - self._started >= STEADY_S:
            self._wait_s = FIRST_WAIT_S
        self.say(
            f"The {self.name} ended ({ending(status)}); starting it again in {self._wait_s:g} s."
        )
        self.process, self._due = None, now + self._wait_s
        self._wait_s = min(self._wait_s * 2, LONGEST_WAIT_S)


def start_all(kept: Sequence[Kept], is_up: Callable[[], bool], *, poll_s: float = 0.1) -> None:
    """Start every process and wait until the first of them is up.

    Raises CommandError if that one ends before: started again, it would end in the same way.
    """
    first = kept[0]
    while not is_up():
        if first.process is not None and (status := first.process.poll()) is not None:
            raise CommandError(
                f"the {first.name} ended before it answered ({ending(status)}); what it said "
                "stands above"
            )
        for entry in kept:
            entry.tick()
        time.sleep(poll_s)


def ending(status: int) -> str:
    """Name an exit status, or the signal that ended a process."""
    if status >= 0:
        return f"status {status}"
    try:
        return signal.Signals(-status).name
    except ValueError:
        return f"signal {-status}"


def stop_all(kept: Sequence[Kept]) -> None:
    """Ask every process to end, wait a little for all of them, then kill what is left."""
    running = [entry.process for entry in kept if entry.process is not None]
    for process in running:
        process.terminate()
    deadline = time.monotonic() + STOP_S
    for process in running:
        try:
            process.wait(max(0.0, deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
