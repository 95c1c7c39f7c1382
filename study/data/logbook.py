"""What researchers did that others must see later, above all switching the results on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlalchemy import select

from study.data.database import Database
from study.data.researchers import Researcher
from study.data.schema import ResearcherLogRow, ResearcherRow
from study.data.studies import Study

RESULTS_SHOWN: Final = "results-shown"
RESULTS_HIDDEN: Final = "results-hidden"


@dataclass(frozen=True)
class LogEntry:
    """Something that a researcher did."""

    researcher: str
    kind: str
    payload: Mapping[str, Any]
    created_at: datetime


def log(
    db: Database,
    researcher: Researcher,
    kind: str,
    *,
    study: Study | None = None,
    payload: Mapping[str, Any] | None = None,
) -> None:
    """Record something that a researcher did."""
    with db.writing() as session:
        session.add(
            ResearcherLogRow(
                researcher_id=researcher.id,
                study_id=None if study is None else study.id,
                kind=kind,
                payload=dict(payload or {}),
                created_at=db.now(),
            )
        )


def show_results(db: Database, researcher: Researcher, study: Study, *, shown: bool) -> None:
    """Record that a researcher switched a study's results on or off for themselves."""
    log(db, researcher, RESULTS_SHOWN if shown else RESULTS_HIDDEN, study=study)


def sees_results(db: Database, researcher: Researcher, study: Study) -> bool:
    """Say whether a researcher has the results of a study switched on."""
    query = (
        select(ResearcherLogRow.kind)
        .where(
            ResearcherLogRow.researcher_id == researcher.id,
            ResearcherLogRow.study_id == study.id,
            ResearcherLogRow.kind.in_((RESULTS_SHOWN, RESULTS_HIDDEN)),
        )
        .order_by(ResearcherLogRow.id.desc())
        .limit(1)
    )
    with db.reading() as session:
        return session.scalar(query) == RESULTS_SHOWN


def logged(db: Database, study: Study | None = None) -> list[LogEntry]:
    """Return what researchers did, newest first: everything, or what concerns one study."""
    query = (
        select(ResearcherRow.name, ResearcherLogRow)
        .join(ResearcherRow, ResearcherRow.id == ResearcherLogRow.researcher_id)
        .order_by(ResearcherLogRow.id.desc())
    )
    if study is not None:
        query = query.where(ResearcherLogRow.study_id == study.id)
    with db.reading() as session:
        return [
            LogEntry(name, row.kind, row.payload, row.created_at)
            for name, row in session.execute(query)
        ]
