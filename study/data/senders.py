"""Who sent something, and that they are here: the first statements of every errand.

They do what ``participants.locked`` and ``participants.touch`` do, in prepared statements.
"""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any, Final

from sqlalchemy import bindparam, select, update

from study.data.devices import read_device
from study.data.errands import Errand
from study.data.participants import IDLE, SEEN_AGAIN, By, Participant, token_hash, touch
from study.data.prepared import Prepared, table_of
from study.data.refusals import WithdrawnError
from study.data.schema import ParticipantRow, SessionRow

_P: Final = table_of(ParticipantRow)
_S: Final = table_of(SessionRow)
_LOCK: Final = {
    name: Prepared(select(*_P.c).where(_P.c[name] == bindparam("value")).with_for_update())
    for name in ("id", "token_hash", "public_id")
}
_SEEN: Final = Prepared(
    update(_P).where(_P.c.id == bindparam("who")).values(last_seen_at=bindparam("now"))
)
_KEPT: Final = Prepared(
    update(_P)
    .where(_P.c.id == bindparam("who"))
    .values(last_seen_at=bindparam("now"), lease_until=bindparam("until"))
)
_SITTING: Final = Prepared(
    update(_S).where(_S.c.id == bindparam("sitting")).values(last_seen_at=bindparam("now"))
)
_DEVICE: Final = Prepared(
    update(_S).where(_S.c.id == bindparam("sitting")).values(device=bindparam("facts"))
)
_LATEST: Final = Prepared(
    select(_S.c.id.label("sitting_id"), _S.c.last_seen_at.label("seen_at"), _S.c.device)
    .where(_S.c.participant_id == bindparam("who"))
    .order_by(_S.c.number.desc())
    .limit(1)
)


def by_token(token: str) -> tuple[By, str]:
    """Say how to find whom a token belongs to."""
    return "token_hash", token_hash(token)


def locking(by: By, value: object) -> Errand[Any | None]:
    """Find somebody's row, on which others who write about them wait; None for nobody."""
    rows = yield _LOCK[by], {"value": value}
    return rows[0] if rows else None


def touching(who: Any, sitting: Any, now: datetime) -> Errand[int]:
    """Keep the sitting and the arm's lease alive; returns the sitting's number in the database.

    ``sitting`` has the ``sitting_id`` of the latest one and when it was ``seen_at`` last.
    """
    since = now - sitting.seen_at
    if since > IDLE:
        found: int = (
            yield lambda session: touch(session, session.get_one(ParticipantRow, who.id), now).id
        )
        return found
    if since >= SEEN_AGAIN:
        yield _SITTING, {"sitting": sitting.sitting_id, "now": now}
        if who.size is not None and who.completed_at is None:
            yield _KEPT, {"who": who.id, "now": now, "until": now + IDLE}
        else:
            yield _SEEN, {"who": who.id, "now": now}
    return int(sitting.sitting_id)


def locking_again(participant: Participant) -> Errand[Any]:
    """Find a participant's row anew, on which others wait.

    Raises WithdrawnError for someone who has withdrawn: an erased one's number may be given anew.
    """
    row = yield from locking("id", participant.id)
    if row is None or row.public_id != participant.public_id:
        raise WithdrawnError("this participant has withdrawn; nothing more is stored")
    return row


def seeing(who: Any, now: datetime, *, device: Mapping[str, Any] | None = None) -> Errand[None]:
    """Note that somebody is here, and with which ``device``; ``who`` is their row, held."""
    [latest] = yield _LATEST, {"who": who.id}
    sitting = yield from touching(who, latest, now)
    if device is not None:
        kept = {**latest.device, **read_device(device)}
        yield _DEVICE, {"sitting": sitting, "facts": kept}
