"""The tables. Everything else in this package reads and writes through these classes."""

from study.data.schema.access import LimitRow, ResearcherLogRow, ResearcherRow, SignInAttemptRow
from study.data.schema.base import Base
from study.data.schema.people import (
    ErasureRow,
    EventRow,
    LinkRow,
    ParticipantRow,
    SessionRow,
    StudyRow,
    TrialRow,
    WithdrawalRow,
)
from study.data.schema.work import FigureFileRow, FigureSetRow, JobRow

__all__ = [
    "Base",
    "ErasureRow",
    "EventRow",
    "FigureFileRow",
    "FigureSetRow",
    "JobRow",
    "LimitRow",
    "LinkRow",
    "ParticipantRow",
    "ResearcherLogRow",
    "ResearcherRow",
    "SessionRow",
    "SignInAttemptRow",
    "StudyRow",
    "TrialRow",
    "WithdrawalRow",
]
