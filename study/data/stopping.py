"""Ending early with the answers kept: from then on nobody is at work, and the place is free.

Whoever ended may come back by their link; the first sign of life after it undoes both.
"""

from __future__ import annotations

from typing import Final

from study.data import events
from study.data.database import Database
from study.data.participants import Participant, locked

STOPPED: Final = "stopped"
"""The kind of the event."""


def stop(db: Database, participant: Participant, *, key: str) -> None:
    """Note that a participant ended, and give their arm's lease up; a ``key`` counts once."""
    with db.writing() as session:
        row, now = locked(session, participant), db.now()
        events.add(session, row, key=key, kind=STOPPED, payload={}, now=now)
        if row.lease_until is not None:
            row.lease_until = min(row.lease_until, now)
