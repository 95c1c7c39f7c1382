"""What counts as no loss, and whether that was said before there were data.

A study file declares it under ``[decision]``; an export carries it in ``codebook.json``. Knows
neither files nor models.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, Final

import numpy as np

DECLARED, AT_ANALYSIS = "declared before data", "set at analysis"
# What the study file, the codebook and the command line call each value.
KEYS: Final[Mapping[str, str]] = {
    "realism_margin": "realism_points",
    "noticed_margin": "noticed_share",
    "confidence": "confidence",
    "sequence": "sequence",
}
_RANGES: Final = (
    ("realism_points", 0.0, np.inf),
    ("noticed_share", 0.0, 1.0),
    ("confidence", 0.5, 1.0),
)


@dataclass(frozen=True)
class Margins:
    """What counts as no loss; set them before there are data.

    ``realism_points`` on the rating scale; ``noticed_share`` of people beyond false alarms;
    ``confidence`` one-sided. ``sequence`` names the LoDs from the best one down to the cheapest, in
    the order in which they are tested; empty, their ranks order them. ``declared`` names the values
    that the study declared before anybody took part.
    """

    realism_points: float = 0.5
    noticed_share: float = 0.25
    confidence: float = 0.95
    sequence: tuple[str, ...] = ()
    declared: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name, low, high in _RANGES:
            if not low < getattr(self, name) < high:
                key = next(key for key, own in KEYS.items() if own == name)
                found, most = getattr(self, name), "" if high == np.inf else f" and below {high:g}"
                raise ValueError(f"{key}: found {found:g}; accepted: above {low:g}{most}")

    def check(self, scale: tuple[int, int]) -> None:
        """Raise ValueError if no rating could be as far below another as the margin of realism."""
        low, high = scale
        if self.realism_points >= high - low:
            raise ValueError(
                f"realism_margin: found {self.realism_points:g}; accepted: above 0 and below "
                f"{high - low}, as ratings go from {low} to {high}"
            )

    def origin(self, name: str) -> str:
        """Return where a value comes from: ``DECLARED`` or ``AT_ANALYSIS``."""
        return DECLARED if name in self.declared else AT_ANALYSIS

    @property
    def origins(self) -> str:
        """Where the values come from, in words: one of the two, or which were set when."""
        names = {own: key for key, own in KEYS.items()}
        own = [f.name for f in fields(self) if f.name in names and f.name != "sequence"]
        later = [names[name].replace("_", " ") for name in own if name not in self.declared]
        if not later:
            return DECLARED
        return AT_ANALYSIS if len(later) == len(own) else f"{', '.join(later)} {AT_ANALYSIS}"

    def order(self, ranks: Mapping[str, float]) -> Mapping[str, float]:
        """Return what orders the LoDs, the best highest: the sequence, else their ``ranks``."""
        return {lod: float(i) for i, lod in enumerate(reversed(self.sequence))} or ranks

    def changed(self, **values: float | None) -> Margins:
        """Copy them with other values, which are then no longer declared; None leaves one as is.

        A value that equals the declared one stays declared.
        """
        new: dict[str, Any] = {
            k: v for k, v in values.items() if v is not None and v != getattr(self, k)
        }
        return replace(self, declared=tuple(n for n in self.declared if n not in new), **new)


DEFAULT: Final = Margins()


def declared_margins(codebook: Mapping[str, Any]) -> Margins:
    """Return the margins that a codebook carries, ``DEFAULT`` where it carries none.

    Raises ValueError, TypeError or AttributeError for what is no such table.
    """
    found = codebook.get("decision") or {}
    values = {KEYS[key]: value for key, value in found.items() if key in KEYS}
    values["sequence"] = tuple(map(str, values.get("sequence") or ()))
    for name, _, _ in _RANGES:
        if name in values:
            values[name] = float(values[name])
    return Margins(**values, declared=tuple(values) if found else ())
