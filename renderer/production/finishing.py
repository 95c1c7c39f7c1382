"""A process that finishes clips while others are drawn.

Measuring FLIP keeps Python to itself for seconds, which a thread beside the drawing would take from
it. Processes are spawned: a forked one would share its parent's GL context.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing.connection import wait
from types import TracebackType
from typing import Self

from renderer.manifest import ClipRecord
from renderer.production.making import DrawnClip, finish_clip


class Finishing:
    """Finishes clips elsewhere; its process starts with the first and ends with the block."""

    def __init__(self) -> None:
        self._stack = ExitStack()
        self._pool: ProcessPoolExecutor | None = None

    def start(self, drawn: DrawnClip) -> Callable[[], ClipRecord]:
        """Begin with a clip; return what waits for its record."""
        if self._pool is None:
            spawning = multiprocessing.get_context("spawn")
            self._pool = self._stack.enter_context(
                ProcessPoolExecutor(1, mp_context=spawning, initializer=_begin)
            )
        future = self._pool.submit(finish_clip, drawn)

        def finished() -> ClipRecord:
            try:
                return future.result()
            except BrokenExecutor:
                return finish_clip(drawn)  # the process was killed: nothing is lost but time

        return finished

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._stack.close()


def _begin() -> None:
    """Leave Ctrl-C to the parent, which waits for the clip at hand; end when the parent does."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
