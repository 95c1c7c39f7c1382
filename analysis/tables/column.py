"""One column of a table: name, kind, unit, meaning and accepted values. Imports nothing of ours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

Accepted = Sequence[str] | tuple[float, float]
"""Either the values that a column may hold, or its lowest and highest number."""


@dataclass(frozen=True)
class Column:
    """One column: what it is called, what stands in it and what that means.

    ``kind`` is text, category, integer, number, boolean (true, false) or time (ISO 8601 with
    offset). ``choices`` are the accepted values of a category; ``low`` and ``high`` bound a number.
    ``required`` means that somebody else's table must bring it, not that a cell may not be empty.
    """

    name: str
    kind: str
    meaning: str
    unit: str = ""
    choices: tuple[str, ...] = ()
    low: float | None = None
    high: float | None = None
    required: bool = False
    may_be_empty: bool = True

    def accepting(self, accepted: Accepted) -> Column:
        """Copy this column with a study's own choices or its own lowest and highest number."""
        if self.kind in ("integer", "number"):
            low, high = accepted
            return replace(self, low=float(low), high=float(high))
        return replace(self, kind="category", choices=tuple(map(str, accepted)))

    def to_dict(self) -> dict[str, Any]:
        """Return this column's entry in ``codebook.json``."""
        entry: dict[str, Any] = {"name": self.name, "type": self.kind}
        if self.unit:
            entry["unit"] = self.unit
        entry["meaning"] = self.meaning
        if self.choices:
            entry["accepted"] = list(self.choices)
        if self.low is not None or self.high is not None:
            entry["accepted"] = {"lowest": self.low, "highest": self.high}
        return entry
