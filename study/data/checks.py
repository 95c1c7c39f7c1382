"""Which checks a study has before its clips, and which of them a participant is done with.

A check is done when its event exists. Reads only; ``study.data.before`` records.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final, Literal

from sqlalchemy import bindparam, or_, select

from study.data.consents import CONSENTED, agrees_to_health
from study.data.errands import Errand
from study.data.prepared import Prepared, table_of
from study.data.schema import EventRow
from study.design.definition import StudyDefinition

CheckName = Literal["device_check", "calibration", "eyesight"]
CHECKS: Final[tuple[CheckName, ...]] = ("device_check", "calibration", "eyesight")
"""In the order in which they come; the name of each is its event's kind and its page."""
_E: Final = table_of(EventRow)
_EVENTS: Final = Prepared(
    select(_E.c.kind, _E.c.payload)
    .where(
        _E.c.participant_id == bindparam("who"),
        or_(*(_E.c.kind == kind for kind in (*CHECKS, CONSENTED))),
    )
    .order_by(_E.c.id)
)


def wanted(definition: StudyDefinition) -> tuple[CheckName, ...]:
    """Return the checks that a study asks for, in order."""
    return tuple(name for name in CHECKS if getattr(definition, name) is not None)


def doing(who: Any, definition: StudyDefinition) -> Errand[frozenset[str]]:
    """Return the checks that a participant is done with; ``who`` is their row."""
    if not wanted(definition):
        return frozenset()
    rows = yield _EVENTS, {"who": who.id}
    return done_in([(row.kind, row.payload) for row in rows], definition)


def done_in(
    events: Iterable[tuple[str, Mapping[str, Any]]], definition: StudyDefinition
) -> frozenset[str]:
    """Return the checks that kinds and payloads of a participant's events, in order, show as done.

    Where the consent has asked about data on health, eyesight is left to those who agreed.
    """
    listed = list(events)
    done = {kind for kind, _ in listed if kind in CHECKS}
    agreed = agrees_to_health(given for kind, given in listed if kind == CONSENTED)
    if definition.consent.health is not None and not agreed:
        done.add("eyesight")
    return frozenset(done)
