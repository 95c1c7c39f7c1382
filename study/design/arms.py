"""Arms, and who takes which: always a least filled one, and of those the one most needed.

Pure. Counts are completed participants plus live leases; who left without completing leaves a
deficit, and the next to come fill it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from study.design.definition import StudyDefinition
from study.design.pairings import Clip, Condition
from study.design.per_person import Block


@dataclass(frozen=True, order=True)
class Arm:
    """One arm: picture size, the way the camera turns, and which block of clips is shown.

    ``block`` counts from 1; None where everybody sees every clip.
    """

    size: str
    orbit_direction: str
    block: int | None = None

    def __str__(self) -> str:
        words = f"{self.size} {self.orbit_direction}"
        return words if self.block is None else f"{words} block {self.block}"


def all_arms(definition: StudyDefinition) -> tuple[Arm, ...]:
    """Return every arm of a study in rendering order."""
    directions, numbers = definition.orbit.directions, block_numbers(definition)
    return tuple(
        Arm(str(size), directions[(number + lap) % len(directions)], block)
        for size in definition.sizes
        for lap in range(len(directions))
        for number, block in enumerate(numbers)
    )


def block_numbers(definition: StudyDefinition) -> tuple[int | None, ...]:
    """Return the blocks' numbers from 1; None alone where everybody sees every clip."""
    if definition.per_person is None:
        return (None,)
    return tuple(range(1, len(definition.blocks) + 1))


def clips_of_arm(definition: StudyDefinition, arm: Arm) -> tuple[Clip, ...]:
    """Return every clip that somebody in an arm sees."""
    block = definition.blocks[(arm.block or 1) - 1]
    return (*definition.practice, *block, *definition.gold)


def assign_arm(
    counts: Mapping[Arm, int],
    available: Sequence[Arm],
    rng: np.random.Generator,
    *,
    blocks: Sequence[Block] = ((),),
) -> Arm:
    """Pick a least filled one of the available arms.

    Of several equally filled ones the one whose direction and block are seen least over all sizes,
    then the one that brings the pairings' exposures closest together; ``rng`` decides what is left.
    An arm that ``counts`` does not hold is empty. Raises ValueError when no arm is available.
    """
    if not available:
        raise ValueError("no arm is available; wait until the clips of one arm are rendered")
    need = _Need(counts, blocks)
    ranked = {arm: (counts.get(arm, 0), *need.rank(arm)) for arm in set(available)}
    best = min(ranked.values())
    equal = sorted(arm for arm, rank in ranked.items() if rank == best)
    return equal[int(rng.integers(len(equal)))]


class _Need:
    """How badly each arm is needed, from what everybody in any arm has seen or is seeing."""

    def __init__(self, counts: Mapping[Arm, int], blocks: Sequence[Block]) -> None:
        self.blocks = blocks
        self.cells: Counter[tuple[str, int | None]] = Counter()
        self.directions: Counter[str] = Counter()
        self.conditions: Counter[Condition] = Counter()
        self.clips: Counter[str] = Counter()
        for arm, count in counts.items():
            self.cells[arm.orbit_direction, arm.block] += count
            self.directions[arm.orbit_direction] += count
            for clip in self._block(arm):
                self.conditions[clip.condition] += count
                self.clips[clip.id] += count

    def _block(self, arm: Arm) -> Block:
        return self.blocks[(arm.block or 1) - 1]

    def rank(self, arm: Arm) -> tuple[int, ...]:
        """Return numbers that are lowest, the first first, for the arm needed most.

        The exposures' sum of squares is least where all are equal; one more adds 2 n + 1 to it.
        """
        block = self._block(arm)
        return (
            self.cells[arm.orbit_direction, arm.block],
            self.directions[arm.orbit_direction],
            sum(2 * self.conditions[clip.condition] + 1 for clip in block),
            sum(2 * self.clips[clip.id] + 1 for clip in block),
        )


def assign_row(
    counts: Mapping[tuple[Arm, int], int], arm: Arm, rows: int, rng: np.random.Generator
) -> int | None:
    """Pick a least used row of the orders, from 1; None where a study has none.

    ``counts`` says how many people of an arm have which row. Of rows that are used equally often
    the one used least with this direction and block; ``rng`` decides what is left.
    """
    if not rows:
        return None
    used: Counter[int] = Counter()
    alike: Counter[int] = Counter()
    for (other, row), count in counts.items():
        used[row] += count
        if (other.orbit_direction, other.block) == (arm.orbit_direction, arm.block):
            alike[row] += count
    ranked = [(used[row], alike[row]) for row in range(1, rows + 1)]
    equal = [row for row, rank in enumerate(ranked, start=1) if rank == min(ranked)]
    return equal[int(rng.integers(len(equal)))]
