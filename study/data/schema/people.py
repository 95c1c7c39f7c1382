"""Studies, the people who take part, what they were shown and what they did.

Events are the truth about answers and plays: rows are added, never changed. The stamps on a
participant and a trial are written in the same transaction as the event that they follow from.
"""

from __future__ import annotations

from datetime import date, datetime
from typing import Any

from sqlalchemy import JSON, BigInteger, ForeignKey, Index, String, Text, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from study.data.schema.base import Base


class StudyRow(Base):
    """One version of a study; its definition is kept whole, as JSON."""

    __tablename__ = "studies"
    __table_args__ = (UniqueConstraint("key", "version"),)
    id: Mapped[int] = mapped_column(primary_key=True)
    key: Mapped[str] = mapped_column(String(60))
    version: Mapped[str] = mapped_column(String(60))
    title: Mapped[str] = mapped_column(Text)
    definition: Mapped[str] = mapped_column(Text)
    definition_hash: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[datetime]


class ParticipantRow(Base):
    """One participant: who they are to us is a random pseudonym and the hash of their token.

    ``arrival`` holds what they brought from where they were recruited, as the study file lets it be
    kept; ``person_key`` is a keyed hash by which somebody who comes twice is known again.
    """

    __tablename__ = "participants"
    __table_args__ = (
        Index("ix_participants_arm", "study_id", "size", "orbit_direction"),
        Index("ix_participants_person_key", "person_key", unique=True),
    )
    id: Mapped[int] = mapped_column(primary_key=True)
    study_id: Mapped[int] = mapped_column(ForeignKey("studies.id"))
    public_id: Mapped[str] = mapped_column(String(20), unique=True)
    token_hash: Mapped[str] = mapped_column(String(64), unique=True)
    simulated: Mapped[bool]
    language: Mapped[str] = mapped_column(String(20))
    seed: Mapped[int] = mapped_column(BigInteger)
    recruited_by: Mapped[str] = mapped_column(String(60))
    size: Mapped[str | None] = mapped_column(String(20))
    orbit_direction: Mapped[str | None] = mapped_column(String(20))
    block: Mapped[int | None]
    order_row: Mapped[int | None]
    lease_until: Mapped[datetime | None]
    created_at: Mapped[datetime]
    last_seen_at: Mapped[datetime]
    consented_at: Mapped[datetime | None]
    about_at: Mapped[datetime | None]
    instructed_at: Mapped[datetime | None]
    begun_at: Mapped[datetime | None]
    completed_at: Mapped[datetime | None]
    completion_code: Mapped[str | None] = mapped_column(String(20), unique=True)
    outcome: Mapped[str | None] = mapped_column(String(30))
    arrival: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    person_key: Mapped[str | None] = mapped_column(String(64))


class LinkRow(Base):
    """A personal link: ``is_used`` outlives its participant, so that it opens nothing twice."""

    __tablename__ = "links"
    __table_args__ = (
        UniqueConstraint("study_id", "number"),
        Index("ix_links_participant", "participant_id"),
    )
    id: Mapped[int] = mapped_column(primary_key=True)
    study_id: Mapped[int] = mapped_column(ForeignKey("studies.id"))
    number: Mapped[int]
    token_hash: Mapped[str] = mapped_column(String(64), unique=True)
    is_used: Mapped[bool]
    participant_id: Mapped[int | None] = mapped_column(ForeignKey("participants.id"))
    created_at: Mapped[datetime]


class WithdrawalRow(Base):
    """That somebody withdrew, on which day and at which step: all that is left of them."""

    __tablename__ = "withdrawals"
    id: Mapped[int] = mapped_column(primary_key=True)
    study_id: Mapped[int] = mapped_column(ForeignKey("studies.id"))
    simulated: Mapped[bool]
    withdrawn_on: Mapped[date]
    step: Mapped[str] = mapped_column(String(30))


class SessionRow(Base):
    """One sitting; a new one begins when a participant comes back after a while."""

    __tablename__ = "sessions"
    __table_args__ = (UniqueConstraint("participant_id", "number"),)
    id: Mapped[int] = mapped_column(primary_key=True)
    participant_id: Mapped[int] = mapped_column(ForeignKey("participants.id"))
    number: Mapped[int]
    device: Mapped[dict[str, Any]]
    started_at: Mapped[datetime]
    last_seen_at: Mapped[datetime]


class TrialRow(Base):
    """One clip for one participant: ``clip_id`` names its frames, ``clip`` the file's entry."""

    __tablename__ = "trials"
    __table_args__ = (UniqueConstraint("participant_id", "position"),)
    id: Mapped[int] = mapped_column(primary_key=True)
    participant_id: Mapped[int] = mapped_column(ForeignKey("participants.id"))
    position: Mapped[int]
    number: Mapped[int]
    is_practice: Mapped[bool]
    clip: Mapped[str] = mapped_column(String(60))
    clip_id: Mapped[str] = mapped_column(String(64))
    session_id: Mapped[int | None] = mapped_column(ForeignKey("sessions.id"))
    started_at: Mapped[datetime | None]
    completed_at: Mapped[datetime | None]


class EventRow(Base):
    """Something that happened, added once: ``key`` is the sender's name for it."""

    __tablename__ = "events"
    __table_args__ = (
        UniqueConstraint("participant_id", "key"),
        Index("ix_events_trial_kind", "trial_id", "kind"),
    )
    id: Mapped[int] = mapped_column(primary_key=True)
    participant_id: Mapped[int] = mapped_column(ForeignKey("participants.id"))
    session_id: Mapped[int | None] = mapped_column(ForeignKey("sessions.id"))
    trial_id: Mapped[int | None] = mapped_column(ForeignKey("trials.id"))
    key: Mapped[str] = mapped_column(String(100))
    kind: Mapped[str] = mapped_column(String(30))
    payload: Mapped[dict[str, Any]]
    created_at: Mapped[datetime]


class ErasureRow(Base):
    """Somebody who withdraws at this moment: while it stands, their events may be deleted."""

    __tablename__ = "erasures"
    participant_id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
