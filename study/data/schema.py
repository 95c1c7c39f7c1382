"""The tables. Everything else in this package reads and writes through these classes.

Events are the truth about answers and plays: rows are added, never changed. The stamps on a
participant and a trial are written in the same transaction as the event that they follow from.
"""

from __future__ import annotations

from datetime import date, datetime
from typing import Any, ClassVar

from sqlalchemy import (
    JSON,
    BigInteger,
    ForeignKey,
    Index,
    LargeBinary,
    MetaData,
    String,
    Text,
    UniqueConstraint,
)
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column

from study.data.moments import UtcDateTime


class Base(DeclarativeBase):
    """What all tables share."""

    metadata = MetaData(
        naming_convention={  # fixed names, so that a later migration can change what it finds
            "ix": "ix_%(table_name)s_%(column_0_name)s",
            "uq": "uq_%(table_name)s_%(column_0_N_name)s",
            "fk": "fk_%(table_name)s_%(column_0_name)s",
            "pk": "pk_%(table_name)s",
        }
    )
    type_annotation_map: ClassVar[dict[Any, Any]] = {
        datetime: UtcDateTime(),
        dict[str, Any]: JSON(),
    }


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


class JobRow(Base):
    """One clip to render; ``priority`` counts up in the order in which clips are needed."""

    __tablename__ = "jobs"
    __table_args__ = (Index("ix_jobs_state_priority", "state", "priority"),)
    id: Mapped[int] = mapped_column(primary_key=True)
    clip_id: Mapped[str] = mapped_column(String(64), unique=True)
    spec: Mapped[dict[str, Any]]
    size: Mapped[str] = mapped_column(String(20))
    orbit_direction: Mapped[str] = mapped_column(String(20))
    state: Mapped[str] = mapped_column(String(20))
    priority: Mapped[int]
    attempts: Mapped[int]
    progress: Mapped[float]
    claimed_by: Mapped[str | None] = mapped_column(String(200))
    lease_until: Mapped[datetime | None]
    error: Mapped[str | None] = mapped_column(Text)
    record: Mapped[dict[str, Any] | None]
    created_at: Mapped[datetime]
    started_at: Mapped[datetime | None]
    finished_at: Mapped[datetime | None]


class ResearcherRow(Base):
    """An account of the dashboard."""

    __tablename__ = "researchers"
    id: Mapped[int] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(String(100), unique=True)
    password_hash: Mapped[str] = mapped_column(String(200))
    created_at: Mapped[datetime]


class ResearcherLogRow(Base):
    """What a researcher did that others must be able to see later: showing results, exporting."""

    __tablename__ = "researcher_log"
    id: Mapped[int] = mapped_column(primary_key=True)
    researcher_id: Mapped[int] = mapped_column(ForeignKey("researchers.id"))
    study_id: Mapped[int | None] = mapped_column(ForeignKey("studies.id"))
    kind: Mapped[str] = mapped_column(String(30))
    payload: Mapped[dict[str, Any]]
    created_at: Mapped[datetime]


class SignInAttemptRow(Base):
    """A failed sign-in; enough of them make the next one wait."""

    __tablename__ = "sign_in_attempts"
    __table_args__ = (Index("ix_sign_in_attempts_at", "created_at"),)
    id: Mapped[int] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(String(100), index=True)
    address: Mapped[str] = mapped_column(String(100), index=True)
    created_at: Mapped[datetime]


class ErasureRow(Base):
    """Somebody who withdraws at this moment: while it stands, their events may be deleted."""

    __tablename__ = "erasures"
    participant_id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)


class LimitRow(Base):
    """How often somebody did something ``since`` a moment; ``who`` is a keyed hash."""

    __tablename__ = "limits"
    kind: Mapped[str] = mapped_column(String(20), primary_key=True)
    who: Mapped[str] = mapped_column(String(64), primary_key=True)
    since: Mapped[datetime]
    count: Mapped[int]


class FigureSetRow(Base):
    """The figures of one study's answers, people's or simulated ones, as of one moment.

    ``seen`` says which answers they were drawn from; ``summary`` is what stands beside them.
    """

    __tablename__ = "figure_sets"
    __table_args__ = (UniqueConstraint("study_id", "kind"),)
    id: Mapped[int] = mapped_column(primary_key=True)
    study_id: Mapped[int] = mapped_column(ForeignKey("studies.id"))
    kind: Mapped[str] = mapped_column(String(20))
    as_of: Mapped[datetime | None]
    seen: Mapped[str | None] = mapped_column(String(100))
    took_s: Mapped[float | None]
    summary: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    claimed_by: Mapped[str | None] = mapped_column(String(200))
    lease_until: Mapped[datetime | None]
    started_at: Mapped[datetime | None]
    error: Mapped[str | None] = mapped_column(Text)
    failed_at: Mapped[datetime | None]


class FigureFileRow(Base):
    """One file of a set of figures, compressed by zlib."""

    __tablename__ = "figure_files"
    set_id: Mapped[int] = mapped_column(ForeignKey("figure_sets.id"), primary_key=True)
    name: Mapped[str] = mapped_column(String(100), primary_key=True)
    content: Mapped[bytes] = mapped_column(LargeBinary)
