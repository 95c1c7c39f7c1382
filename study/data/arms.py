"""Arms: which size, direction and block of clips a participant gets, and in which order.

An arm is leased. A lease lives as long as its participant gives signs of life and half an hour
more; an expired one no longer counts for balance, but its participant may come back and go on.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from sqlalchemy import and_, bindparam, func, or_, select, update

from study.data.completion import COMPLETED, FAILED
from study.data.database import Database
from study.data.errands import Errand
from study.data.participants import IDLE, Participant, finding, record_of
from study.data.prepared import Prepared, table_of
from study.data.readiness import Screen, fitting_sizes, ready_arms
from study.data.schema import ParticipantRow, StudyRow
from study.data.senders import locking_again
from study.data.studies import Study, by_id
from study.design.arms import Arm, all_arms, assign_arm, assign_row
from study.design.definition import StudyDefinition
from study.design.parts import read_size
from study.design.schedule import order_rows

_P: Final = table_of(ParticipantRow)
_S: Final = table_of(StudyRow)
GATE: Final = Prepared(
    select(_S.c.id).where(_S.c.id == bindparam("study")).with_for_update(key_share=True)
)
"""Lets one transaction after the other pass; ``studies.gate`` says why."""
_LEASE: Final = Prepared(
    update(_P)
    .where(_P.c.id == bindparam("who"))
    .values(
        size=bindparam("wide"),
        orbit_direction=bindparam("way"),
        block=bindparam("part"),
        order_row=bindparam("order"),
        lease_until=bindparam("until"),
    )
)
_PLACES: Final = (_P.c.size, _P.c.orbit_direction, _P.c.block, _P.c.order_row)
_FILLED: Final = Prepared(
    select(*_PLACES, func.count().label("people"))
    .where(
        _P.c.study_id == bindparam("study"),
        _P.c.simulated == bindparam("kind"),
        _P.c.size.is_not(None),
        _P.c.id != bindparam("but"),
        or_(
            # Whoever failed the study's checks has not filled a place: somebody else may.
            and_(
                _P.c.completed_at.is_not(None),
                func.coalesce(_P.c.outcome, COMPLETED) != FAILED,
            ),
            _P.c.lease_until > bindparam("now"),
        ),
    )
    .group_by(*_PLACES)
)
Filled = Counter[tuple[Arm, int | None]]
"""How many completed or are at work, by arm and row of the orders."""


def assign(
    db: Database,
    participant: Participant,
    *,
    screen: Screen | None = None,
    available: Sequence[Arm] | None = None,
) -> Participant | None:
    """Lease a least filled arm whose clips are ready, of the largest size that fits the screen.

    Returns the participant with their arm, or None while no fitting arm is ready. Asked again, it
    keeps the arm; before the first trial it takes another if the screen no longer fits.
    ``available`` replaces the arms whose clips are rendered (simulations need no clips).
    """
    definition = by_id(db, participant.study_id).definition
    return db.run(lambda: leasing(db, participant, definition, screen=screen, available=available))


def leasing(
    db: Database,
    participant: Participant,
    definition: StudyDefinition,
    *,
    screen: Screen | None = None,
    available: Sequence[Arm] | None = None,
) -> Errand[Participant | None]:
    """Do the same as an errand, one after the other: it asks for the study's row first.

    Two who come at once must not both take the last free place.
    """
    yield GATE, {"study": participant.study_id}
    who = yield from locking_again(participant)
    if keeps_arm(who, definition, screen):
        return record_of(who)
    open_arms = available if available is not None else (yield from ready_arms(definition))
    sizes = [str(size) for size in fitting_sizes(definition, screen)]
    size = next((one for one in sizes if any(arm.size == one for arm in open_arms)), None)
    if size is None:
        return None
    yield from _take(db, who, definition, [arm for arm in open_arms if arm.size == size])
    return record_of((yield from finding("id", who.id)))


def keeps_arm(who: Any, definition: StudyDefinition, screen: Screen | None) -> bool:
    """Say whether somebody has an arm that they keep: it fits the screen, or they have begun."""
    if who.size is None:
        return False
    return who.begun_at is not None or read_size(who.size) in fitting_sizes(definition, screen)


def _take(
    db: Database, who: Any, definition: StudyDefinition, choice: Sequence[Arm]
) -> Errand[None]:
    filled = yield from _filling(db, who.study_id, simulated=who.simulated, but=who.id)
    rng = np.random.default_rng(who.seed)
    arm = assign_arm(_by_arm(filled), choice, rng, blocks=definition.blocks)
    order_row = who.order_row
    if order_row is None:
        used = Counter({(a, n): count for (a, n), count in filled.items() if n is not None})
        order_row = assign_row(used, arm, len(order_rows(definition)), rng)
    yield (
        _LEASE,
        {
            "who": who.id,
            "wide": arm.size,
            "way": arm.orbit_direction,
            "part": arm.block,
            "order": order_row,
            "until": db.now() + IDLE,
        },
    )


def counts(db: Database, study: Study, *, simulated: bool = False) -> dict[Arm, int]:
    """Return completed participants plus live leases of every arm."""
    filled = _by_arm(db.look(lambda: _filling(db, study.id, simulated=simulated)))
    return {arm: filled[arm] for arm in all_arms(study.definition)}


def arm_of(row: ParticipantRow | Participant) -> Arm | None:
    """Return a participant's arm, or None while they have none."""
    if row.size is None or row.orbit_direction is None:
        return None
    return Arm(row.size, row.orbit_direction, row.block)


def _by_arm(filled: Filled) -> Counter[Arm]:
    found: Counter[Arm] = Counter()
    for (arm, _), count in filled.items():
        found[arm] += count
    return found


def _filling(
    db: Database, study_id: int, *, simulated: bool, but: int | None = None
) -> Errand[Filled]:
    """Count one kind of people, as simulated ones must not unbalance real ones.

    ``but`` leaves out the participant who asks: a lease that they give up is no longer one.
    """
    values = {"study": study_id, "kind": simulated, "now": db.now(), "but": but or 0}
    rows = yield _FILLED, values
    found: Filled = Counter()
    for row in rows:
        arm = Arm(row.size or "", row.orbit_direction or "", row.block)
        found[arm, row.order_row] += row.people
    return found
