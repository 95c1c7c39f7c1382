"""What simulated participants report of the checks before the clips."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from pydantic import BaseModel

from study.data import before
from study.data.checks import CheckName
from study.data.database import Database
from study.data.participants import Participant
from study.design.calibration import (
    Calibration,
    CalibrationReport,
    calibrated,
    calibration_facts,
)
from study.design.definition import StudyDefinition
from study.design.device_check import DeviceReport, findings
from study.design.device_facts import device_facts
from study.design.eyesight import EyesightReport, eyesight_facts
from study.design.patches import PATCHES, strip_levels
from study.design.plates import plates
from study.design.viewing import BLIND_SPOT_DEG, CARD_WIDTH_MM, LEFT_EYE_MM

DISTANCE_MM: Final = (620.0, 70.0)  # of people at desks, mean and standard deviation
MM_PER_PX: Final = (0.26, 0.02)
PRESS_MM: Final = 2.0
GAPS_PX: Final = (20, 16, 13, 10, 8, 6, 5, 4, 3, 2, 2, 2)


def squares_of(seed: int) -> tuple[int, int]:
    """Return how many squares the dark and the light strip of a participant have."""
    return len(strip_levels(seed, "dark")), len(strip_levels(seed, "light"))


def device_report(definition: StudyDefinition, squares: tuple[int, int]) -> dict[str, Any]:
    """Report a screen on which the largest clips fit and every square is seen."""
    largest = max(definition.sizes, key=lambda size: size.width)
    return {
        "screen_width_px": largest.width,
        "screen_height_px": largest.height,
        "window_width_px": largest.width,
        "window_height_px": largest.height,
        "pixel_ratio": 1.0,
        "zoom": 1.0,
        "refresh_hz": 60.0,
        "refresh_jitter_ms": 0.2,
        "colour_depth": 24,
        "dynamic_range": "standard",
        "codec": "avc1.64000c",
        "is_smooth": True,
        "patches": [list(patch) for patch in PATCHES],
        "mbit_s": 50.0,
        "dark_counted": squares[0],
        "light_counted": squares[1],
        "night_light": "off",
        "hdr": "off",
    }


def calibration_report(definition: StudyDefinition, rng: np.random.Generator) -> dict[str, Any]:
    """Report a card and presses at the blind spot of somebody at a desk."""
    wanted = definition.calibration or Calibration()
    largest = max(definition.sizes, key=lambda size: size.width)
    mm_per_px = max(0.1, rng.normal(*MM_PER_PX))
    distance_mm = max(300.0, rng.normal(*DISTANCE_MM))
    mark_mm = distance_mm * math.tan(math.radians(BLIND_SPOT_DEG / 2))
    eye_deg = math.degrees(math.atan2(mark_mm + LEFT_EYE_MM, distance_mm))
    dot_mm = distance_mm * math.tan(math.radians(eye_deg - BLIND_SPOT_DEG)) - LEFT_EYE_MM
    presses_mm = rng.normal(dot_mm, PRESS_MM, wanted.repetitions)
    return {
        "scale_method": "card",
        "card_widths_px": [CARD_WIDTH_MM / mm_per_px * share for share in (0.998, 1.002)],
        "distance_method": "blind_spot" if wanted.distance else "not_asked",
        "places_px": [[mark_mm / mm_per_px, press / mm_per_px] for press in presses_mm]
        if wanted.distance
        else [],
        "moved": "by_itself" if wanted.distance else None,
        "screen_width_px": largest.width,
        "screen_height_px": largest.height,
        "pixel_ratio": 1.0,
    }


def eyesight_report(definition: StudyDefinition, digits: Sequence[int] | None) -> dict[str, Any]:
    """Report rings told down to the smallest; ``digits`` are read, or the plates left out."""
    wants: Mapping[str, bool] = (
        {} if definition.eyesight is None else definition.eyesight.model_dump()
    )
    rings = [
        {"gap_px": gap, "shown": 2 * (i % 4), "said": 2 * (i % 4)} for i, gap in enumerate(GAPS_PX)
    ]
    return {
        "rings": rings if wants.get("rings") else [],
        "digits": list(digits or ()),
        "plates_skipped": digits is None and bool(wants.get("plates")),
        "glasses": "none",
    }


def digits_of(definition: StudyDefinition, seed: int) -> list[int]:
    """Return the digits on a participant's plates."""
    has_plates = definition.eyesight is not None and definition.eyesight.plates
    return [plate.digit for plate in plates(seed)] if has_plates else []


def pass_checks(
    db: Database, person: Participant, definition: StudyDefinition, rng: np.random.Generator
) -> None:
    """Store what a simulated participant reports of every check that the study has."""
    calibration: dict[str, Any] = {}
    if definition.device_check is not None:
        device = DeviceReport.model_validate(device_report(definition, squares_of(person.seed)))
        found = findings(definition.device_check, device, sizes=definition.sizes, seed=person.seed)
        facts = device_facts(device, found, seed=person.seed)
        _store(db, person, "device_check", device, facts)
    if definition.calibration is not None:
        measured = CalibrationReport.model_validate(calibration_report(definition, rng))
        calibration = calibration_facts(measured, calibrated(measured))
        _store(db, person, "calibration", measured, calibration)
    if definition.eyesight is not None:
        digits = digits_of(definition, person.seed)
        seen = EyesightReport.model_validate(eyesight_report(definition, digits))
        facts = eyesight_facts(seen, plates(person.seed), calibration=calibration)
        _store(db, person, "eyesight", seen, facts)


def _store(
    db: Database, person: Participant, check: CheckName, report: BaseModel, facts: dict[str, Any]
) -> None:
    kept = report.model_dump(mode="json")
    before.record(db, person, check, key=check, report=kept, facts=facts)
