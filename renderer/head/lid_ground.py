"""A lid's skin as the ground that lashes grow on: places on it, and frames along its rim.

Pure numpy, patch space (see ``lid_fit``) in mm. A place is a fractional column of the patch's ring
and a way in mm beyond the lid's outer edge.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.body.normals import unit
from renderer.head.lid_fit import LidPatch

OWN_SKIN: Final = 0.3  # what the lid's skin says against the globe beneath, about a lash's frame


def rim_step_mm(lid: LidPatch) -> float:
    """Return the mean distance of the rim's points."""
    ring = lid.points_mm[:, lid.rim_row]
    return float(np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1).mean())


def rim_columns(
    lid: LidPatch, place: Floats, *, is_upper: bool, between_mm: tuple[float, float]
) -> Floats:
    """Return fractional columns (n,) at places between the row's ends, 0 (nose) to 1 (temple)."""
    ring = lid.points_mm[:, lid.rim_row]
    on_lid = lid.is_upper > 0.5 if is_upper else lid.is_upper < 0.5
    low, high = between_mm
    allowed = np.flatnonzero(on_lid & (ring[:, 0] > low) & (ring[:, 0] < high))
    first, last = float(allowed[0]), float(allowed[-1])
    # The ring runs from the temple over the upper lid to the nose, and back below.
    return last - place * (last - first) if is_upper else first + place * (last - first)


def frames_at(lid: LidPatch, column: Floats) -> Floats:
    """Return unit frames (n, 3, 3) at fractional columns: temple, outwards, normal."""
    frames, around = rim_frames(lid), len(lid.points_mm)
    base = np.floor(column).astype(int)
    share = (column - base)[:, None, None]
    return unit(frames[base % around] * (1 - share) + frames[(base + 1) % around] * share)


def rim_frames(lid: LidPatch) -> Floats:
    """Return unit frames (around, 3, 3) on the rim: along it to the temple, outwards, normal.

    Outwards is the way over the lid's skin, away from the fissure. The normal is mostly the
    globe's, on which lids slide, turned a little by the lid's own skin; all are smoothed along the
    rim, so that lashes fan evenly over small bumps.
    """
    points, rim = lid.points_mm, lid.rim_row
    forward = np.roll(points[:, rim], -1, axis=0) - np.roll(points[:, rim], 1, axis=0)
    temple = unit(_smoothed(forward * np.where(lid.is_upper > 0.5, -1.0, 1.0)[:, None]))
    skin = np.array([np.interp(1.6, a - a[rim], np.arange(len(a))) for a in lid.across_mm])
    outwards = unit(_smoothed(_at_rows(points, skin) - points[:, rim]))
    globe = unit(points[:, rim])
    own = np.cross(temple, outwards)
    own *= np.sign((own * globe).sum(axis=1, keepdims=True))
    normal = _smoothed(globe + OWN_SKIN * own)
    normal = unit(normal - temple * (normal * temple).sum(axis=1, keepdims=True))
    across = np.cross(normal, temple)
    across *= np.where(lid.is_upper > 0.5, 1.0, -1.0)[:, None]
    return np.stack([temple, across, normal], axis=1)


def skin_facing(lid: LidPatch) -> tuple[Floats, Floats]:
    """Return points (m, 3) of the skin beyond the rim and unit normals out of it."""
    skin = lid.points_mm[:, lid.rim_row + 1 :]
    around = np.roll(skin, -1, axis=0) - np.roll(skin, 1, axis=0)
    facing = unit(np.cross(around, np.gradient(skin, axis=1)) + 1e-12)
    facing *= np.sign((facing * skin).sum())  # one sign for all: the nose's side faces the eye
    return skin.reshape(-1, 3), facing.reshape(-1, 3)


def on_skin(lid: LidPatch, column: Floats, beyond_mm: Floats) -> Floats:
    """Return points of the lid (n, 3) at fractional columns, so far beyond its outer edge."""
    around = len(lid.points_mm)
    base = np.floor(column).astype(int)
    sides = []
    for one in (base % around, (base + 1) % around):
        across = lid.across_mm[one]
        wanted = across[:, lid.rim_row] + beyond_mm
        rows = np.array(
            [
                np.interp(at, line, np.arange(len(line)))
                for at, line in zip(wanted, across, strict=True)
            ]
        )
        sides.append(_at_rows(lid.points_mm[one], rows))
    share = (column - base)[:, None]
    return np.asarray(sides[0] * (1 - share) + sides[1] * share)


def _smoothed(values: Floats) -> Floats:
    """Average (around, 3) along the ring over some 3 mm."""
    for _ in range(12):
        values = (np.roll(values, 1, axis=0) + 2 * values + np.roll(values, -1, axis=0)) / 4
    return values


def _at_rows(points: Floats, rows: Floats) -> Floats:
    """Interpolate a grid (n, along, 3) at one fractional row each."""
    base = np.clip(np.floor(rows).astype(int), 0, points.shape[1] - 2)
    share = (rows - base)[:, None]
    every = np.arange(len(points))
    return np.asarray(points[every, base] * (1 - share) + points[every, base + 1] * share)
