"""Why a photograph is refused: one line that says what was found and what is accepted."""

from __future__ import annotations


class PhotographError(ValueError):
    """A photograph that no iris can be taken from; the message says why and what would do."""
