"""A disk cache for bakes that depend on nothing but their key: textures, tables, cone maps.

The cache may be deleted at any time. Keys carry the version of the code that bakes, so a changed
recipe never meets an old bake.
"""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt

from renderer.atomic_file import write_atomically
from renderer.sources import module_version

Array = npt.NDArray[np.generic]


def cache_folder() -> Path:
    """Return the folder of bakes: OCULARIST_CACHE or the user's cache folder."""
    named = os.environ.get("OCULARIST_CACHE")
    if named:
        return Path(named)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "ocularist"


def cached_arrays(key: str, make: Callable[[], dict[str, Array]]) -> dict[str, Array]:
    """Return named arrays from the cache, or make and keep them.

    ``key`` names everything that the arrays depend on besides the code of the module that ``make``
    is written in and of what that module imports: arrays from elsewhere belong in it.
    A damaged or unreadable file is made anew; a folder that cannot be written is no error.
    """
    digest = hashlib.sha256(f"{module_version(make.__module__)}:{key}".encode()).hexdigest()[:24]
    path = cache_folder() / f"{digest}.npz"
    try:
        with np.load(path, allow_pickle=False) as kept:
            return {name: kept[name] for name in kept.files}
    except (OSError, ValueError, EOFError):
        pass
    arrays = make()
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **arrays)
    try:
        write_atomically(path, buffer.getvalue())
    except OSError:
        return arrays
    return arrays


def cached_array(key: str, make: Callable[[], Array]) -> Array:
    """Return one array from the cache, or make and keep it."""

    def named() -> dict[str, Array]:
        return {"array": make()}

    named.__module__ = make.__module__
    return cached_arrays(key, named)["array"]
