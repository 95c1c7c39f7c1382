"""Researchers: accounts of the dashboard, patient with typing errors and slow with guessers.

Passwords are kept as argon2id hashes. What researchers do is in ``logbook``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import timedelta
from typing import Final

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError
from sqlalchemy import ColumnElement, delete, func, select

from study.data.database import Database
from study.data.refusals import RefusedError
from study.data.schema import ResearcherRow, SignInAttemptRow

MIN_PASSWORD_CHARS: Final = 12
MAX_PASSWORD_CHARS: Final = 500
WINDOW: Final = timedelta(minutes=15)
FREE_ATTEMPTS_PER_NAME: Final = 5
FREE_ATTEMPTS_PER_ADDRESS: Final = 20

_hasher = PasswordHasher()  # argon2id with the library's parameters (RFC 9106, low memory)
_NOBODY = _hasher.hash("nobody has this password")


class MustWaitError(RefusedError):
    """Too many failed sign-ins; ``wait_s`` seconds have to pass first."""

    def __init__(self, wait_s: int) -> None:
        self.wait_s = wait_s
        super().__init__(f"too many attempts; try again in {math.ceil(wait_s / 60)} minutes")


@dataclass(frozen=True)
class Researcher:
    """An account."""

    id: int
    name: str


def add(db: Database, name: str, password: str) -> Researcher:
    """Make an account, or give an existing one a new password."""
    name = name.strip()
    if not 0 < len(name) <= 100:
        raise RefusedError(f"a name has 1 to 100 characters; found {len(name)}")
    if not MIN_PASSWORD_CHARS <= len(password) <= MAX_PASSWORD_CHARS:
        raise RefusedError(
            f"a password has {MIN_PASSWORD_CHARS} to {MAX_PASSWORD_CHARS} characters; "
            f"found {len(password)}"
        )
    hashed = _hasher.hash(password)
    with db.writing() as session:
        row = session.scalar(select(ResearcherRow).where(ResearcherRow.name == name))
        if row is None:
            row = ResearcherRow(name=name, password_hash=hashed, created_at=db.now())
            session.add(row)
        row.password_hash = hashed
        session.flush()
        return Researcher(row.id, row.name)


def has_any(db: Database) -> bool:
    """Say whether there is an account at all."""
    with db.reading() as session:
        return session.scalar(select(ResearcherRow.id).limit(1)) is not None


def by_id(db: Database, researcher_id: int) -> Researcher | None:
    """Return an account, or None."""
    with db.reading() as session:
        row = session.get(ResearcherRow, researcher_id)
        return None if row is None else Researcher(row.id, row.name)


def sign_in(db: Database, name: str, password: str, *, address: str) -> Researcher | None:
    """Return the account if the password is right, else None. An unknown name takes as long.

    Raises MustWaitError after too many failures for this name or from this address.
    """
    name, address = name.strip()[:100], address[:100]
    wait_s = _wait_s(db, name, address)
    if wait_s:
        raise MustWaitError(wait_s)
    with db.reading() as session:
        row = session.scalar(select(ResearcherRow).where(ResearcherRow.name == name))
    is_right = _is_right(_NOBODY if row is None else row.password_hash, password)
    with db.writing() as session:
        # Old failures matter no more; those of this name are forgiven with the right password.
        old = SignInAttemptRow.created_at < db.now() - WINDOW
        session.execute(delete(SignInAttemptRow).where(old))
        if row is None or not is_right:
            session.add(SignInAttemptRow(name=name, address=address, created_at=db.now()))
            return None
        session.execute(delete(SignInAttemptRow).where(SignInAttemptRow.name == name))
    return Researcher(row.id, row.name)


def _is_right(hashed: str, password: str) -> bool:
    try:
        return len(password) <= MAX_PASSWORD_CHARS and _hasher.verify(hashed, password)
    except (VerificationError, InvalidHashError):
        return False


def _wait_s(db: Database, name: str, address: str) -> int:
    """Return how long to wait: until few enough failures lie within the window."""
    return max(
        _wait_for(db, SignInAttemptRow.name == name, FREE_ATTEMPTS_PER_NAME),
        _wait_for(db, SignInAttemptRow.address == address, FREE_ATTEMPTS_PER_ADDRESS),
    )


def _wait_for(db: Database, whose: ColumnElement[bool], free: int) -> int:
    since = db.now() - WINDOW
    failures = select(func.count(), func.min(SignInAttemptRow.created_at)).where(
        whose, SignInAttemptRow.created_at > since
    )
    with db.reading() as session:
        count, first = session.execute(failures).one()
    if count < free:
        return 0
    return max(1, math.ceil((first + WINDOW - db.now()).total_seconds()))
