"""Work for other processes: clips to render, figures to draw."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, ForeignKey, Index, LargeBinary, String, Text, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from study.data.schema.base import Base


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
