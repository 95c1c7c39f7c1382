"""Where the pages' files are: beside the package in a checkout, inside it in an installed wheel."""

from __future__ import annotations

import hashlib
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent


def resource_folder(name: str, package: Path = PACKAGE) -> Path:
    """Return the folder ``templates`` or ``static``.

    Raises FileNotFoundError naming every place that was searched.
    """
    places = (package / name, package.parent / name)
    for place in places:
        if place.is_dir():
            return place
    searched = " and ".join(str(place) for place in places)
    raise FileNotFoundError(
        f"{name}: no such folder at {searched}; install again or run from a whole checkout"
    )


def folder_version(folder: Path) -> str:
    """Return 12 hexadecimal digits over a folder's files: a name under which they never change."""
    digest = hashlib.sha256()
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        digest.update(path.relative_to(folder).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]
