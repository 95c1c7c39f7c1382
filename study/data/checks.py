"""Which checks a study has before its clips, and which of them a participant is done with.

A check is done when its event exists. Reads only; ``study.data.before`` records.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final, Literal

from sqlalchemy import select
from sqlalchemy.orm import Session

from study.data.consents import CONSENTED
from study.data.schema import EventRow
from study.design.definition import StudyDefinition

CheckName = Literal["device_check", "calibration", "eyesight"]
CHECKS: Final[tuple[CheckName, ...]] = ("device_check", "calibration", "eyesight")
"""In the order in which they come; the name of each is its event's kind and its page."""


def wanted(definition: StudyDefinition) -> tuple[CheckName, ...]:
    """Return the checks that a study asks for, in order."""
    return tuple(name for name in CHECKS if getattr(definition, name) is not None)


def done_checks(
    session: Session, participant_id: int, definition: StudyDefinition
) -> frozenset[str]:
    """Return the checks that a participant is done with."""
    if not wanted(definition):
        return frozenset()
    query = select(EventRow.kind, EventRow.payload).where(
        EventRow.participant_id == participant_id, EventRow.kind.in_([*CHECKS, CONSENTED])
    )
    return done_in([(kind, payload) for kind, payload in session.execute(query)], definition)


def done_in(
    events: Iterable[tuple[str, Mapping[str, Any]]], definition: StudyDefinition
) -> frozenset[str]:
    """Return the checks that kinds and payloads of a participant's events show to be done.

    Where the consent has asked about data on health, eyesight is left to those who agreed.
    """
    listed = list(events)
    done = {kind for kind, _ in listed if kind in CHECKS}
    agreed = any(kind == CONSENTED and given.get("health") is True for kind, given in listed)
    if definition.consent.health is not None and not agreed:
        done.add("eyesight")
    return frozenset(done)
