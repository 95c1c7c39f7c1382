"""Files that a study file names: found beside it, and known by their contents.

A study lists paths relative to its own file. Clips carry the absolute path, to find the file,
and its SHA-256, which alone decides what a clip is.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from study.design.faults import Fault
from study.design.raw import Data, table_of

ENVIRONMENT_KINDS: Final = (".exr", ".hdr")
SUN_KEYS: Final = ("sun_azimuth_deg", "sun_elevation_deg")


def find_files(data: Data, folder: Path) -> tuple[dict[str, Any], list[Fault]]:
    """Replace the paths in a parsed study file; return it with the faults of what was not found."""
    scene, faults = _with_environment(table_of(data, "scene"), folder)
    eye, more = _with_iris(table_of(data, "eye"), folder)
    found = {name: table for name, table in (("scene", scene), ("eye", eye)) if table}
    return {**data, **found}, [*faults, *more]


def _with_environment(scene: Data, folder: Path) -> tuple[dict[str, Any], list[Fault]]:
    """Turn ``environment = "lobby.exr"`` into the three keys of a picture."""
    named = scene.get("environment")
    if not isinstance(named, str) or Path(named).suffix.lower() not in ENVIRONMENT_KINDS:
        return dict(scene), []
    faults = [
        Fault(
            f"scene.{key}",
            f"{named} brings its own sun; leave this out and turn the picture with "
            "environment_turn_deg",
        )
        for key in SUN_KEYS
        if key in scene
    ]
    path = (folder / named).absolute()
    found = {"environment": "image", "environment_file": str(path)}
    try:
        found["environment_sha256"] = contents_sha256(path)
    except OSError as error:
        faults.append(Fault("scene.environment", f"{path}: {error.strerror}"))
        found = {"environment": "park"}
    return {**scene, **found}, faults


def _with_iris(eye: Data, folder: Path) -> tuple[dict[str, Any], list[Fault]]:
    """Add the contents' hash to ``iris_file = "anna.npz"``, an iris taken from a photograph."""
    named = eye.get("iris_file")
    if not isinstance(named, str) or not named:
        return dict(eye), []
    path = (folder / named).absolute()
    colours = Fault("eye.iris_colour", f"{named} brings its own colours; leave this out")
    faults = [colours] if "iris_colour" in eye else []
    try:
        sha256 = contents_sha256(path)
    except OSError as error:
        fault = Fault("eye.iris_file", f"{path}: {error.strerror}; ocularist iris PHOTO writes one")
        return {key: value for key, value in eye.items() if key != "iris_file"}, [*faults, fault]
    return {**eye, "iris_file": str(path), "iris_sha256": sha256}, faults


def contents_sha256(path: Path) -> str:
    """Return the SHA-256 of a file's contents, 64 hexadecimal digits; raises OSError."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def without_paths(tables: Mapping[str, Any], names: tuple[str, ...]) -> dict[str, Any]:
    """Leave out the keys that say where a file lies, in every table: contents count, not places."""
    return {
        key: {name: entry for name, entry in value.items() if name not in names}
        if isinstance(value, Mapping)
        else value
        for key, value in tables.items()
    }
