"""Where commands write: asked about before work that may take minutes, not after it."""

from __future__ import annotations

import os
from pathlib import Path

from study.commands.values import reading


@reading
def new_file(text: str) -> Path:
    """Read the path of a file to write; its folder may still have to be made."""
    path = Path(text)
    if path.is_dir():
        raise ValueError(f"{path} is a folder; write the file's name too")
    _check_folder(path.parent)
    return path


@reading
def new_folder(text: str) -> Path:
    """Read the path of a folder to write into, which may still have to be made."""
    path = Path(text)
    _check_folder(path)
    return path


@reading
def data_folder(text: str) -> Path:
    """Read the path of a folder that commands share; one that is only read may be locked."""
    path = Path(text)
    _nearest_folder(path)
    return path


def _check_folder(path: Path) -> None:
    """Raise ValueError where files cannot be made in a folder that is there or would be made."""
    there = _nearest_folder(path)
    if not os.access(there, os.W_OK | os.X_OK):
        raise ValueError(f"{there} may not be written to; choose another place")


def _nearest_folder(path: Path) -> Path:
    """Return the folder, or of one yet to be made the nearest above it; a file is a ValueError."""
    there = next(place for place in (path, *path.absolute().parents) if place.exists())
    if not there.is_dir():
        raise ValueError(f"{there} is a file, no folder; choose another place")
    return there
