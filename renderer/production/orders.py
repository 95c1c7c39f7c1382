"""A worker's side of a batch elsewhere: one clip, from plain values to its bytes.

Nothing is shared with who asks: no folder, no GL context, no paths. What crosses the wire is plain
values, and the code's version is compared before they are read. Knows no executor.
"""

from __future__ import annotations

import hashlib
import socket
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from renderer.atomic_file import write_atomically
from renderer.cache import cache_folder
from renderer.clip import PATHS, ClipSpec
from renderer.sources import code_version

if TYPE_CHECKING:
    from renderer.studio import Studio

WANTED: Final = "wanted"  # a reply's key: the files to send with the order the next time


class VersionMismatchError(RuntimeError):
    """A worker has other sources than who asks, so its frames would differ."""


def fill_order(
    spec: Mapping[str, Any],
    version: str,
    *,
    contents: Mapping[str, bytes],
    with_flip: bool = True,
) -> dict[str, Any]:
    """Render one clip in this process; return its ``record`` and the file's bytes as ``data``.

    ``spec`` is ``ClipSpec.to_dict``'s, ``version`` the asker's ``code_version``. ``contents`` holds
    files that the spec names by path, under the spec's name of the path. One that is neither there
    nor on this machine is asked for: the reply is then ``{"wanted": [name, ...]}`` and nothing is
    rendered. ``with_flip`` is ``renderer.production.making.make_clip``'s. Raises
    VersionMismatchError; every error carries this machine's name as a note.
    """
    try:
        _check_version(version)
        local, missing = _on_this_machine(dict(spec), contents)
        if missing:
            return {WANTED: missing}
        # A GL context belongs to the thread that opened it; a worker may have several threads.
        return _gl_thread().submit(_make, ClipSpec.from_dict(local), with_flip).result()
    except Exception as error:
        error.add_note(f"on {socket.gethostname()}")
        raise


def hash_name(path_name: str) -> str:
    """Return the spec's name of the SHA-256 beside a path: ``iris_sha256`` for ``iris_file``."""
    return path_name.removesuffix("_file") + "_sha256"


def _check_version(version: str) -> None:
    if version != code_version():
        raise VersionMismatchError(
            f"a worker has version {code_version()} of the renderer, this machine {version}: "
            "install the same Ocularist on both and start the worker again"
        )


def _on_this_machine(
    spec: dict[str, Any], contents: Mapping[str, bytes]
) -> tuple[dict[str, Any], list[str]]:
    """Return the spec with paths of this machine, and the names of paths that it has no file of."""
    missing = []
    for name in filter(spec.get, PATHS):
        sha256 = spec[hash_name(name)]
        kept = cache_folder() / "inputs" / f"{sha256}{Path(spec[name]).suffix}"
        if name in contents:
            # An iris may be somebody's: nobody else on the machine may read it.
            kept.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            write_atomically(kept, contents[name])
        found = [path for path in (Path(spec[name]), kept) if _holds(path, sha256)]
        if found:
            spec[name] = str(found[0])
        else:
            missing.append(name)
    return spec, missing


def _holds(path: Path, sha256: str) -> bool:
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest() == sha256
    except OSError:
        return False


def _make(spec: ClipSpec, with_flip: bool) -> dict[str, Any]:
    from renderer.production.making import make_clip

    with tempfile.TemporaryDirectory(prefix="ocularist-") as folder:
        path = Path(folder) / "clip.mp4"
        record = make_clip(spec, path, source=_studio(), with_flip=with_flip)
        return {"record": asdict(record), "data": path.read_bytes()}


@cache
def _gl_thread() -> ThreadPoolExecutor:
    """Return the one thread of this process that renders."""
    return ThreadPoolExecutor(1, thread_name_prefix="gl")


@cache
def _studio() -> Studio:
    """Return this process's studio; it keeps its scene from clip to clip."""
    from renderer.studio import Studio

    return Studio()
