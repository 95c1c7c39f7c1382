"""Eyesight: Landolt rings and colour-vision plates; what a browser reports and what it says.

Pure. No medical test: a screen shows no gap below two of its pixels, and its light is not
calibrated. People agree to it separately, for these are data about health.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from study.design.parts import Flag, Part, Whole
from study.design.plates import Plate
from study.design.viewing import arc_minutes

LEAST_GAP_PX: Final = 2  # less is the screen's business, not the eye's
NEEDED: Final = 3
"""A gap is seen when three rings in a row were told, with at most one mistake among them."""


class Eyesight(Part):
    """What is tested: rings with their gap in 8 or 4 directions, colour-vision plates."""

    rings: Flag = True
    directions: Annotated[Whole, Field(ge=4, le=8, multiple_of=4)] = 8
    plates: Flag = True


Direction = Annotated[int, Field(ge=0, le=7)]
Digit = Annotated[int, Field(ge=0, le=9)]


class Ring(BaseModel):
    """One ring: its gap in device pixels, where it was (eighths of a turn), and what was said."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    gap_px: Annotated[int, Field(ge=1, le=400)]
    shown: Direction
    said: Direction | None

    @property
    def is_right(self) -> bool:
        """True if the gap was told."""
        return self.shown == self.said


class EyesightReport(BaseModel):
    """What a browser reports; ``digits`` were read off the plates in order, None is nothing."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    rings: Annotated[tuple[Ring, ...], Field(max_length=120)] = ()
    rings_skipped: bool = False
    digits: Annotated[tuple[Digit | None, ...], Field(max_length=12)] = ()
    plates_skipped: bool = False
    glasses: Literal["none", "worn", "not_worn"] | None = None


def smallest_gap_px(rings: Sequence[Ring]) -> int | None:
    """Return the smallest gap that was told, or None if none was."""
    by_gap: dict[int, list[bool]] = defaultdict(list)
    for ring in rings:
        by_gap[ring.gap_px].append(ring.is_right)
    seen = [
        gap
        for gap, answers in by_gap.items()
        if sum(answers) >= NEEDED and answers.count(False) <= 1
    ]
    return min(seen, default=None)


def eyesight_facts(
    report: EyesightReport, plates: Sequence[Plate], *, calibration: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the columns of the participant's table.

    ``calibration`` holds the facts of that check, or nothing: then there are no angles.
    """
    gap_px = smallest_gap_px(report.rings)
    found: dict[str, Any] = {
        "eyesight_test": "taken",
        "glasses": report.glasses,
        "smallest_gap_px": gap_px,
    }
    mm_per_px, distance_cm = calibration.get("mm_per_px"), calibration.get("view_dist_cm")
    if mm_per_px is not None and distance_cm is not None and report.rings:

        def arcmin(size_px: float) -> float:
            return round(arc_minutes(size_px, mm_per_px=mm_per_px, distance_mm=10 * distance_cm), 2)

        found["smallest_gap_arcmin"] = None if gap_px is None else arcmin(gap_px)
        found["gap_limit_arcmin"] = arcmin(LEAST_GAP_PX)
    if len(report.digits) == len(plates):
        for kind in ("control", "protan", "deutan", "tritan"):
            found[f"{kind}_plates_read"] = sum(
                plate.digit == digit
                for plate, digit in zip(plates, report.digits, strict=True)
                if plate.kind == kind
            )
    return found
