"""A batch on any ``concurrent.futures.Executor``: processes of this machine, or a cluster.

Every clip is an order of its own whose bytes come back, are checked and are kept here, so workers
need no folder of ours. A worker that is killed costs its clip alone: that is ordered again.
"""

from __future__ import annotations

import hashlib
import socket
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from pathlib import Path
from typing import Any, Final

from renderer.atomic_file import write_atomically
from renderer.clip import PATHS, ClipSpec
from renderer.manifest import ClipRecord, read_manifest
from renderer.production.folder import keep_record, remove_parts
from renderer.production.orders import WANTED, VersionMismatchError, fill_order, hash_name
from renderer.sources import code_version

MAX_ATTEMPTS: Final = 3  # a clip whose process dies as often is given up: it is the reason
# Python does not wake from a wait for a signal that came just before it fell asleep: look often.
LOOK_UP_S: Final = 1.0


class BatchError(RuntimeError):
    """Some clips could not be rendered; the message has a line for each."""


class _DamagedError(Exception):
    """A clip did not arrive as it was sent."""


def render_on(
    executor: Executor,
    specs: Sequence[ClipSpec],
    folder: Path,
    *,
    progress: Callable[[int], None] = lambda _done: None,
    say: Callable[[str], None] = lambda _line: None,
    with_flip: bool = True,
) -> list[ClipRecord]:
    """Render the clips that the folder does not hold yet; return every clip's record.

    ``progress`` hears how many clips are there; clips of one name are one. ``say`` hears of clips
    that are tried again. One that fails does not stop the others: BatchError names all that failed
    when the rest is done, and ends the batch at once when a worker has other sources or the
    connection is lost. An executor that breaks as a whole when one process is killed, as
    ProcessPoolExecutor does with several, ends it too.
    """
    remove_parts(folder)
    manifest = read_manifest(folder)
    wanted = {spec.clip_id: spec for spec in specs}
    kept = {name: manifest.current(name, folder) for name in wanted}
    records = {name: record for name, record in kept.items() if record is not None}
    progress(len(records))
    batch = _Batch(executor, folder, records, progress, say, with_flip=with_flip)
    batch.run([spec for name, spec in wanted.items() if name not in records])
    return [records[spec.clip_id] for spec in specs]


class _Batch:
    """The clips that are out, and what became of those that came back."""

    def __init__(
        self,
        executor: Executor,
        folder: Path,
        records: dict[str, ClipRecord],
        progress: Callable[[int], None],
        say: Callable[[str], None],
        *,
        with_flip: bool,
    ) -> None:
        self._executor = executor
        self._folder = folder
        self._records = records
        self._progress = progress
        self._say = say
        self._with_flip = with_flip
        self._out: dict[Future[dict[str, Any]], ClipSpec] = {}
        self._attempts: Counter[ClipSpec] = Counter()
        self._failures: list[tuple[ClipSpec, Exception]] = []

    def run(self, specs: Sequence[ClipSpec]) -> None:
        """Order the clips and take them in as they come."""
        try:
            for spec in specs:
                self._order(spec)
            while self._out:
                back = wait(self._out, timeout=LOOK_UP_S, return_when=FIRST_COMPLETED).done
                for future in back:
                    self._take(future, self._out.pop(future))
        finally:
            for future in self._out:
                future.cancel()
        if self._failures:
            lines = [f"{_name(spec)}: {_reason(error)}" for spec, error in self._failures]
            raise BatchError("\n".join(lines)) from self._failures[0][1]

    def _order(self, spec: ClipSpec, *, with_files: bool = False) -> None:
        contents = {name: _read(spec, name) for name in PATHS if with_files and getattr(spec, name)}
        future = self._executor.submit(
            fill_order,
            spec.to_dict(),
            code_version(),
            contents=contents,
            with_flip=self._with_flip,
        )
        self._out[future] = spec

    def _take(self, future: Future[dict[str, Any]], spec: ClipSpec) -> None:
        try:
            reply = future.result()
            if WANTED in reply:
                self._order(spec, with_files=True)
                return
            self._records[spec.clip_id] = _keep(spec, reply, self._folder)
            self._progress(len(self._records))
        except CancelledError:
            raise BatchError(
                f"{_name(spec)}: was given back unrendered; is the scheduler still there? "
                "What is finished is kept: the same command goes on from here"
            ) from None
        except VersionMismatchError as error:
            raise BatchError(_reason(error)) from error
        except (BrokenExecutor, _DamagedError) as error:
            self._try_again(spec, error)
        except Exception as error:
            # Whatever goes wrong in one clip must not end the others; it is told at the end.
            self._failures.append((spec, error))

    def _try_again(self, spec: ClipSpec, error: Exception) -> None:
        self._attempts[spec] += 1
        what = str(error) if isinstance(error, _DamagedError) else "its process was killed"
        if self._attempts[spec] == MAX_ATTEMPTS:
            again = RuntimeError(f"{what}, {MAX_ATTEMPTS} times; is there too little memory?")
            again.__cause__ = error
            self._failures.append((spec, again))
            return
        number = self._attempts[spec] + 1
        self._say(f"{_name(spec)}: {what}; trying again ({number} of {MAX_ATTEMPTS})")
        self._order(spec)


def _keep(spec: ClipSpec, reply: Mapping[str, Any], folder: Path) -> ClipRecord:
    """Store a clip that arrived; the record names the paths of this machine, not the worker's."""
    record = ClipRecord(**{**reply["record"], "spec": spec.to_dict()})
    data: bytes = reply["data"]
    if record.clip_id != spec.clip_id or hashlib.sha256(data).hexdigest() != record.file_sha256:
        raise _DamagedError("it arrived damaged")
    write_atomically(folder / f"{spec.clip_id}.mp4", data)
    keep_record(record, folder)
    return record


def _read(spec: ClipSpec, name: str) -> bytes:
    """Return a file that a spec names; raises ValueError when it is not what it was."""
    path, sha256 = Path(getattr(spec, name)), getattr(spec, hash_name(name))
    data = path.read_bytes()
    found = hashlib.sha256(data).hexdigest()
    if found != sha256:
        raise ValueError(
            f"{path}: changed since the clip was named (SHA-256 {found[:12]}..., expected "
            f"{sha256[:12]}...); put the file back or name the clip anew"
        )
    return data


def _name(spec: ClipSpec) -> str:
    size = f"{spec.width}x{spec.height}"
    return f"{spec.distance}, {size}, {spec.orbit_direction} ({spec.clip_id})"


def _reason(error: Exception) -> str:
    """Return an error's words, and where it happened, on one line."""
    kind = "" if isinstance(error, (ValueError, OSError, RuntimeError)) else type(error).__name__
    here = f"on {socket.gethostname()}"
    notes = [f"({note})" for note in getattr(error, "__notes__", []) if note != here]
    return " ".join(" ".join([kind, str(error), *notes]).split())
