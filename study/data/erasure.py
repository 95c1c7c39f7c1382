"""Withdrawal: everything about a participant goes; that somebody withdrew, and when, stays.

What stays bears no pseudonym and no time of day, so that nothing leads back to the person.
"""

from __future__ import annotations

import logging
import sqlite3
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from datetime import date
from typing import Final

from sqlalchemy import delete, select, update

from study.data import figures, progress
from study.data.database import Database
from study.data.participants import Participant
from study.data.schema import (
    ErasureRow,
    EventRow,
    LinkRow,
    ParticipantRow,
    SessionRow,
    TrialRow,
    WithdrawalRow,
)
from study.data.studies import Study

log = logging.getLogger("ocularist.data")
PATIENCE_MS: Final = 2000
_ABOUT_A_PERSON: Final = (EventRow, TrialRow, SessionRow)  # in an order that references allow


@dataclass(frozen=True)
class Withdrawal:
    """One withdrawal: its day in UTC, and the step at which somebody left."""

    withdrawn_on: date
    step: str
    simulated: bool


def withdraw(db: Database, participant: Participant) -> None:
    """Erase a participant, and overwrite what SQLite would leave in its file.

    Does nothing for somebody who is gone already. Not to be called within another transaction.
    """
    with db.writing() as session:
        if db.engine.dialect.name == "sqlite":  # zeroes in the place of deleted rows, at once
            session.connection().exec_driver_sql("PRAGMA secure_delete = ON")
        # In the order of whoever comes in by a link: first it, then the person.
        mine = LinkRow.participant_id == participant.id
        session.execute(select(LinkRow.id).where(mine).with_for_update()).all()
        row = session.get(ParticipantRow, participant.id, with_for_update=True)
        if row is None or row.public_id != participant.public_id:
            return
        step = progress.current_step(db, participant).name
        withdrawal = WithdrawalRow(
            study_id=row.study_id,
            simulated=row.simulated,
            withdrawn_on=db.now().date(),
            step=step,
        )
        erasure = ErasureRow(participant_id=row.id)  # lets the database delete events
        session.add(erasure)
        session.flush()
        for table in _ABOUT_A_PERSON:
            session.execute(delete(table).where(table.participant_id == row.id))
        session.delete(erasure)
        figures.forget(session, row.study_id)  # somebody is drawn in them who is gone
        session.execute(update(LinkRow).where(mine).values(participant_id=None))
        session.delete(row)
        session.add(withdrawal)
    _overwrite(db)


def withdrawals(db: Database, study: Study) -> Sequence[Withdrawal]:
    """Return a study's withdrawals, oldest first."""
    query = select(WithdrawalRow).where(WithdrawalRow.study_id == study.id)
    with db.reading() as session:
        return [
            Withdrawal(row.withdrawn_on, row.step, row.simulated)
            for row in session.scalars(query.order_by(WithdrawalRow.id))
        ]


def _overwrite(db: Database) -> None:
    """Write SQLite's file anew without the pages that were freed, and empty its log.

    Deleted rows would stay readable in free pages and in the write-ahead log. PostgreSQL reuses
    the space of deleted rows by itself.
    """
    if db.engine.dialect.name != "sqlite":
        return
    with closing(db.engine.raw_connection()) as connection:
        cursor = connection.cursor()
        [usual_ms] = cursor.execute("PRAGMA busy_timeout").fetchone()
        try:
            cursor.execute("VACUUM")
            # Emptying the log waits until nobody reads, and whoever writes waits for it.
            cursor.execute(f"PRAGMA busy_timeout = {PATIENCE_MS}")
            [busy, *_] = cursor.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()
        except sqlite3.OperationalError as error:
            log.warning("withdrawal: the file could not be written anew yet (%s)", error)
            return
        finally:
            cursor.execute(f"PRAGMA busy_timeout = {usual_ms}")
    if busy:
        log.warning("withdrawal: somebody reads the database; its log is emptied later")
