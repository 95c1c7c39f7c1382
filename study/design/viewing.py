"""How large things are at a participant's eye: screen, distance and angles, with uncertainty.

Pure mathematics. Pixels are device pixels; a standard error belongs to every result. What it can
promise is what others measured: the card and the blind spot find the distance to 3.25 cm on average
at 43 to 66 cm (Li et al. 2020, Sci. Rep. 10:904); sizes in degrees found in a browser are off by 10
to 20 % (Brascamp 2021, J. Vis. 21(8):19).
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

CARD_WIDTH_MM: Final = 85.60  # ISO/IEC 7810 ID-1: every bank card
CARD_HEIGHT_MM: Final = 53.98
CARD_SETTING_MM: Final = 0.5  # how well an edge on the glass is set against one below it
INCH_MM: Final = 25.4
DIAGONAL_ERROR: Final = 0.02  # "27 inch" is rounded, and is the panel's size
# Where a dot that moves outwards vanishes, its centre from the fixation mark's (Li et al. 2020).
BLIND_SPOT_DEG: Final = 13.5
# From person to person; as a share of the distance it gives the 3.25 cm of Li et al. at 55 cm:
# the mean error of a normal distribution is 0.8 of its standard deviation.
BLIND_SPOT_ERROR: Final = 0.074
LEFT_EYE_MM: Final = 31.5  # half the distance between two pupils (63 mm on average)
OUTLIER_MADS: Final = 3.0
_MAD_TO_SD: Final = 1.4826


@dataclass(frozen=True)
class Measured:
    """A value with its standard error."""

    value: float
    se: float


def scale_from_card(widths_px: Sequence[float]) -> Measured:
    """Return the millimetres of a pixel from the widths set for a card, each by a new start."""
    width_px = statistics.fmean(widths_px)
    spread_px = statistics.stdev(widths_px) if len(widths_px) > 1 else 0.0
    setting_px = CARD_SETTING_MM * width_px / CARD_WIDTH_MM
    se_px = math.hypot(spread_px, setting_px) / math.sqrt(len(widths_px))
    mm_per_px = CARD_WIDTH_MM / width_px
    return Measured(mm_per_px, mm_per_px * se_px / width_px)


def scale_from_diagonal(diagonal_inch: float, screen_px: tuple[float, float]) -> Measured:
    """Return the millimetres of a pixel from a screen's diagonal as it is sold."""
    mm_per_px = diagonal_inch * INCH_MM / math.hypot(*screen_px)
    return Measured(mm_per_px, DIAGONAL_ERROR * mm_per_px)


def distance_of(fixation_mm: float, dot_mm: float) -> float:
    """Return the distance in mm at which dot and fixation mark lie BLIND_SPOT_DEG apart.

    Places count from the left eye's, along the screen: the mark lies to the right and the dot to
    the left. An eye between the two sees atan(a / d) + atan(b / d), solved here for d.
    """
    apart = fixation_mm - dot_mm
    if not apart > 0:
        raise ValueError(f"the dot lies {-apart:.1f} mm to the right of the fixation mark")
    tangent = math.tan(math.radians(BLIND_SPOT_DEG))
    inside = apart**2 - 4 * tangent**2 * fixation_mm * dot_mm
    if inside < 0:
        raise ValueError("mark and dot lie so far aside that no distance gives their angle")
    return (apart + math.sqrt(inside)) / (2 * tangent)


def robust(values: Sequence[float]) -> tuple[Measured, tuple[bool, ...]]:
    """Return the median of repeated measures, its standard error, and which count.

    A value further from the median than three scaled MADs does not count (nor within 2 % of it is
    any refused: five equal presses have a MAD of nothing).
    """
    middle = statistics.median(values)
    mad = _MAD_TO_SD * statistics.median(abs(value - middle) for value in values)
    limit = max(OUTLIER_MADS * mad, 0.02 * abs(middle))
    counts = tuple(abs(value - middle) <= limit for value in values)
    kept = [value for value, does in zip(values, counts, strict=True) if does]
    # 1.25: the median of normal values scatters so much more than their mean.
    spread = 1.2533 * (statistics.stdev(kept) if len(kept) > 1 else mad) / math.sqrt(len(kept))
    return Measured(statistics.median(kept), spread), counts


def distance_from_blind_spot(
    places_px: Sequence[tuple[float, float]], mm_per_px: Measured
) -> tuple[Measured, tuple[bool, ...]]:
    """Return the viewing distance in mm and which repetitions count.

    ``places_px`` holds, for each, where fixation mark and dot were, counted from the middle of the
    screen to the right: the head is before the middle, the left eye LEFT_EYE_MM beside it.
    """
    distances = [
        distance_of(fixation * mm_per_px.value + LEFT_EYE_MM, dot * mm_per_px.value + LEFT_EYE_MM)
        for fixation, dot in places_px
    ]
    found, counts = robust(distances)
    shares = (found.se / found.value, BLIND_SPOT_ERROR, mm_per_px.se / mm_per_px.value)
    return Measured(found.value, found.value * math.hypot(*shares)), counts


def angle_deg(
    size_px: float, *, shown_scale: Measured, mm_per_px: Measured, distance_mm: Measured
) -> Measured:
    """Return the angle in degrees of something in a clip, ``size_px`` of the clip's pixels wide."""
    size_mm = size_px * shown_scale.value * mm_per_px.value
    angle = 2 * math.atan(size_mm / (2 * distance_mm.value))
    share = math.hypot(
        *(one.se / one.value for one in (shown_scale, mm_per_px, distance_mm) if one.value)
    )
    # The angle grows a little less than the size: d(angle) = sin(angle) * d(size) / size.
    return Measured(math.degrees(angle), math.degrees(math.sin(angle) * share))


def arc_minutes(size_px: float, *, mm_per_px: float, distance_mm: float) -> float:
    """Return the angle in arc minutes of something that is so many device pixels wide."""
    return 60 * math.degrees(2 * math.atan(size_px * mm_per_px / (2 * distance_mm)))


def scale_shown(scales: Sequence[float], *, width_px: int) -> Measured | None:
    """Return the ratio of shown to native pixels over a trial's plays, the last one's value.

    Layout rounds to 1/64 pixel at both edges of a clip ``width_px`` wide; plays at another zoom
    or in another window add what they differ by.
    """
    if not scales:
        return None
    rounding = math.sqrt(2 / 12) / 64 / width_px
    spread = statistics.pstdev(scales) if len(scales) > 1 else 0.0
    return Measured(scales[-1], math.hypot(rounding, spread))
