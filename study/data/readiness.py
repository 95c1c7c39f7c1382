"""Readiness: how far the clips of each arm are rendered, and which arm a screen may have."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from sqlalchemy import select

from study.data.database import Database
from study.data.errands import Errand
from study.data.jobs import DONE, FAILED
from study.data.participants import Participant
from study.data.prepared import Prepared, table_of
from study.data.schema import JobRow
from study.data.studies import by_id
from study.design.arms import Arm, all_arms, clips_of_arm
from study.design.definition import StudyDefinition
from study.design.parts import Size, read_size

Screen = tuple[int, int]
"""Width and height in device pixels of what a clip may fill."""


_J: Final = table_of(JobRow)
_JOBS: Final = Prepared(select(_J.c.clip_id, _J.c.state, _J.c.progress))


@dataclass(frozen=True)
class Readiness:
    """How far the clips for one screen are. ``progress`` runs from 0 to 1 for the nearest arm.

    ``clips`` names that arm's files. ``is_stuck`` is True when every fitting arm has a clip whose
    rendering was given up: waiting will not help, a researcher has to look.
    """

    fits: bool
    is_ready: bool
    progress: float
    clips_left: int
    is_stuck: bool = False
    clips: frozenset[str] = frozenset()


@dataclass(frozen=True)
class _Share:
    """How far one arm's clips are."""

    progress: float
    left: int
    failed: int
    clips: frozenset[str]


def readiness(db: Database, participant: Participant, *, screen: Screen | None) -> Readiness:
    """Say whether a participant with this screen can start; ``fits`` is False on a small screen."""
    definition = by_id(db, participant.study_id).definition
    return db.look(lambda: surveying(definition, screen))


def surveying(definition: StudyDefinition, screen: Screen | None) -> Errand[Readiness]:
    """Say the same as an errand."""
    fitting = {str(size) for size in fitting_sizes(definition, screen)}
    shares = yield from _sharing(definition)
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
        clips=nearest.clips,
    )


def fitting_sizes(definition: StudyDefinition, screen: Screen | None) -> list[Size]:
    """Return the study's sizes that a screen can show pixel for pixel, largest first."""
    sizes = sorted(definition.sizes, key=lambda size: size.width * size.height, reverse=True)
    if screen is None:
        return sizes
    return [size for size in sizes if size.width <= screen[0] and size.height <= screen[1]]


def ready_arms(definition: StudyDefinition) -> Errand[list[Arm]]:
    """Return the arms all of whose clips are rendered."""
    shares = yield from _sharing(definition)
    return [arm for arm, share in shares.items() if share.left == 0]


def _sharing(definition: StudyDefinition) -> Errand[dict[Arm, _Share]]:
    """Return for every arm how far its clips are; only a finished clip counts as whole."""
    rows = yield _JOBS, {}
    states = {row.clip_id: (row.state, row.progress) for row in rows}
    shares = {}
    for arm in all_arms(definition):
        files = clip_files(definition, arm)
        mine = [states.get(clip_id, ("", 0.0)) for clip_id in files]
        whole = [1.0 if state == DONE else min(share, 0.99) for state, share in mine]
        shares[arm] = _Share(
            progress=sum(whole) / len(whole),
            left=sum(share < 1.0 for share in whole),
            failed=sum(state == FAILED for state, _ in mine),
            clips=files,
        )
    return shares


def clip_files(definition: StudyDefinition, arm: Arm) -> frozenset[str]:
    """Return the ids of the files that an arm needs."""
    names = definition.file_names(read_size(arm.size), arm.orbit_direction)
    return frozenset(names[clip.id] for clip in clips_of_arm(definition, arm))
