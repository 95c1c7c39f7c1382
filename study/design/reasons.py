"""Why an answer cannot be stored: the key of a sentence and what to put into its places.

The sentence itself is the catalogue's, in the participant's language (``study/texts``).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from study.texts import catalogue


@dataclass(frozen=True)
class Reason:
    """One reason; as text it is the English sentence, for researchers and logs."""

    key: str
    values: Mapping[str, object] = field(default_factory=dict)

    def __str__(self) -> str:
        return catalogue("en").text(self.key, **self.values)


class UnfitError(ValueError):
    """One answer does not fit its question."""

    def __init__(self, reason: Reason) -> None:
        self.reason = reason
        super().__init__(str(reason))
