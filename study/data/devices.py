"""What a browser says about screen and itself: kept if plausible, as the tables need it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

MAX_FACTS: Final = 40
MAX_TEXT_CHARS: Final = 300
_GREATEST: Final = {"screen_width": 100_000, "screen_height": 100_000, "pixel_ratio": 100}
COLUMNS: Final = ("screen_width", "screen_height", "pixel_ratio", "user_agent_family")


def read_device(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the facts that can be stored: plain values, and the tables' numbers within reason.

    ``screen_width`` and ``screen_height`` are in CSS pixels, ``pixel_ratio`` in device pixels per
    CSS pixel. What makes no sense is left out: a browser may say anything.
    """
    facts: dict[str, Any] = {}
    for name, value in list(given.items())[:MAX_FACTS]:
        kept = _fact(str(name), value)
        if kept is not None:
            facts[str(name)[:MAX_TEXT_CHARS]] = kept
    return facts


def _fact(name: str, value: Any) -> Any:
    if name in _GREATEST:
        number = plausible(value, greatest=_GREATEST[name])
        return number if number is None or name == "pixel_ratio" else round(number)
    if isinstance(value, str):
        text = value.replace("\x00", "").encode("utf-8", "replace").decode("utf-8")
        return text[:MAX_TEXT_CHARS] or None
    if isinstance(value, bool) or plausible(value) is not None:
        return value
    return None


def plausible(value: Any, *, greatest: float = 1e9) -> float | None:
    """Return a finite number from 0 to ``greatest``, or None for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return value if math.isfinite(value) and 0 <= value <= greatest else None
