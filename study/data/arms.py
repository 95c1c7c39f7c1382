"""Arms: which size, direction and block of clips a participant gets, and in which order.

An arm is leased. A lease lives as long as its participant gives signs of life and half an hour
more; an expired one no longer counts for balance, but its participant may come back and go on.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from sqlalchemy import and_, func, or_, select
from sqlalchemy.orm import Session

from study.data.completion import COMPLETED, FAILED
from study.data.database import Database
from study.data.participants import IDLE, Participant, locked, record_of
from study.data.readiness import Screen, fitting_sizes, ready_arms
from study.data.schema import ParticipantRow, StudyRow
from study.data.studies import Study, by_id, gate
from study.design.arms import Arm, all_arms, assign_arm, assign_row
from study.design.definition import StudyDefinition
from study.design.parts import read_size
from study.design.schedule import order_rows

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
    fitting = fitting_sizes(definition, screen)
    with db.writing() as session:
        # Two who come at once must not both take the last free place: the study's row is the gate.
        gate(session, StudyRow.id == participant.study_id)
        row = locked(session, participant)
        if row.size is not None and (row.begun_at or read_size(row.size) in fitting):
            return record_of(row)
        open_arms = ready_arms(session, definition) if available is None else list(available)
        size = next((str(s) for s in fitting if any(a.size == str(s) for a in open_arms)), None)
        if size is None:
            return None
        _lease(db, session, row, definition, [arm for arm in open_arms if arm.size == size])
        return record_of(row)


def _lease(
    db: Database,
    session: Session,
    row: ParticipantRow,
    definition: StudyDefinition,
    choice: Sequence[Arm],
) -> None:
    filled = _filled(db, session, row.study_id, simulated=row.simulated, but=row.id)
    rng = np.random.default_rng(row.seed)
    arm = assign_arm(_by_arm(filled), choice, rng, blocks=definition.blocks)
    row.size, row.orbit_direction, row.block = arm.size, arm.orbit_direction, arm.block
    if row.order_row is None:
        used = Counter({(a, n): count for (a, n), count in filled.items() if n is not None})
        row.order_row = assign_row(used, arm, len(order_rows(definition)), rng)
    row.lease_until = db.now() + IDLE


def counts(db: Database, study: Study, *, simulated: bool = False) -> dict[Arm, int]:
    """Return completed participants plus live leases of every arm."""
    with db.reading() as session:
        filled = _by_arm(_filled(db, session, study.id, simulated=simulated))
    return {arm: filled[arm] for arm in all_arms(study.definition)}


def row_counts(db: Database, study: Study, *, simulated: bool = False) -> dict[int, int]:
    """Return completed participants plus live leases of every row of the orders, from 1."""
    with db.reading() as session:
        filled = _filled(db, session, study.id, simulated=simulated)
    found = dict.fromkeys(range(1, len(order_rows(study.definition)) + 1), 0)
    for (_, number), count in filled.items():
        if number is not None:
            found[number] += count
    return found


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


def _filled(
    db: Database, session: Session, study_id: int, *, simulated: bool, but: int | None = None
) -> Filled:
    """Count one kind of people, as simulated ones must not unbalance real ones.

    ``but`` leaves out the participant who asks: a lease that they give up is no longer one.
    """
    places = (
        ParticipantRow.size,
        ParticipantRow.orbit_direction,
        ParticipantRow.block,
        ParticipantRow.order_row,
    )
    query = (
        select(*places, func.count())
        .where(
            ParticipantRow.study_id == study_id,
            ParticipantRow.simulated == simulated,
            ParticipantRow.size.is_not(None),
            or_(
                # Whoever failed the study's checks has not filled a place: somebody else may.
                and_(
                    ParticipantRow.completed_at.is_not(None),
                    func.coalesce(ParticipantRow.outcome, COMPLETED) != FAILED,
                ),
                ParticipantRow.lease_until > db.now(),
            ),
        )
        .group_by(*places)
    )
    if but is not None:
        query = query.where(ParticipantRow.id != but)
    found: Filled = Counter()
    for size, direction, block, order_row, count in session.execute(query):
        found[Arm(size or "", direction or "", block), order_row] += count
    return found
