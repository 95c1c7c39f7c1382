"""Files that a study file names: found beside it, and known by their contents.

A study lists paths relative to its own file. Clips carry the absolute path, to find the file,
and its SHA-256, which alone decides what a clip is.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from study.design.certificate import Certificate
from study.design.faults import Fault
from study.design.raw import Data, rows_of, table_of

ENVIRONMENT_KINDS: Final = (".exr", ".hdr")
SUN_KEYS: Final = ("sun_azimuth_deg", "sun_elevation_deg")


def find_files(data: Data, folder: Path) -> tuple[dict[str, Any], list[Fault]]:
    """Replace the paths in a parsed study file; return it with the faults of what was not found."""
    scene, faults = _with_environment(table_of(data, "scene"), folder)
    eye, more = _with_iris(table_of(data, "eye"), folder, place="eye")
    irises, missed = _with_irises(table_of(data, "irises"), folder)
    tables = (("scene", scene), ("eye", eye), ("irises", irises))
    found = {name: table for name, table in tables if table}
    policy, amiss = _with_policy(data.get("lod_policy"), folder)
    return {**data, **found, **policy}, [*faults, *more, *missed, *amiss]


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


def _with_irises(irises: Data, folder: Path) -> tuple[dict[str, Any], list[Fault]]:
    """Do for every iris of a study what ``_with_iris`` does for the one of all eyes."""
    found, faults = dict(irises), []
    for name, table in irises.items():
        if isinstance(table, Mapping):
            found[name], more = _with_iris(table, folder, place=f"irises.{name}")
            faults += more
    return found, faults


def _with_iris(eye: Data, folder: Path, *, place: str) -> tuple[dict[str, Any], list[Fault]]:
    """Add the contents' hash to ``iris_file = "anna.npz"``, an iris taken from a photograph."""
    named = eye.get("iris_file")
    if not isinstance(named, str) or not named:
        return dict(eye), []
    path = (folder / named).absolute()
    colours = Fault(f"{place}.iris_colour", f"{named} brings its own colours; leave this out")
    faults = [colours] if "iris_colour" in eye else []
    try:
        sha256 = contents_sha256(path)
    except OSError as error:
        text = f"{path}: {error.strerror}; ocularist iris PHOTO writes one"
        fault = Fault(f"{place}.iris_file", text)
        return {key: value for key, value in eye.items() if key != "iris_file"}, [*faults, fault]
    return {**eye, "iris_file": str(path), "iris_sha256": sha256}, faults


def _with_policy(named: object, folder: Path) -> tuple[dict[str, Any], list[Fault]]:
    """Put the contents of ``lod_policy = "lod_policy.json"`` in the place of its path."""
    if not isinstance(named, str):
        return {}, []
    path = (folder / named).absolute()
    try:
        return {"lod_policy": json.loads(path.read_text(encoding="utf-8-sig"))}, []
    except OSError as error:
        fault = f"{path}: {error.strerror}"
    except ValueError as error:
        fault = f"{path}: not a JSON file: {error}"
    return {"lod_policy": None}, [Fault("lod_policy", fault)]


def contents_sha256(path: Path) -> str:
    """Return the SHA-256 of a file's contents, 64 hexadecimal digits; raises OSError."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


# What definitions of an earlier version did not hold, with what it is when it is left out.
_LATER: Final[Mapping[str, Any]] = {
    "translations": {},
    **{"labels": (), "decimals": 0, "at_least": None, "at_most": None},
    "lod_policy": None,
    "motion": "orbit",
    "switching": None,
    "cube_size": "table",
    **dict.fromkeys(("device_check", "calibration", "eyesight"), None),
    **dict.fromkeys(("iris", "per_person", "breaks"), None),
    "crowd": None,  # of a clip; a scene's is a number
    **dict.fromkeys(
        ("irises", "crowds", "gold", "attention"), ()
    ),  # an empty list, or an empty table
    "warm_up": 0,
    **dict.fromkeys(("completion", "recruiting"), None),
    **dict.fromkeys(("minimum_age", "motion_warning", "withdrawal", "backup_days", "health"), None),
    "max_views": None,
    "decision": None,
    **dict.fromkeys(("within", "before"), None),
    "certificate": Certificate().model_dump(mode="json"),
}


def without_later_keys(data: Mapping[str, Any]) -> dict[str, Any]:
    """Leave out keys that came later and say nothing, here and in every table of a definition.

    So a definition without them is told from others just as before they came. ``approach`` says
    nothing where no clip approaches.
    """
    kept = _said(data)
    if not any(row.get("motion") == "approach" for row in _clip_rows(data)):
        kept.pop("approach", None)
    return kept


def _said(table: Mapping[str, Any]) -> dict[str, Any]:
    return {
        key: _said_within(value)
        for key, value in table.items()
        if key not in _LATER or not _is_silent(value, _LATER[key])
    }


def _is_silent(value: Any, default: Any) -> bool:
    return not value if default == () else bool(value == default)


def _said_within(value: Any) -> Any:
    if isinstance(value, Mapping):
        return _said(value)
    return [_said_within(entry) for entry in value] if isinstance(value, list) else value


def _clip_rows(data: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    tables = ("practice", "clips", "factors", "catch")
    return [row for table in tables for _, row in rows_of(data, table)]


def without_paths(tables: Mapping[str, Any], names: tuple[str, ...]) -> dict[str, Any]:
    """Leave out the keys that say where a file lies, in every table: contents count, not places."""
    return {
        key: without_paths(value, names) if isinstance(value, Mapping) else value
        for key, value in tables.items()
        if key not in names
    }
