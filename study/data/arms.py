"""Arms: which picture size and orbit direction a participant gets, and when its clips are ready.

An arm is leased. A lease lives as long as its participant gives signs of life and half an hour
more; an expired one no longer counts for balance, but its participant may come back and go on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from sqlalchemy import func, or_, select
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.jobs import DONE, FAILED
from study.data.participants import IDLE, Participant, locked, record_of
from study.data.schema import JobRow, ParticipantRow, StudyRow
from study.data.studies import Study, by_id
from study.design.definition import StudyDefinition
from study.design.parts import Size, read_size
from study.design.schedule import Arm, all_arms, assign_arm

Screen = tuple[int, int]
"""Width and height in device pixels of what a clip may fill."""


@dataclass(frozen=True)
class Readiness:
    """How far the clips for one screen are. ``progress`` runs from 0 to 1 for the nearest arm.

    ``is_stuck`` is True when every fitting arm has a clip whose rendering was given up: waiting
    will not help, a researcher has to look.
    """

    fits: bool
    is_ready: bool
    progress: float
    clips_left: int
    is_stuck: bool = False


@dataclass(frozen=True)
class _Share:
    """How far one arm's clips are."""

    progress: float
    left: int
    failed: int


def readiness(db: Database, participant: Participant, *, screen: Screen | None) -> Readiness:
    """Say whether a participant with this screen can start; ``fits`` is False on a small screen."""
    definition = by_id(db, participant.study_id).definition
    fitting = {str(size) for size in fitting_sizes(definition, screen)}
    with db.reading() as session:
        shares = _shares(session, definition)
    mine = [shares[arm] for arm in shares if arm.size in fitting]
    if not mine:
        return Readiness(fits=False, is_ready=False, progress=0.0, clips_left=0)
    nearest = max(mine, key=lambda share: (share.left == 0, not share.failed, share.progress))
    return Readiness(
        fits=True,
        is_ready=nearest.left == 0,
        progress=nearest.progress,
        clips_left=nearest.left,
        is_stuck=nearest.failed > 0,
    )


def assign(
    db: Database,
    participant: Participant,
    *,
    screen: Screen | None = None,
    available: Sequence[Arm] | None = None,
) -> Participant | None:
    """Lease the least filled arm whose clips are ready: the largest size that fits the screen.

    Returns the participant with their arm, or None while no fitting arm is ready. Asked again, it
    keeps the arm; before the first trial it takes another if the screen no longer fits.
    ``available`` replaces the arms whose clips are rendered (simulations need no clips).
    """
    definition = by_id(db, participant.study_id).definition
    fitting = fitting_sizes(definition, screen)
    with db.writing() as session:
        # Two who come at once must not both take the last free place: the study's row is the gate.
        session.get_one(StudyRow, participant.study_id, with_for_update=True)
        row = locked(session, participant)
        if row.size is not None and (row.begun_at or read_size(row.size) in fitting):
            return record_of(row)
        open_arms = ready_arms(session, definition) if available is None else list(available)
        size = next((str(s) for s in fitting if any(a.size == str(s) for a in open_arms)), None)
        if size is None:
            return None
        arm = assign_arm(
            arm_counts(db, session, row),
            [arm for arm in open_arms if arm.size == size],
            np.random.default_rng(row.seed),
        )
        row.size, row.orbit_direction = arm.size, arm.orbit_direction
        row.lease_until = db.now() + IDLE
        return record_of(row)


def fitting_sizes(definition: StudyDefinition, screen: Screen | None) -> list[Size]:
    """Return the study's sizes that a screen can show pixel for pixel, largest first."""
    sizes = sorted(definition.sizes, key=lambda size: size.width * size.height, reverse=True)
    if screen is None:
        return sizes
    return [size for size in sizes if size.width <= screen[0] and size.height <= screen[1]]


def counts(db: Database, study: Study, *, simulated: bool = False) -> dict[Arm, int]:
    """Return completed participants plus live leases of every arm."""
    with db.reading() as session:
        filled = _counts(db, session, study.id, simulated=simulated)
    return {arm: filled.get(arm, 0) for arm in all_arms(study.definition)}


def arm_counts(db: Database, session: Session, row: ParticipantRow) -> dict[Arm, int]:
    """Count the arms among a participant's like: simulated people do not unbalance real ones."""
    return _counts(db, session, row.study_id, simulated=row.simulated)


def _counts(db: Database, session: Session, study_id: int, *, simulated: bool) -> dict[Arm, int]:
    query = (
        select(ParticipantRow.size, ParticipantRow.orbit_direction, func.count())
        .where(
            ParticipantRow.study_id == study_id,
            ParticipantRow.simulated == simulated,
            ParticipantRow.size.is_not(None),
            or_(
                ParticipantRow.completed_at.is_not(None),
                ParticipantRow.lease_until > db.now(),
            ),
        )
        .group_by(ParticipantRow.size, ParticipantRow.orbit_direction)
    )
    return {
        Arm(size or "", direction or ""): count for size, direction, count in session.execute(query)
    }


def ready_arms(session: Session, definition: StudyDefinition) -> list[Arm]:
    """Return the arms all of whose clips are rendered."""
    return [arm for arm, share in _shares(session, definition).items() if share.left == 0]


def _shares(session: Session, definition: StudyDefinition) -> dict[Arm, _Share]:
    """Return for every arm how far its clips are; only a finished clip counts as whole."""
    query = select(JobRow.clip_id, JobRow.state, JobRow.progress)
    states = {clip_id: (state, share) for clip_id, state, share in session.execute(query)}
    shares = {}
    for arm in all_arms(definition):
        specs = definition.clip_specs(read_size(arm.size), arm.orbit_direction).values()
        mine = [states.get(clip_id, ("", 0.0)) for clip_id in {spec.clip_id for spec in specs}]
        whole = [1.0 if state == DONE else min(share, 0.99) for state, share in mine]
        shares[arm] = _Share(
            progress=sum(whole) / len(whole),
            left=sum(share < 1.0 for share in whole),
            failed=sum(state == FAILED for state, _ in mine),
        )
    return shares
