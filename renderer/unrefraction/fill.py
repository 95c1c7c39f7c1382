"""Fill what a photograph does not show of an iris from what it shows elsewhere.

An iris looks alike all around its pupil, so a hidden part takes the tissue that lies at the same
distance from the pupil, turned or mirrored; its brightness is led over smoothly. Invented, and
marked as such: nothing here recovers what was really there.
"""

from __future__ import annotations

from typing import Final, Literal, TypeVar

import numpy as np
import numpy.typing as npt
from scipy import ndimage

Field = npt.NDArray[np.float32]
Mask = npt.NDArray[np.bool_]
Polar = TypeVar("Polar", Field, Mask)

COLUMNS: Final = 2048  # of the angle
ROWS: Final = 512  # from the pupil to the edge of the map
INNER_MM: Final = 1.7
OUTER_MM: Final = 6.0
TURN_STEPS: Final = 36  # tried turns, each plain and mirrored
RIM_ROWS: Final = 6  # the last 0.05 mm before the veil: not quite clear
FEATHER_MM: Final = 0.3
MODE: Final[tuple[Literal["nearest"], Literal["wrap"]]] = ("nearest", "wrap")
LEVEL_MM: Final = 0.6  # over which brightness is led from the seen to the filled


def fill_hidden(colour: Field, known: Mask, *, radius_mm: Field, angle: Field) -> Field:
    """Return a map's colours (n, n, 3) with what is not ``known`` filled; the pupil stays."""
    rows, columns = _polar_grid(colour.shape[0])
    shown = ndimage.map_coordinates(known.astype(np.float32), [rows, columns], order=1) > 0.99
    logs = np.log(np.maximum(colour, 1e-4))
    polar = np.stack(
        [ndimage.map_coordinates(logs[..., c], [rows, columns], order=1) for c in range(3)], axis=-1
    )
    shown, polar, last_mm = _with_rim(shown, polar)
    known = known & (radius_mm < last_mm)
    filled = _filled(polar, shown)
    at = [
        (radius_mm - INNER_MM) / (OUTER_MM - INNER_MM) * ROWS - 0.5,
        np.mod(angle / (2 * np.pi), 1.0) * COLUMNS,
    ]
    wide = np.concatenate([filled, filled[:, :2]], axis=1)
    back = np.stack(
        [ndimage.map_coordinates(wide[..., c], at, order=1, mode="nearest") for c in range(3)],
        axis=-1,
    )
    texel = 12.0 / colour.shape[0]
    share = np.clip(ndimage.distance_transform_edt(known) * texel / FEATHER_MM, 0, 1)[..., None]
    inside = (radius_mm > INNER_MM + 0.05)[..., None]
    mixed = np.exp(share * logs + (1 - share) * back)
    return np.asarray(np.where(inside, mixed, colour), np.float32)


def _polar_grid(size_px: int) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    r = INNER_MM + (np.arange(ROWS) + 0.5) / ROWS * (OUTER_MM - INNER_MM)
    angle = np.arange(COLUMNS) / COLUMNS * 2 * np.pi
    scale = size_px / 12.0
    x = (np.outer(r, np.cos(angle)) + 6.0) * scale - 0.5
    y = (np.outer(r, np.sin(angle)) + 6.0) * scale - 0.5
    return y, x


def _with_rim(shown: Mask, polar: Field) -> tuple[Mask, Field, float]:
    """Continue the outermost rows that the limbus veils nearly everywhere: mirrored, darker.

    Behind the limbus the iris darkens to its root, in every eye. Also return where that begins.
    """
    outwards = shown.sum(axis=1) / max(1, int(shown.sum(axis=1).max()))
    last = int(np.max(np.nonzero(outwards > 0.6)[0], initial=1)) - RIM_ROWS
    last_mm = INNER_MM + (last + 1) / ROWS * (OUTER_MM - INNER_MM)
    rows = np.arange(last + 1, ROWS)
    mirror = np.maximum(2 * last - rows, 0)
    darker = -1.6 * np.minimum((rows - last) / ROWS * (OUTER_MM - INNER_MM) / 0.5, 1.0)
    shown, polar = shown.copy(), polar.copy()
    shown[rows] = shown[mirror]
    polar[rows] = polar[mirror] + darker[:, None, None].astype(np.float32)
    return shown, polar, last_mm


def _filled(polar: Field, shown: Mask) -> Field:
    """Fill each connected hidden part from the turn that shows the most of it."""
    filled, known = polar.copy(), shown.copy()
    for _ in range(3):
        if known.all():
            return filled
        turn, is_mirrored = _best_turn(polar, shown, ~known)
        source = _turned(polar, turn, is_mirrored)
        source_shown = _turned(shown, turn, is_mirrored)
        new = ~known & source_shown
        filled[new] = (source + _level(polar - source, shown & source_shown))[new]
        known |= new
    # What no turn shows: the ring's own colour.
    rings = np.array([_ring_mean(row, seen) for row, seen in zip(polar, shown, strict=True)])
    missing = ~np.isfinite(rings[:, 0])
    for channel in range(3):
        at = np.arange(ROWS)
        rings[missing, channel] = np.interp(at[missing], at[~missing], rings[~missing, channel])
    return np.where(known[..., None], filled, rings[:, None, :]).astype(np.float32)


def _ring_mean(row: Field, seen: Mask) -> Field:
    return row[seen].mean(axis=0) if seen.any() else np.full(3, np.nan, np.float32)


def _turned(polar: Polar, turn: int, is_mirrored: bool) -> Polar:
    return np.roll(polar[:, ::-1] if is_mirrored else polar, turn, axis=1)


def _best_turn(polar: Field, shown: Mask, wanted: Mask) -> tuple[int, bool]:
    """Return the turn, in columns, whose tissue covers most of what is wanted and differs least."""
    sparse = (slice(None, None, 4), slice(None, None, 8))
    light = ndimage.gaussian_filter(polar.mean(axis=-1), (6, 20), mode=MODE)
    best, found = -np.inf, (COLUMNS // 2, False)
    for is_mirrored in (True, False):
        for step in range(TURN_STEPS):
            turn = step * COLUMNS // TURN_STEPS
            source_shown = _turned(shown, turn, is_mirrored)[sparse]
            covered = float(np.mean(source_shown[wanted[sparse]])) if wanted[sparse].any() else 0.0
            both = source_shown & shown[sparse]
            apart = np.abs(light - _turned(light, turn, is_mirrored))[sparse]
            score = covered - 0.3 * (float(apart[both].mean()) if both.any() else 1.0)
            if score > best:
                best, found = score, (turn, is_mirrored)
    return found


def _level(difference: Field, both: Mask) -> Field:
    """Return a smooth field that leads from one brightness to the other across the border."""
    rows_sigma = LEVEL_MM / (OUTER_MM - INNER_MM) * ROWS / 2
    sigma = (rows_sigma / 4, COLUMNS * LEVEL_MM / (2 * np.pi * 4.0) / 2 / 4)
    small = (slice(None, None, 4), slice(None, None, 4))
    weight = both[small].astype(np.float32)
    spread = ndimage.gaussian_filter(weight, sigma, mode=MODE) + 1e-4
    parts = [
        ndimage.gaussian_filter(weight * difference[small][..., c], sigma, mode=MODE) / spread
        for c in range(3)
    ]
    coarse = np.clip(np.stack(parts, axis=-1), -0.8, 0.8)
    return np.repeat(np.repeat(coarse, 4, axis=0), 4, axis=1).astype(np.float32)
