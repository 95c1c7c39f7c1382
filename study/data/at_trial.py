"""What an entry about a trial needs to know and writes: statements that answers and plays share."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any, Final

from sqlalchemy import bindparam, select, update

from study.data.entries import IS_KNOWN, inserting
from study.data.errands import Errand
from study.data.events import checked_key, plain
from study.data.prepared import Prepared, table_of
from study.data.refusals import NotReachedError
from study.data.schema import SessionRow, TrialRow
from study.data.senders import touching

_T: Final = table_of(TrialRow)
_S: Final = table_of(SessionRow)
_EARLIER: Final = _T.alias("earlier")
# One way to the database for four questions: the trial, whether one before it is still open,
# whether this entry came before, and the latest sitting.
_STATE: Final = Prepared(
    select(
        *_T.c,
        select(_EARLIER.c.id)
        .where(
            _EARLIER.c.participant_id == bindparam("who"),
            _EARLIER.c.position < bindparam("position"),
            _EARLIER.c.completed_at.is_(None),
        )
        .exists()
        .label("is_ahead"),
        IS_KNOWN,
        _S.c.id.label("sitting_id"),
        _S.c.last_seen_at.label("seen_at"),
    )
    .select_from(_T.join(_S, _S.c.participant_id == _T.c.participant_id))
    .where(_T.c.participant_id == bindparam("who"), _T.c.position == bindparam("position"))
    .order_by(_S.c.number.desc())
    .limit(1)
)
_START: Final = Prepared(
    update(_T).where(_T.c.id == bindparam("trial")).values(started_at=bindparam("now"))
)
_FINISH: Final = Prepared(
    update(_T)
    .where(_T.c.id == bindparam("trial"))
    .values(completed_at=bindparam("now"), session_id=bindparam("sitting"))
)
_OPEN: Final = Prepared(
    select(_T.c.position, _T.c.is_practice)
    .where(_T.c.participant_id == bindparam("who"), _T.c.completed_at.is_(None))
    .order_by(_T.c.position)
    .limit(1)
)


def reaching(who: Any, position: int, *, key: str) -> Errand[Any]:
    """Return a trial's row with ``is_ahead``, ``is_known``, ``sitting_id`` and ``seen_at``.

    Raises UnusablePayloadError for a key that cannot be stored, NotReachedError for no such trial.
    """
    entry = checked_key(key)
    rows = yield _STATE, {"who": who.id, "position": position, "entry": entry}
    if not rows:
        raise NotReachedError(f"there is no trial {position} yet")
    return rows[0]


def check_reached(trial: Any) -> None:
    """Raise NotReachedError for a trial behind one that is still open."""
    if trial.is_ahead:
        raise NotReachedError(f"trial {trial.position} comes after the ones before it")


def adding(
    who: Any, trial: Any, *, key: str, kind: str, payload: Mapping[str, Any], now: datetime
) -> Errand[int]:
    """Add an event whose key is new, and stamp the trial's beginning at the first sign of it.

    Returns the sitting's number.
    """
    told = plain(payload)
    sitting = yield from touching(who, trial, now)
    if trial.started_at is None:
        yield _START, {"trial": trial.id, "now": now}
    yield from inserting(
        who, sitting=sitting, key=key, kind=kind, told=told, now=now, trial=trial.id
    )
    return sitting


def finishing(trial: Any, *, sitting: int, now: datetime) -> Errand[None]:
    """Stamp a trial's end."""
    yield _FINISH, {"trial": trial.id, "sitting": sitting, "now": now}


def open_trial(who: Any) -> Errand[Any | None]:
    """Return position and ``is_practice`` of the first trial that is open, or None."""
    rows = yield _OPEN, {"who": who.id}
    return rows[0] if rows else None
