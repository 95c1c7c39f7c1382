"""How lashes stand on the two lids: numbers of adults, and what chance gives each hair.

All numbers are drawn before a lid is looked at. So when the lid moves, its lashes stay the same
hairs. Knows no geometry but lengths in mm along and beyond the rim.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices


@dataclass(frozen=True)
class LashRow:
    """How the lashes of one lid grow.

    ``along`` holds columns: place from the nose's end (0) to the temple's (1), length in mm, lean
    towards the temple in degrees, how thick the hairs stand. ``curl_deg`` are the angles between
    the lid's normal and the hair at root, middle and tip, positive away from the fissure.
    ``tuft_shares`` are the shares of hairs that stand alone, in twos, in threes and so on, and
    ``tuft_pull`` how far their roots draw together. ``between_mm`` is where along the rim's chord
    lashes begin and end.
    """

    count: int
    is_upper: bool
    along: tuple[tuple[float, float, float, float], ...]
    curl_deg: tuple[float, float, float]
    curl_spread_deg: float
    rows_mm: tuple[float, ...]  # beyond the lid's outer edge
    width_mm: tuple[float, float]
    tuft_shares: tuple[float, ...]
    tuft_pull: float
    new_share: float  # just grown, short and fine
    length_spread: float
    between_mm: tuple[float, float]
    shadow: float


# About 150 upper lashes of 8 to 12 mm and 75 lower ones of 6 to 8 mm, in two or three rows. Upper
# ones leave the skin forwards and down and sweep up, lower ones do so mirrored and less.
UPPER: Final = LashRow(
    count=164,
    is_upper=True,
    along=(
        (0.0, 4.8, -13.0, 0.6),
        (0.15, 7.0, -10.0, 0.9),
        (0.4, 9.2, -1.0, 1.1),
        (0.65, 10.0, 8.0, 1.1),
        (0.85, 9.0, 14.0, 1.0),
        (1.0, 6.6, 18.0, 0.6),
    ),
    curl_deg=(-17.0, 11.0, 50.0),
    curl_spread_deg=10.0,
    rows_mm=(-0.30, 0.0, 0.28, 0.5),
    width_mm=(0.060, 0.096),
    tuft_shares=(0.34, 0.33, 0.23, 0.10),
    tuft_pull=0.3,
    new_share=0.12,
    length_spread=0.12,
    between_mm=(-12.0, 11.6),
    shadow=0.17,
)
LOWER: Final = LashRow(
    count=85,
    is_upper=False,
    along=(
        (0.0, 3.6, -18.0, 0.5),
        (0.2, 5.4, -12.0, 0.9),
        (0.5, 7.0, 2.0, 1.2),
        (0.8, 6.8, 14.0, 0.9),
        (1.0, 4.2, 20.0, 0.35),
    ),
    curl_deg=(-14.0, 26.0, 58.0),
    curl_spread_deg=13.0,
    rows_mm=(-0.22, 0.06, 0.34),
    width_mm=(0.032, 0.056),
    tuft_shares=(0.22, 0.34, 0.28, 0.16),
    tuft_pull=0.5,
    new_share=0.17,
    length_spread=0.15,
    between_mm=(-10.0, 11.3),
    shadow=0.16,
)


@dataclass(frozen=True)
class Growth:
    """What chance gives each hair of a row, in the order of their tufts from the nose."""

    place: Floats  # along the row, 0 to 1
    beyond_mm: Floats  # the outer edge
    length_mm: Floats
    lean_deg: Floats
    sway_deg: Floats  # what the lean gains from root to tip
    curl_deg: Floats  # (n, 3) at root, middle, tip
    width_mm: Floats
    tuft: Indices  # hairs of one number meet at their tips
    pull: Floats  # how close they come, 0 to 1
    tone: Floats


def draw_growth(row: LashRow, rng: np.random.Generator) -> Growth:
    """Draw all random numbers of a row."""
    n = row.count
    knots, length, lean, _ = np.array(row.along).T
    tuft = _tufts(row, rng)
    place = _places(row, tuft, rng)
    is_new = rng.permutation(n) < row.new_share * n
    grown = rng.normal(1.0, row.length_spread, n).clip(0.72, 1.18)
    grown = np.where(is_new, rng.uniform(0.32, 0.65, n), grown)
    # Hairs of a tuft lean alike, neighbouring tufts nearly so; some hairs cross their neighbours.
    strays = np.where(rng.random(n) < 0.10, 12.0, 3.0)
    waves = np.interp(place, np.linspace(0, 1, 23), rng.normal(0, 5.0, 23))
    lean_deg = np.interp(place, knots, lean) + waves
    lean_deg += rng.normal(0, 5.5, n)[tuft] + rng.normal(0, 1, n) * strays
    turn = rng.normal(0, 0.75, n)[tuft] * row.curl_spread_deg + rng.normal(0, 0.6, n) * 6.0
    curl = np.array(row.curl_deg) + turn[:, None] * np.array([0.35, 0.8, 1.3])
    curl[:, 0] += rng.normal(0, 6.0, n)
    return Growth(
        place=place,
        beyond_mm=rng.choice(row.rows_mm, size=n) + rng.normal(0, 0.10, n),
        length_mm=np.interp(place, knots, length) * grown,
        lean_deg=lean_deg,
        sway_deg=0.6 * np.interp(place, knots, lean) + rng.normal(0, 9.0, n),
        curl_deg=curl,
        width_mm=rng.uniform(*row.width_mm, n) * np.where(is_new, 0.6, 1.0),
        tuft=tuft,
        pull=(rng.uniform(0.15, 0.85, n) * (rng.random(n) < 0.8))[tuft],
        tone=rng.uniform(0.65, 1.5, n) * np.where(is_new, 1.4, 1.0),
    )


def _tufts(row: LashRow, rng: np.random.Generator) -> Indices:
    """Return tuft numbers (count,) of hairs in a row."""
    sizes = np.arange(1, len(row.tuft_shares) + 1)
    return np.repeat(np.arange(row.count), rng.choice(sizes, size=row.count, p=row.tuft_shares))[
        : row.count
    ]


def _places(row: LashRow, tuft: Indices, rng: np.random.Generator) -> Floats:
    """Return places along the row (count,), 0 to 1: as dense as it says, and drawn into tufts."""
    knots, _, _, density = np.array(row.along).T
    fine = np.linspace(0, 1, 201)
    share = np.cumsum(np.interp(fine, knots, density))
    even = np.sort((np.arange(row.count) + rng.normal(0.5, 0.75, row.count)) / row.count)
    place = np.interp(even, share / share[-1], fine)
    middle = np.bincount(tuft, place) / np.maximum(np.bincount(tuft), 1)
    return np.asarray(np.clip(place + row.tuft_pull * (middle[tuft] - place), 0.0, 1.0))
