"""Work that goes on beside the drawing: in order, in one thread, never far behind."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import Final, Self

WAITING: Final = 3  # tasks that may wait: a frame of 1080 lines is 6 MB


class Beside:
    """Do tasks in a thread of its own; what goes wrong in one is raised by a later call.

    Leaving the block waits for all of them; leaving it by an error, for the one at work.
    """

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="beside")
        self._out: deque[Future[None]] = deque()

    def do(self, task: Callable[[], None]) -> None:
        """Have a task done after those before it; waits while WAITING of them are not done."""
        while len(self._out) >= WAITING:
            self._out.popleft().result()
        self._out.append(self._thread.submit(task))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            while self._out and error is None:
                self._out.popleft().result()
        finally:
            self._thread.shutdown(cancel_futures=True)
