"""Colours of colour-vision plates: two that differ for one cone alone, at brightnesses that match.

Someone who lacks that cone sees digit and ground in one colour and at the same range of
brightness; everybody else sees two colours. Cone excitations of a display with BT.709 primaries
are those of Viénot, Brettel & Mollon 1999, "Digital video colourmaps for checking the legibility
of displays by dichromats", eq. 1 (Smith and Pokorny's fundamentals).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import numpy.typing as npt

PlateKind = Literal["control", "protan", "deutan", "tritan"]
Colours = npt.NDArray[np.float64]

CONES_OF_RGB: Final = np.array(
    [
        [17.8824, 43.5161, 4.11935],
        [3.45565, 27.1554, 3.86714],
        [0.0299566, 0.184309, 1.46709],
    ]
)
_RGB_OF_CONES: Final = np.linalg.inv(CONES_OF_RGB)
_WHITE: Final = CONES_OF_RGB @ np.ones(3)


@dataclass(frozen=True)
class Paint:
    """Cone excitations (L, M, S) as multiples of white's, and the range of brightness."""

    cones: tuple[float, float, float]
    darkest: float
    brightest: float


_MIDDLE: Final = (0.13, 0.29)  # the brightest at which both colours still fit into sRGB
# Ground, then digit. The factors of the cone that is tested are as far apart as sRGB allows without
# a colour that would glare; S is a little low, because greens and reds then are less pale.
PAINTS: Final[dict[PlateKind, tuple[Paint, Paint]]] = {
    "control": (Paint((1.0, 1.0, 1.25), 0.05, 0.11), Paint((1.03, 0.98, 0.5), 0.42, 0.66)),
    "protan": (Paint((0.84, 1.0, 0.8), *_MIDDLE), Paint((1.45, 1.0, 0.8), *_MIDDLE)),
    "deutan": (Paint((1.0, 1.18, 0.8), *_MIDDLE), Paint((1.0, 0.70, 0.8), *_MIDDLE)),
    "tritan": (Paint((1.0, 1.0, 0.35), *_MIDDLE), Paint((1.0, 1.0, 1.7), *_MIDDLE)),
}


def linear_rgb(paint: Paint, brightness: npt.NDArray[np.float64]) -> Colours:
    """Return the colours of a paint at some brightnesses, (n, 3) in linear sRGB from 0 to 1.

    Raises ValueError for one that a screen cannot show.
    """
    cones = brightness[:, None] * (_WHITE * np.array(paint.cones))
    rgb = cones @ _RGB_OF_CONES.T
    if rgb.size and not (rgb.min() >= 0 and rgb.max() <= 1):
        raise ValueError(f"{paint}: no colour of sRGB ({rgb.min():.3f} to {rgb.max():.3f})")
    return np.asarray(rgb)


def brightnesses(paint: Paint, count: int, rng: np.random.Generator) -> npt.NDArray[np.float64]:
    """Draw brightnesses of a paint's dots, (count,), even in steps as the eye sees them."""
    return np.exp(rng.uniform(np.log(paint.darkest), np.log(paint.brightest), count))


def hex_codes(rgb: Colours) -> list[str]:
    """Write linear sRGB as ``#rrggbb`` (IEC 61966-2-1's transfer function)."""
    coded = np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055)
    bytes_ = np.rint(255 * coded).astype(int)
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in bytes_]
