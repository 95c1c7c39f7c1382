"""Events that belong to no trial, and the stamps that follow from them, as errands."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any, Final, Literal

from sqlalchemy import bindparam, select, update

from study.data.entries import IS_KNOWN, inserting
from study.data.errands import Errand
from study.data.events import checked_key, plain
from study.data.prepared import Prepared, table_of
from study.data.schema import ParticipantRow, SessionRow
from study.data.senders import touching

_S: Final = table_of(SessionRow)
_P: Final = table_of(ParticipantRow)
Stamp = Literal["consented_at", "about_at", "instructed_at", "begun_at"]
STAMPS: Final[tuple[Stamp, ...]] = ("consented_at", "about_at", "instructed_at", "begun_at")
_STAMP: Final = {
    name: Prepared(
        update(_P).where(_P.c.id == bindparam("who")).values({name: bindparam("moment")})
    )
    for name in STAMPS
}
# One way to the database for both: whether this event came before, and the latest sitting.
_STATE: Final = Prepared(
    select(
        _S.c.id.label("sitting_id"),
        _S.c.last_seen_at.label("seen_at"),
        IS_KNOWN,
    )
    .where(_S.c.participant_id == bindparam("who"))
    .order_by(_S.c.number.desc())
    .limit(1)
)


def told_before(who: Any, key: str) -> Errand[Any]:
    """Return ``is_known`` of a key, with ``sitting_id`` and ``seen_at`` of the latest sitting.

    Raises UnusablePayloadError for a key that cannot be stored.
    """
    rows = yield _STATE, {"who": who.id, "entry": checked_key(key)}
    return rows[0]


def noting(
    who: Any,
    state: Any,
    *,
    key: str,
    kind: str,
    payload: Mapping[str, Any],
    now: datetime,
    stamp: Stamp | None = None,
) -> Errand[bool]:
    """Add an event unless its key is known; returns whether it was added.

    ``who`` is the participant's row, held for writing, and ``state`` what ``told_before`` said.
    ``stamp`` is set too, unless it is already.
    """
    told = plain(payload)
    if stamp is not None and getattr(who, stamp) is None:
        yield _STAMP[stamp], {"who": who.id, "moment": now}
    if state.is_known:
        return False
    sitting = yield from touching(who, state, now)
    yield from inserting(who, sitting=sitting, key=key, kind=kind, told=told, now=now)
    return True
