"""Who sees what in which order: trials from a participant's seed, arms from how full they are.

Pure and re-derivable: the same definition and seed give the same order on any machine for ever,
because order comes from SHA-256 and not from a random generator whose stream may change.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from study.design.definition import StudyDefinition
from study.design.pairings import Clip


@dataclass(frozen=True, order=True)
class Arm:
    """One arm of the schedule: the picture size and the way the camera turns."""

    size: str
    orbit_direction: str

    def __str__(self) -> str:
        return f"{self.size} {self.orbit_direction}"


@dataclass(frozen=True)
class ScheduledTrial:
    """One trial: ``position`` counts all of them from 1, ``number`` those of its own kind."""

    position: int
    number: int
    clip: Clip
    is_practice: bool


def schedule(definition: StudyDefinition, seed: int) -> tuple[ScheduledTrial, ...]:
    """Return a participant's trials: practice as the file has it, then the clips in their order."""
    clips = list(definition.trial_clips)
    if definition.order.trials == "random":
        clips.sort(key=lambda clip: _lot(seed, clip.id))
    practice = [
        ScheduledTrial(number, number, clip, True)
        for number, clip in enumerate(definition.practice, start=1)
    ]
    return (
        *practice,
        *(
            ScheduledTrial(len(practice) + number, number, clip, False)
            for number, clip in enumerate(clips, start=1)
        ),
    )


def _lot(seed: int, clip_id: str) -> str:
    return hashlib.sha256(f"{seed}/{clip_id}".encode()).hexdigest()


def all_arms(definition: StudyDefinition) -> tuple[Arm, ...]:
    """Return every arm of a study in rendering order."""
    return tuple(
        Arm(str(size), direction)
        for size in definition.sizes
        for direction in definition.orbit.directions
    )


def assign_arm(
    counts: Mapping[Arm, int], available: Sequence[Arm], rng: np.random.Generator
) -> Arm:
    """Pick the least filled of the available arms; ``rng`` decides between equals.

    ``counts`` is completed participants plus live leases; an arm that it does not hold is empty.
    Raises ValueError when no arm is available.
    """
    if not available:
        raise ValueError("no arm is available; wait until the clips of one arm are rendered")
    fewest = min(counts.get(arm, 0) for arm in available)
    emptiest = sorted(arm for arm in set(available) if counts.get(arm, 0) == fewest)
    return emptiest[int(rng.integers(len(emptiest)))]
