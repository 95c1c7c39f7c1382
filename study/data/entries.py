"""One event as a row: how it is told from one that came before, and how it is added.

Shared by what belongs to a trial (``at_trial``) and what does not (``notes``); statements alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any, Final

from sqlalchemy import bindparam, insert, select

from study.data.errands import Errand
from study.data.prepared import Prepared, table_of
from study.data.schema import EventRow

_E: Final = table_of(EventRow)
IS_KNOWN: Final = (
    select(_E.c.id)
    .where(_E.c.participant_id == bindparam("who"), _E.c.key == bindparam("entry"))
    .exists()
    .label("is_known")
)
"""Whether an event of this participant has this key, as a column among others."""
_ADD: Final = Prepared(
    insert(_E)
    .values(
        participant_id=bindparam("who"),
        session_id=bindparam("sitting"),
        trial_id=bindparam("trial"),
        key=bindparam("entry"),
        kind=bindparam("what"),
        payload=bindparam("told"),
        created_at=bindparam("now"),
    )
    .inline()
)


def inserting(
    who: Any,
    *,
    sitting: int,
    key: str,
    kind: str,
    told: Mapping[str, Any],
    now: datetime,
    trial: int | None = None,
) -> Errand[None]:
    """Add an event whose key is new; ``told`` is plain JSON, ``trial`` the trial's number here."""
    values = {"who": who.id, "sitting": sitting, "trial": trial}
    yield _ADD, values | {"entry": key, "what": kind, "told": told, "now": now}
