"""Order codes: one word that gives a participant's trials again, from the study file alone.

``3/17/4611686018427387904`` is block 3, row 17 of the orders and the participant's seed; 0 stands
for a block or row that the study does not have.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from study.design.definition import StudyDefinition
from study.design.schedule import ScheduledTrial, order_rows, schedule


class OrderCodeError(ValueError):
    """A word is no order code of this study."""


@dataclass(frozen=True)
class OrderCode:
    """What a participant's trials follow from."""

    block: int | None
    order_row: int | None
    seed: int

    def __str__(self) -> str:
        return f"{self.block or 0}/{self.order_row or 0}/{self.seed}"


def read_order_code(text: str, definition: StudyDefinition) -> OrderCode:
    """Read an order code of a study; raises OrderCodeError saying what is accepted."""
    match = re.fullmatch(r"(\d{1,6})/(\d{1,6})/(\d{1,20})", text.strip())
    if not match:
        raise OrderCodeError(f'"{text}" is no order code; write block/row/seed, such as 3/17/4611')
    block, row, seed = map(int, match.groups())
    blocks = len(definition.blocks) if definition.per_person else 0
    for noun, found, count in (("block", block, blocks), ("row", row, len(order_rows(definition)))):
        if not min(1, count) <= found <= count:
            accepted = f"has {noun}s 1 to {count}" if count else f"has no {noun}s: write 0"
            raise OrderCodeError(f'"{text}": {noun} {found}; {definition.key} {accepted}')
    return OrderCode(block or None, row or None, seed)


def trials_of_code(definition: StudyDefinition, code: OrderCode) -> tuple[ScheduledTrial, ...]:
    """Return the trials of the participant who has this code."""
    return schedule(definition, code.seed, block=code.block, order_row=code.order_row)
