"""Who gets at results, and how often anybody may do something."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from study.data.schema.base import Base


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


class LimitRow(Base):
    """How often somebody did something ``since`` a moment; ``who`` is a keyed hash."""

    __tablename__ = "limits"
    kind: Mapped[str] = mapped_column(String(20), primary_key=True)
    who: Mapped[str] = mapped_column(String(64), primary_key=True)
    since: Mapped[datetime]
    count: Mapped[int]
