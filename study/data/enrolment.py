"""Enrolment: a participant gets a secret token, and a random pseudonym to be known by."""

from __future__ import annotations

import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.devices import read_device
from study.data.participants import Participant, open_sitting, record_of, token_hash
from study.data.schema import ParticipantRow
from study.data.studies import Study

_ALPHABET: Final = "23456789abcdefghjkmnpqrstvwxyz"  # nothing that reads like something else


@dataclass(frozen=True)
class Enrolment:
    """A new participant and the token that proves who they are; only its hash is stored."""

    participant: Participant
    token: str


def enrol(
    db: Database,
    study: Study,
    *,
    simulated: bool = False,
    rng: np.random.Generator | None = None,
    language: str | None = None,
    recruited_by: str = "link",
    device: Mapping[str, Any] | None = None,
    token: str | None = None,
) -> Enrolment:
    """Add a participant. ``device`` describes screen and browser; the table's column names are
    ``screen_width``, ``screen_height``, ``pixel_ratio`` and ``user_agent_family``.

    With ``rng`` pseudonym and seed can be repeated; the token cannot, unless it is given.
    """
    drawn = rng or np.random.default_rng(secrets.randbits(128))
    token = token or secrets.token_urlsafe(32)
    now = db.now()
    with db.writing() as session:
        row = ParticipantRow(
            study_id=study.id,
            public_id=_free_pseudonym(session, drawn),
            token_hash=token_hash(token),
            simulated=simulated,
            language=language or study.definition.language,
            seed=int(drawn.integers(2**62)),
            recruited_by=recruited_by[:60],
            created_at=now,
            last_seen_at=now,
        )
        session.add(row)
        session.flush()
        open_sitting(session, row, now, read_device(device or {}), number=1)
        return Enrolment(record_of(row), token)


def _free_pseudonym(session: Session, rng: np.random.Generator) -> str:
    while True:
        name = "p-" + "".join(_ALPHABET[i] for i in rng.integers(len(_ALPHABET), size=8))
        taken = select(func.count()).where(ParticipantRow.public_id == name)
        if not session.scalar(taken):
            return name
