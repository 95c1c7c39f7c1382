"""Get a study ready in a database: its definition stored, its clips wanted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from study.data.database import Database
    from study.data.studies import Study
    from study.settings import Settings


@dataclass(frozen=True)
class Prepared:
    """An open database with a study in it."""

    db: Database
    study: Study


def prepare(settings: Settings, study: str) -> Prepared:
    """Read a study file, store it, and queue the clips that are not there yet.

    Raises DefinitionError with every fault of the file before anything is stored.
    """
    from study.data import jobs, studies
    from study.data.database import open_database
    from study.design.definition import read_definition

    definition = read_definition(study)
    settings.data_folder.mkdir(parents=True, exist_ok=True)
    db = open_database(settings.database_url)
    stored = studies.register(db, definition)
    jobs.enqueue(db, definition.wanted_specs())
    return Prepared(db, stored)
