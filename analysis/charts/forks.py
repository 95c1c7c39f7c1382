"""Work shared between this process and copies of it; knows nothing of charts."""

from __future__ import annotations

import multiprocessing
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from multiprocessing.connection import Connection
from typing import Final, Generic, TypeVar

CAN_FORK: Final = sys.platform == "linux"
_Thing = TypeVar("_Thing")


class Queue(Generic[_Thing]):
    """Things that this process and its later forks take one after another until none is left."""

    def __init__(self, things: Sequence[_Thing]) -> None:
        self._things = tuple(things)
        self._taken = multiprocessing.Value("i", 0)

    def __iter__(self) -> Iterator[_Thing]:
        while True:
            with self._taken.get_lock():
                place = self._taken.value
                self._taken.value += 1
            if place >= len(self._things):
                return
            yield self._things[place]


class Fork:
    """A copy of this process that makes files and sends them back, by their names."""

    def __init__(self, make: Callable[[], dict[str, bytes]]) -> None:
        context = multiprocessing.get_context("fork")
        self._reader, writer = context.Pipe(duplex=False)
        self._process = context.Process(target=_send, args=(make, writer), daemon=True)
        with warnings.catch_warnings():
            # Python warns of forking beside threads: the copy draws, and takes no lock of theirs.
            warnings.simplefilter("ignore", DeprecationWarning)
            self._process.start()
        writer.close()

    def result(self) -> dict[str, bytes]:
        """Wait for what was made; nothing where the copy died or met a fault."""
        try:
            made: dict[str, bytes] = self._reader.recv()
        except EOFError:
            made = {}
        self._process.join()
        return made

    def end(self) -> None:
        """End the copy if it still works."""
        self._reader.close()
        self._process.terminate()
        self._process.join()


def _send(make: Callable[[], dict[str, bytes]], writer: Connection) -> None:
    try:
        made = make()
    except Exception:  # whoever reads does it again, and meets the fault where it can be told
        made = {}
    writer.send(made)
