"""Enrolment: a participant gets a secret token, and a random pseudonym to be known by."""

from __future__ import annotations

import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from sqlalchemy import bindparam, insert, select

from study.data.database import Database
from study.data.devices import read_device
from study.data.errands import Errand
from study.data.participants import Participant, finding, record_of, token_hash
from study.data.prepared import Prepared, table_of
from study.data.schema import ParticipantRow, SessionRow
from study.data.studies import Study

_ALPHABET: Final = "23456789abcdefghjkmnpqrstvwxyz"  # nothing that reads like something else
_P: Final = table_of(ParticipantRow)
_S: Final = table_of(SessionRow)
_GIVEN: Final = (
    *("study_id", "public_id", "token_hash", "simulated", "language", "seed", "recruited_by"),
    *("created_at", "last_seen_at", "arrival", "person_key"),
)
_TAKEN: Final = Prepared(select(_P.c.id).where(_P.c.public_id == bindparam("name")))
_ADD: Final = Prepared(
    insert(_P)
    .values({name: bindparam(f"new_{name}") for name in _GIVEN})
    .returning(_P.c.id.label("number"))
)
_SIT: Final = Prepared(
    insert(_S)
    .values(
        participant_id=bindparam("who"),
        number=1,
        device=bindparam("facts"),
        started_at=bindparam("now"),
        last_seen_at=bindparam("now"),
    )
    .inline()
)


@dataclass(frozen=True)
class Enrolment:
    """A new participant and the token that proves who they are; only its hash is stored."""

    participant: Participant
    token: str


def enrol(db: Database, study: Study, **facts: Any) -> Enrolment:
    """Add a participant, in a transaction of its own; ``facts`` are those of ``enrolling``."""
    token = facts.pop("token", None) or secrets.token_urlsafe(32)
    row = db.run(lambda: enrolling(db, study, token=token, **facts))
    return Enrolment(record_of(row), token)


def enrolling(
    db: Database,
    study: Study,
    *,
    token: str,
    simulated: bool = False,
    rng: np.random.Generator | None = None,
    language: str | None = None,
    recruited_by: str = "link",
    arrival: Mapping[str, str] | None = None,
    person_key: str | None = None,
    device: Mapping[str, Any] | None = None,
) -> Errand[Any]:
    """Add a participant; returns their row.

    ``device`` describes screen and browser; the table's column names are ``screen_width``,
    ``screen_height``, ``pixel_ratio`` and ``user_agent_family``. With ``rng`` pseudonym and seed
    can be repeated.
    """
    drawn = rng or np.random.default_rng(secrets.randbits(128))
    name = _pseudonym(drawn)
    while (yield _TAKEN, {"name": name}):
        name = _pseudonym(drawn)
    now = db.now()
    facts = {
        "study_id": study.id,
        "public_id": name,
        "token_hash": token_hash(token),
        "simulated": simulated,
        "language": language or study.definition.language,
        "seed": int(drawn.integers(2**62)),
        "recruited_by": recruited_by[:60],
        "created_at": now,
        "last_seen_at": now,
        "arrival": dict(arrival) if arrival else None,
        "person_key": person_key,
    }
    [added] = yield _ADD, {f"new_{name}": value for name, value in facts.items()}
    yield _SIT, {"who": added.number, "facts": read_device(device or {}), "now": now}
    return (yield from finding("id", added.number))


def _pseudonym(rng: np.random.Generator) -> str:
    return "p-" + "".join(_ALPHABET[i] for i in rng.integers(len(_ALPHABET), size=8))
