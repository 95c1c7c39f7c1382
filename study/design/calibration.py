"""Calibration: how large the screen's pixels are and how far away the participant sits.

Pure: what a study wants, what a browser reports (settings of the card, presses at the blind spot),
and what follows from it. The geometry is in ``viewing``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from study.design.parts import Flag, Part, Whole
from study.design.viewing import (
    Measured,
    distance_from_blind_spot,
    scale_from_card,
    scale_from_diagonal,
)

PLAUSIBLE_MM_PER_PX: Final = (0.03, 1.5)  # a phone's pixel to a projector's
PLAUSIBLE_DISTANCE_MM: Final = (150.0, 4000.0)
LEAST_REPETITIONS: Final = 3


class Calibration(Part):
    """What is measured: ``distance`` says whether by the blind spot too, ``repetitions`` times."""

    distance: Flag = True
    repetitions: Annotated[Whole, Field(ge=LEAST_REPETITIONS, le=9)] = 5


WhyNot = Literal["no_card", "one_eye", "motion", "too_far", "did_not_work", "rather_not"]
Place = Annotated[float, Field(ge=-20_000, le=20_000)]


class CalibrationReport(BaseModel):
    """What a browser measured. Pixels are device pixels; places count from the screen's middle."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)
    scale_method: Literal["card", "diagonal", "skipped"]
    scale_skipped: WhyNot | None = None
    card_widths_px: Annotated[
        tuple[Annotated[float, Field(ge=20, le=9000)], ...], Field(max_length=6)
    ] = ()
    diagonal_inch: Annotated[float, Field(ge=3, le=200)] | None = None
    distance_method: Literal["blind_spot", "skipped", "not_asked"]
    distance_skipped: WhyNot | None = None
    places_px: Annotated[tuple[tuple[Place, Place], ...], Field(max_length=40)] = ()
    moved: Literal["by_itself", "by_key"] | None = None
    screen_width_px: Annotated[int, Field(ge=1, le=100_000)]
    screen_height_px: Annotated[int, Field(ge=1, le=100_000)]
    pixel_ratio: Annotated[float, Field(gt=0, le=20)]


class CalibrationError(ValueError):
    """Measures that cannot be: ``what`` names them, "scale" or "distance"."""

    def __init__(self, what: Literal["scale", "distance"], found: str) -> None:
        self.what = what
        super().__init__(f"{what}: {found}")


@dataclass(frozen=True)
class Calibrated:
    """What follows from a report; None where it was skipped."""

    mm_per_px: Measured | None
    distance_mm: Measured | None
    repetitions: int = 0
    outliers: int = 0


def calibrated(report: CalibrationReport) -> Calibrated:
    """Work out what a report says; raises CalibrationError for measures that cannot be."""
    mm_per_px = _scale(report)
    if mm_per_px is None or report.distance_method != "blind_spot":
        return Calibrated(mm_per_px, None)
    if len(report.places_px) < LEAST_REPETITIONS:
        raise CalibrationError("distance", f"{len(report.places_px)} repetitions")
    try:
        distance, counts = distance_from_blind_spot(report.places_px, mm_per_px)
    except ValueError as error:
        raise CalibrationError("distance", str(error)) from None
    _check("distance", distance.value, PLAUSIBLE_DISTANCE_MM)
    return Calibrated(mm_per_px, distance, len(counts), counts.count(False))


def calibration_facts(report: CalibrationReport, found: Calibrated) -> dict[str, Any]:
    """Return the columns of the participant's table."""
    scale, distance = found.mm_per_px, found.distance_mm
    skipped = [reason for reason in (report.scale_skipped, report.distance_skipped) if reason]
    return {
        "scale_method": report.scale_method,
        "mm_per_px": scale and round(scale.value, 5),
        "mm_per_px_se": scale and round(scale.se, 5),
        "distance_method": report.distance_method,
        "view_dist_cm": distance and round(distance.value / 10, 2),
        "view_dist_cm_se": distance and round(distance.se / 10, 2),
        "calibration_skipped": " ".join(dict.fromkeys(skipped)) or None,
    }


def _scale(report: CalibrationReport) -> Measured | None:
    if report.scale_method == "card" and report.card_widths_px:
        found = scale_from_card(report.card_widths_px)
    elif report.scale_method == "diagonal" and report.diagonal_inch is not None:
        screen = (report.screen_width_px, report.screen_height_px)
        found = scale_from_diagonal(report.diagonal_inch, screen)
    elif report.scale_method == "skipped":
        return None
    else:
        raise CalibrationError("scale", f"no measure by {report.scale_method}")
    _check("scale", found.value, PLAUSIBLE_MM_PER_PX)
    return found


def _check(
    what: Literal["scale", "distance"], value: float, plausible: tuple[float, float]
) -> None:
    if not plausible[0] <= value <= plausible[1]:
        raise CalibrationError(
            what, f"{value:.3g} mm lies outside {plausible[0]} to {plausible[1]}"
        )


ScreenWidth = tuple[float, float]
"""A screen's width in device pixels as a browser tells it, and its pixel ratio."""


def is_same_screen(before: ScreenWidth, now: ScreenWidth) -> bool:
    """Say whether something was shown on the screen that was measured before.

    Browsers differ in what zooming changes: the width in CSS pixels stays (Chromium, Safari), or
    the product of both does (Firefox). On another screen neither is as it was.
    """
    widths = [(width_px / ratio, width_px) for width_px, ratio in (before, now)]
    return any(abs(a - b) <= 0.01 * a for a, b in zip(*widths, strict=True))
