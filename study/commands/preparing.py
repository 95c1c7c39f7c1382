"""Get a study ready in a database, or find one that is there."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from study.commands.errors import CommandError

if TYPE_CHECKING:
    from study.data.database import Database
    from study.data.studies import Study
    from study.settings import Settings

_SQLITE: Final = "sqlite:///"


@dataclass(frozen=True)
class Prepared:
    """An open database with a study in it."""

    db: Database
    study: Study


def prepare(settings: Settings, study: str) -> Prepared:
    """Read a study file, store it, and queue the clips that are not there yet.

    Raises DefinitionError with every fault of the file before anything is stored.
    """
    from study.commands.self_test import make_self_test
    from study.data import jobs, studies
    from study.data.database import open_database
    from study.design.definition import read_definition

    definition = read_definition(study)
    settings.data_folder.mkdir(parents=True, exist_ok=True)
    db = open_database(settings.database_url)
    stored = studies.register(db, definition)
    jobs.enqueue(db, definition.wanted_specs())
    if definition.device_check is not None:
        make_self_test(settings.media_folder)
    return Prepared(db, stored)


def find_study(db: Database, wanted: str | None) -> Study:
    """Return the study that a database has under a key or a study file; None: the newest.

    Raises CommandError naming the studies that it has.
    """
    from study.data import studies
    from study.design.definition import read_definition

    if wanted is None or studies.latest(db, wanted) is not None:
        found = studies.latest(db, wanted)
    else:
        definition = read_definition(wanted)
        same = [
            study
            for study in studies.all_studies(db)
            if (study.key, study.version) == (definition.key, definition.version)
        ]
        found = same[-1] if same else None
    if found is None:
        there = ", ".join(f"{s.key} (version {s.version})" for s in studies.all_studies(db))
        raise CommandError(
            f"study {wanted or ''} is not in this database; it has {there}"
            if there
            else "there is no study in this database; ocularist run puts one in"
        )
    return found


def open_existing(settings: Settings) -> Database:
    """Open a database that must be there already; an SQLite file is not made anew.

    Raises CommandError naming the file that is missing.
    """
    from study.data.database import open_database

    path = sqlite_file(settings)
    if path is not None and not path.is_file():
        raise CommandError(
            f"{path}: no such database; ocularist run makes one, --data or --database names another"
        )
    return open_database(settings.database_url)


def tell_if_new(settings: Settings) -> None:
    """Say on stderr that a database will be made: whoever mistyped its place should know."""
    path = sqlite_file(settings)
    if path is not None and not path.is_file():
        print(f"{path}: no such database yet; making it", file=sys.stderr)


def sqlite_file(settings: Settings) -> Path | None:
    """Return the file that holds the database; None for a server's."""
    url = settings.database_url
    return Path(url.removeprefix(_SQLITE)) if url.startswith(_SQLITE) or "://" not in url else None
