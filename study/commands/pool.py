"""N processes of this machine as one Executor in which a death breaks one future alone.

A ProcessPoolExecutor of N breaks as a whole: when one process is killed, what the others do is lost
and nobody knows whose work it was. Here every process is a pool of its own, looked after by a
thread.
"""

from __future__ import annotations

import os
import signal
import tempfile
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from functools import partial
from multiprocessing import resource_tracker
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import Any, ParamSpec, TypeVar

from study.commands.starting import end_with_parent

P = ParamSpec("P")
T = TypeVar("T")


class Pool(Executor):
    """Runs calls in ``count`` spawned processes: a forked one would share its parent's GL context.

    A future whose process was killed raises BrokenExecutor; the next call gets a fresh process.
    Leaving its block by an error, Ctrl-C among them, ends the processes at once. They share the
    cores: ``threads`` is what each one's software rendering may use.
    """

    def __init__(self, count: int, *, threads: int) -> None:
        # Python starts it with the first process, and then unblocks SIGINT in that thread for good.
        resource_tracker.ensure_running()
        self._started: list[SpawnProcess] = []
        self._threads = ThreadPoolExecutor(
            count,
            thread_name_prefix="pool",
            initializer=_begin_thread,
            initargs=(self._started,),
        )
        self._scratch = tempfile.TemporaryDirectory(prefix="ocularist-")
        self._begin = partial(
            _begin, parent=os.getpid(), threads=threads, scratch=self._scratch.name
        )
        self._context = _Recording()
        self._lock = threading.Lock()
        self._pools: dict[int, ProcessPoolExecutor] = {}  # by the thread that looks after it
        self._is_stopped = False

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Have a process make the call as soon as one is free."""
        return self._threads.submit(self._call, fn, args, kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Take no more calls; with ``wait``, end the processes when all calls are done."""
        self._threads.shutdown(wait=wait, cancel_futures=cancel_futures)
        if wait:
            self.stop()

    def stop(self) -> None:
        """End the processes now, whatever they do."""
        with self._lock:
            self._is_stopped = True
            for process in self._started:
                process.terminate()
        self._threads.shutdown(wait=True, cancel_futures=True)
        for pool in self._pools.values():
            pool.shutdown(wait=True, cancel_futures=True)
        self._scratch.cleanup()

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        """Wait for what is under way, or end it if the block ends by an error."""
        if kind is None:
            self.shutdown()
        else:
            self.stop()

    def _call(self, fn: Callable[..., T], args: tuple[Any, ...], kwargs: Mapping[str, Any]) -> T:
        try:
            return self._start(fn, args, kwargs).result()
        except BrokenExecutor:
            if self._is_stopped:
                raise CancelledError from None
            raise

    def _start(
        self, fn: Callable[..., T], args: tuple[Any, ...], kwargs: Mapping[str, Any]
    ) -> Future[T]:
        """Hand a call to this thread's process; starts one, also when the last one was killed."""
        me = threading.get_ident()
        with self._lock:
            if self._is_stopped:
                raise CancelledError
            if me in self._pools:
                try:
                    return self._pools[me].submit(fn, *args, **kwargs)
                except BrokenExecutor:
                    self._pools[me].shutdown()
            self._pools[me] = ProcessPoolExecutor(
                1, mp_context=self._context, initializer=self._begin
            )
            return self._pools[me].submit(fn, *args, **kwargs)


_mine = threading.local()  # ``started``: where a pool's thread notes the processes it starts


class _Recorded(SpawnProcess):
    """A process that the pool of the thread that starts it can end."""

    def start(self) -> None:
        super().start()
        _mine.started.append(self)


class _Recording(SpawnContext):
    """Spawns processes that are noted, for threads of pools."""

    Process = _Recorded


def _begin_thread(started: list[SpawnProcess]) -> None:
    """Block SIGINT in this thread and all it starts: Ctrl-C reaches the whole terminal's group."""
    _mine.started = started
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})


def _begin(*, parent: int, threads: int, scratch: str) -> None:
    """Set up a process before its first call."""
    end_with_parent()
    if os.getppid() != parent:  # it died before we could ask to end with it
        os._exit(1)
    os.environ.setdefault("LP_NUM_THREADS", str(threads))  # Mesa's llvmpipe
    tempfile.tempdir = scratch  # what a killed process leaves behind goes with the pool
