"""Personal links: each lets in one person, once; only the hash of its token is stored."""

from __future__ import annotations

import secrets
from dataclasses import dataclass

from sqlalchemy import func, select

from study.data.database import Database
from study.data.participants import Participant, record_of, token_hash
from study.data.schema import LinkRow, ParticipantRow, StudyRow
from study.data.studies import Study, gate


@dataclass(frozen=True)
class NewLink:
    """A link as it was made: its number in the researcher's list, and the token that opens it."""

    number: int
    token: str


@dataclass(frozen=True)
class Link:
    """A link as it is found: used or not, and by whom, unless they have withdrawn."""

    study_id: int
    number: int
    is_used: bool
    participant: Participant | None


@dataclass(frozen=True)
class LinkCounts:
    """How many personal links a study has; all versions of it together."""

    used: int
    unused: int

    @property
    def total(self) -> int:
        """Used and unused ones."""
        return self.used + self.unused


def make(db: Database, study: Study, count: int) -> list[NewLink]:
    """Make links, numbered on from those that the study has."""
    with db.writing() as session:
        gate(session, StudyRow.id == study.id)
        last = session.scalar(select(func.max(LinkRow.number)).where(LinkRow.study_id == study.id))
        made = [
            NewLink(number, secrets.token_urlsafe(24))
            for number in range((last or 0) + 1, (last or 0) + 1 + count)
        ]
        session.add_all(
            LinkRow(
                study_id=study.id,
                number=link.number,
                token_hash=token_hash(link.token),
                is_used=False,
                created_at=db.now(),
            )
            for link in made
        )
    return made


def find(db: Database, token: str) -> Link | None:
    """Return the link that a token opens, or None."""
    query = (
        select(LinkRow, ParticipantRow)
        .outerjoin(ParticipantRow, LinkRow.participant_id == ParticipantRow.id)
        .where(LinkRow.token_hash == token_hash(token))
    )
    with db.reading() as session:
        found = session.execute(query).one_or_none()
        if found is None:
            return None
        link, person = found
        mine = None if person is None else record_of(person)
        return Link(link.study_id, link.number, link.is_used, mine)


def counts(db: Database, study: Study) -> LinkCounts:
    """Count a study's links."""
    query = (
        select(LinkRow.is_used, func.count().label("total"))
        .join(StudyRow, LinkRow.study_id == StudyRow.id)
        .where(StudyRow.key == study.key)
        .group_by(LinkRow.is_used)
    )
    with db.reading() as session:
        found = {bool(row.is_used): int(row.total) for row in session.execute(query)}
    return LinkCounts(used=found.get(True, 0), unused=found.get(False, 0))
