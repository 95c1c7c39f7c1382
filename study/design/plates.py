"""Colour-vision plates: discs of dots from a seed, each with one digit in another colour.

A plate of kind ``protan``, ``deutan`` or ``tritan`` hides its digit from someone who lacks the
long-, middle- or short-wavelength cones; everybody reads the ``control`` plate. All is generated:
the dots, the digits (``plate_digits``) and the colours (``plate_colours``). A screen is no
calibrated light, so plates show a lack, and never its degree.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt

from study.design.plate_colours import PAINTS, PlateKind, brightnesses, hex_codes, linear_rgb
from study.design.plate_digits import DIGITS, is_on_digit

Dots = npt.NDArray[np.float64]

ORDER: Final[tuple[PlateKind, ...]] = ("protan", "deutan", "tritan", "protan", "deutan")
# Radii of the dots as shares of the disc's, with how many places are tried; small ones fill gaps.
_RADII: Final = ((0.046, 250), (0.036, 700), (0.028, 1500), (0.020, 3500))
_GAP: Final = 0.006
PACKINGS: Final = 3
_DIGIT_SIZE: Final = 0.92  # of the disc
_SIZE: Final = 500  # of the drawing, in its own units
_GROUND: Final = "#e4e4e4"


@dataclass(frozen=True)
class Plate:
    """One plate: what it tests, the digit in it, and the seed of its dots."""

    kind: PlateKind
    digit: int
    seed: int


def plates(seed: int) -> tuple[Plate, ...]:
    """Return a participant's plates in their order: the control first, the others shuffled.

    No digit comes twice. The same seed gives the same plates.
    """
    rng = np.random.default_rng([seed, 0x9147E])
    kinds: list[PlateKind] = ["control", *(ORDER[i] for i in rng.permutation(len(ORDER)))]
    digits = rng.permutation(DIGITS)[: len(kinds)]
    seeds = rng.integers(2**31, size=len(kinds))
    return tuple(
        Plate(kind, int(digit), int(own))
        for kind, digit, own in zip(kinds, digits, seeds, strict=True)
    )


def dots(plate: Plate) -> tuple[Dots, npt.NDArray[np.bool_], npt.NDArray[np.float64]]:
    """Return a plate's dots (n, 3: x, y, radius in the disc's radius), which of them lie on the
    digit, and their colours, (n, 3) linear sRGB.
    """
    rng = np.random.default_rng(plate.seed)
    placed = _turned(_packing(plate.seed % PACKINGS), rng.uniform(0, 2 * np.pi))
    on_digit = is_on_digit(plate.digit, placed[:, :2] / _DIGIT_SIZE)
    colours = np.empty((len(placed), 3))
    for paint, chosen in zip(PAINTS[plate.kind], (~on_digit, on_digit), strict=True):
        colours[chosen] = linear_rgb(paint, brightnesses(paint, int(chosen.sum()), rng))
    return placed, on_digit, colours


def _turned(placed: Dots, angle: float) -> Dots:
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return np.column_stack([placed[:, :2] @ turn, placed[:, 2]])


@lru_cache(maxsize=PACKINGS)
def _packing(number: int) -> Dots:
    """Place dots at random so that none touches another, from the large to the small.

    It takes a moment, so plates share a few packings, each turned its own way.
    """
    rng = np.random.default_rng(number)
    placed = np.empty((0, 3))
    for radius, tries in _RADII:
        reach = (1.0 - radius) * np.sqrt(rng.uniform(size=tries))
        turn = rng.uniform(0, 2 * np.pi, tries)
        for x, y in zip(reach * np.cos(turn), reach * np.sin(turn), strict=True):
            gaps = np.hypot(placed[:, 0] - x, placed[:, 1] - y) - placed[:, 2] - radius
            if not gaps.size or gaps.min() >= _GAP:
                placed = np.vstack([placed, (x, y, radius)])
    return placed


@lru_cache(maxsize=256)
def plate_svg(plate: Plate) -> str:
    """Draw a plate as an SVG picture; nothing in it names the digit or the kind."""
    placed, _, colours = dots(plate)
    half = _SIZE / 2
    scale = 0.97 * half
    circles = "".join(
        f'<circle cx="{half + scale * x:.1f}" cy="{half + scale * y:.1f}" '
        f'r="{scale * radius:.1f}" fill="{code}"/>'
        for (x, y, radius), code in zip(placed, hex_codes(colours), strict=True)
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_SIZE} {_SIZE}">'
        f'<circle cx="{half}" cy="{half}" r="{half}" fill="{_GROUND}"/>{circles}</svg>'
    )
