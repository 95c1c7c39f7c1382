"""What one person sees in which order, from the definition, their seed and their places in it.

Pure and re-derivable: the same definition, seed, block and row give the same trials on any machine
for ever, because chance comes from SHA-256 and not from a generator whose stream may change.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from study.design.definition import StudyDefinition
from study.design.latin import Row, williams
from study.design.pairings import Clip
from study.design.per_person import Block


@dataclass(frozen=True)
class ScheduledTrial:
    """One trial: ``position`` counts all of them from 1, ``number`` those of its own kind."""

    position: int
    number: int
    clip: Clip
    is_practice: bool


def schedule(
    definition: StudyDefinition,
    seed: int,
    *,
    block: int | None = None,
    order_row: int | None = None,
) -> tuple[ScheduledTrial, ...]:
    """Return a participant's trials: practice as the file has it, then the clips in their order.

    ``block`` and ``order_row`` count from 1; None where the study has but one, or no such thing.
    """
    practice = [
        ScheduledTrial(number, number, clip, True)
        for number, clip in enumerate(definition.practice, start=1)
    ]
    clips = _with_gold(definition, _ordered(definition, seed, block=block, order_row=order_row))
    return (
        *practice,
        *(
            ScheduledTrial(len(practice) + number, number, clip, False)
            for number, clip in enumerate(clips, start=1)
        ),
    )


def order_rows(definition: StudyDefinition) -> tuple[Row, ...]:
    """Return the orders that people take turns in; none where every order is drawn or the file's.

    A row says which slot of a block comes at which place.
    """
    if definition.order.trials != "balanced":
        return ()
    return williams(len(definition.blocks[0]))


def _ordered(
    definition: StudyDefinition, seed: int, *, block: int | None, order_row: int | None
) -> list[Clip]:
    clips = list(definition.blocks[(block or 1) - 1])
    if definition.order.trials == "random":
        return sorted(clips, key=lambda clip: _lot(seed, clip.id))
    if definition.order.trials == "file":
        return clips if definition.per_person is None else _as_in_file(definition, clips)
    if definition.per_person is not None:
        clips = _slots(clips, seed)
    return [clips[slot] for slot in order_rows(definition)[(order_row or 1) - 1]]


def _as_in_file(definition: StudyDefinition, clips: Sequence[Clip]) -> list[Clip]:
    mine = {clip.id for clip in clips}
    return [clip for clip in definition.trial_clips if clip.id in mine]


def _slots(block: Block | Sequence[Clip], seed: int) -> list[Clip]:
    """Let the clips of a distance (catch clips apart) draw lots for its slots.

    Rows balance the slots, so distances and catch trials; which LoD and iris stands in a slot
    changes from block to block, and by this lot within one.
    """
    lots: dict[tuple[str, bool], Iterator[Clip]] = {}
    for clip in block:
        kind = _kind(clip)
        if kind not in lots:
            alike = [other for other in block if _kind(other) == kind]
            lots[kind] = iter(sorted(alike, key=lambda other: _lot(seed, other.id)))
    return [next(lots[_kind(clip)]) for clip in block]


def _kind(clip: Clip) -> tuple[str, bool]:
    return clip.distance, clip.is_catch


def _with_gold(definition: StudyDefinition, clips: list[Clip]) -> list[Clip]:
    """Put each gold clip where it has as many trials before it as the file says."""
    for gold in sorted(definition.gold, key=lambda gold: gold.after):
        clips.insert(gold.after, gold)
    return clips


def _lot(seed: int, clip_id: str) -> str:
    return hashlib.sha256(f"{seed}/{clip_id}".encode()).hexdigest()
