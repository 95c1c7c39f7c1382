"""A process that finishes clips while others are drawn.

Measuring FLIP keeps Python to itself for seconds, which a thread beside the drawing would take from
it. Processes are spawned: a forked one would share its parent's GL context.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from concurrent.futures import Future, ProcessPoolExecutor
from multiprocessing.connection import wait

from renderer.manifest import ClipRecord
from renderer.production.drawing import DrawnClip
from renderer.production.making import finish_clip


class Finishing:
    """Finishes clips elsewhere; its process starts with the first clip."""

    def __init__(self) -> None:
        self._pool: ProcessPoolExecutor | None = None

    def start(self, drawn: DrawnClip) -> Future[ClipRecord]:
        """Begin with a clip; return its record to come."""
        if self._pool is None:
            spawning = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(1, mp_context=spawning, initializer=_begin)
        return self._pool.submit(finish_clip, drawn)

    def close(self) -> None:
        """End the process, after the clip at hand."""
        if self._pool is not None:
            self._pool.shutdown()


def _begin() -> None:
    """Leave Ctrl-C to the parent, which waits for the clip at hand; end when the parent does."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
