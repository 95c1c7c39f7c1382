"""When figures are due: somebody sees the results, answers have come, and it is time again.

They are drawn only for studies whose results a researcher has switched on, only where answers have
come since, and at most once a minute.
"""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import Final

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from study.data.logbook import RESULTS_HIDDEN, RESULTS_SHOWN
from study.data.schema import FigureSetRow, ParticipantRow, ResearcherLogRow, TrialRow

PEOPLE, SIMULATED = "people", "simulated"
KINDS: Final = (PEOPLE, SIMULATED)
FRESH: Final = timedelta(seconds=60)
REST: Final = 4.0  # times as long as the last drawing took: a large study must not draw for ever
RETRY: Final = timedelta(minutes=5)


def shown_studies(session: Session) -> list[int]:
    """Return the studies whose results somebody has switched on at present."""
    last = (
        select(func.max(ResearcherLogRow.id))
        .where(ResearcherLogRow.kind.in_((RESULTS_SHOWN, RESULTS_HIDDEN)))
        .group_by(ResearcherLogRow.researcher_id, ResearcherLogRow.study_id)
    )
    query = (
        select(ResearcherLogRow.study_id)
        .where(ResearcherLogRow.id.in_(last), ResearcherLogRow.kind == RESULTS_SHOWN)
        .distinct()
        .order_by(ResearcherLogRow.study_id)
    )
    return [study_id for study_id in session.scalars(query) if study_id is not None]


def is_due(session: Session, study_id: int, kind: str, now: datetime) -> bool:
    """Say whether figures of these answers have to be drawn now."""
    row = find_set(session, study_id, kind)
    if row is not None and (is_claimed(row, now) or _is_resting(row, now)):
        return False
    answers = newest(session, study_id, kind)
    return bool(answers) and (row is None or row.seen != answers)


def is_claimed(row: FigureSetRow, now: datetime) -> bool:
    """Say whether somebody is drawing them."""
    return bool(row.claimed_by and row.lease_until and row.lease_until > now)


def _is_resting(row: FigureSetRow, now: datetime) -> bool:
    """Say whether the last drawing is too short ago, or failed lately."""
    rest = max(FRESH, timedelta(seconds=REST * (row.took_s or 0.0)))
    has_drawn = row.as_of is not None and now < row.as_of + rest
    return has_drawn or (row.failed_at is not None and now < row.failed_at + RETRY)


def newest(session: Session, study_id: int, kind: str) -> str:
    """Return what changes with every answered trial, and when one goes; "" without any."""
    count, last = session.execute(
        select(func.count(TrialRow.id), func.max(TrialRow.completed_at))
        .join(ParticipantRow, ParticipantRow.id == TrialRow.participant_id)
        .where(
            ParticipantRow.study_id == study_id,
            ParticipantRow.simulated.is_(kind == SIMULATED),
            TrialRow.completed_at.is_not(None),
        )
    ).one()
    return f"{count} until {last.isoformat()}" if last is not None else ""


def find_set(session: Session, study_id: int, kind: str) -> FigureSetRow | None:
    """Return the row of a set, None where nobody has asked for it yet."""
    found: FigureSetRow | None = session.scalar(
        select(FigureSetRow).where(FigureSetRow.study_id == study_id, FigureSetRow.kind == kind)
    )
    return found
