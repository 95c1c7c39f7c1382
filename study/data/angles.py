"""How large a trial's irises were at the participant's eye, from calibration and plays.

Pure: plain values in, plain values out. Missing is None: without a calibration, on another screen
than was measured, or where no browser told how large the clip was shown.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from study.data.devices import plausible
from study.design.calibration import is_same_screen
from study.design.viewing import Measured, angle_deg, scale_shown

Payload = Mapping[str, Any]


def shown(plays: Sequence[Payload], *, width_px: int) -> dict[str, float | None]:
    """Return ``shown_scale`` and its standard error from a trial's plays of clips so wide."""
    found = _scale(plays, width_px)
    return {
        "shown_scale": None if found is None else found.value,
        "shown_scale_se": None if found is None else round(found.se, 6),
    }


def iris_angle(
    plays: Sequence[Payload], calibration: Payload | None, *, iris_px: float, width_px: int
) -> dict[str, float | None]:
    """Return ``iris_deg`` and its standard error of one eye in one trial.

    ``calibration`` holds report and facts of the check of that name, or is None.
    """
    scale = _scale(plays, width_px)
    facts = {} if calibration is None else calibration["facts"]
    mm_per_px = _measured(facts, "mm_per_px", unit=1.0)
    distance_mm = _measured(facts, "view_dist_cm", unit=10.0)
    if calibration is None or scale is None or mm_per_px is None or distance_mm is None:
        return {"iris_deg": None, "iris_deg_se": None}
    if not _on(calibration, plays[-1]):
        return {"iris_deg": None, "iris_deg_se": None}
    angle = angle_deg(iris_px, shown_scale=scale, mm_per_px=mm_per_px, distance_mm=distance_mm)
    return {"iris_deg": round(angle.value, 4), "iris_deg_se": round(angle.se, 4)}


def _measured(facts: Payload, name: str, *, unit: float) -> Measured | None:
    value, se = plausible(facts.get(name)), plausible(facts.get(f"{name}_se"))
    return None if not value or se is None else Measured(unit * value, unit * se)


def _scale(plays: Sequence[Payload], width_px: int) -> Measured | None:
    scales = [s for play in plays if (s := plausible(play.get("shown_scale"))) is not None]
    return scale_shown(scales, width_px=width_px)


def _on(calibration: Payload, play: Payload) -> bool:
    """Say whether a play was on the screen that was measured; True where it does not tell."""
    report = calibration["report"]
    width_px = plausible(play.get("screen_width_px"))
    ratio = plausible(play.get("device_pixel_ratio"))
    if not width_px or not ratio:
        return True
    return is_same_screen((report["screen_width_px"], report["pixel_ratio"]), (width_px, ratio))
