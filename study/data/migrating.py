"""Migrating: the tables of a database as this version of Ocularist wants them."""

from __future__ import annotations

from importlib import resources
from typing import Final

from alembic import command
from alembic.config import Config
from sqlalchemy import Engine, text

MIGRATION_LOCK: Final = 71_202_611  # any number, the same for all who migrate one database


def bring_up_to_date(engine: Engine) -> None:
    """Bring the tables up to date; an engine whose tables cannot be is closed."""
    try:
        _migrate(engine)
    except BaseException:
        engine.dispose()
        raise


def _migrate(engine: Engine) -> None:
    """Bring the tables up to date; of several processes one migrates, the others wait."""
    with (
        resources.as_file(resources.files("study.data") / "migrations") as folder,
        engine.begin() as connection,
    ):
        if engine.dialect.name == "postgresql":
            connection.execute(text(f"SELECT pg_advisory_xact_lock({MIGRATION_LOCK})"))
        config = Config()
        config.set_main_option("script_location", str(folder).replace("%", "%%"))
        config.attributes["connection"] = connection
        command.upgrade(config, "head")
