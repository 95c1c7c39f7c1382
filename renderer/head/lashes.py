"""Eyelashes and eyebrows, hair by hair, grown on the fitted lids and the brow ridge. Pure numpy.

Patch space (see ``lid_fit``) while growing; ``grow_face_hair`` returns world space in mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.head.lid_fit import LidPatch, Socket

UPPER_COUNT: Final = 165  # adults: about 150 upper, 75 lower lashes in two or three rows
LOWER_COUNT: Final = 80
BROW_COUNT: Final = 680
LASH_POINTS: Final = 8
BROW_POINTS: Final = 5
LASH_COLOUR: Final = (0.052, 0.030, 0.019)
BROW_COLOUR: Final = (0.030, 0.018, 0.011)
# The brow's middle line from nose to temple: x, y, half width in mm, direction of growth in degrees
# above the way to the temple.
BROW: Final = np.array(
    [
        (-17.5, 18.6, 2.6, 78.0),
        (-12.0, 19.9, 3.7, 58.0),
        (-4.0, 21.6, 3.5, 36.0),
        (5.0, 23.4, 3.0, 18.0),
        (12.0, 23.9, 2.4, -4.0),
        (19.0, 22.0, 1.6, -24.0),
        (26.0, 18.4, 0.7, -36.0),
    ]
)


@dataclass(frozen=True)
class Strands:
    """Hairs: points (n, k, 3) in mm, width at the root (n,) in mm, linear colour (n, 3)."""

    points_mm: Floats
    width_mm: Floats
    colour: Floats


def grow_lashes(lid: LidPatch, rng: np.random.Generator) -> Strands:
    """Return upper and lower lashes of one eye in patch space."""
    upper = _lash_row(lid, rng, is_upper=True, count=UPPER_COUNT)
    lower = _lash_row(lid, rng, is_upper=False, count=LOWER_COUNT)
    points = np.concatenate([upper, lower])
    width = np.concatenate(
        [rng.uniform(0.045, 0.085, len(upper)), rng.uniform(0.030, 0.055, len(lower))]
    )
    tone = rng.uniform(0.5, 1.6, size=(len(points), 1))
    return Strands(points, width, np.array(LASH_COLOUR) * tone)


def _lash_row(lid: LidPatch, rng: np.random.Generator, *, is_upper: bool, count: int) -> Floats:
    """Return hairs (count, LASH_POINTS, 3) of one lid."""
    ring = lid.points_mm[:, lid.rim_row]
    on_lid = lid.is_upper > 0.8 if is_upper else lid.is_upper < 0.2
    x = ring[:, 0]
    allowed = np.flatnonzero(on_lid & (x > (-12.0 if is_upper else -9.5)) & (x < 12.4))
    place = (np.arange(count) + rng.uniform(-0.8, 0.8, count)) / count
    index = allowed[0] + np.clip(place, 0, 1) * (allowed[-1] - allowed[0])
    row = lid.rim_row + rng.choice([0.0, 1.2, 2.4], size=count, p=[0.45, 0.35, 0.2])
    root = _on_patch(lid, index, row)
    root -= 0.08 * root / np.linalg.norm(root, axis=1, keepdims=True)
    length = _lash_lengths(root[:, 0], rng, is_upper=is_upper)
    start, end = _lash_directions(root, rng, is_upper=is_upper)
    # How soon a hair curls differs from hair to hair.
    soon = rng.uniform(0.34, 0.5, count) if is_upper else np.full(count, 0.5)
    bend = root + start * (soon * length)[:, None]
    tip = bend + end * ((1.08 - soon) * length)[:, None]
    tip += _towards_clump(tip, rng)
    s = np.linspace(0, 1, LASH_POINTS)[None, :, None]
    curve = (1 - s) ** 2 * root[:, None] + 2 * s * (1 - s) * bend[:, None] + s**2 * tip[:, None]
    return np.asarray(curve)


def _on_patch(lid: LidPatch, index: Floats, row: Floats) -> Floats:
    """Interpolate the patch's surface at fractional grid places."""
    i, j = np.floor(index).astype(int), np.floor(row).astype(int)
    f, g = (index - i)[:, None], (row - j)[:, None]
    p, n = lid.points_mm, lid.points_mm.shape[0]
    near = p[i % n, j] * (1 - g) + p[i % n, j + 1] * g
    far = p[(i + 1) % n, j] * (1 - g) + p[(i + 1) % n, j + 1] * g
    return np.asarray(near * (1 - f) + far * f)


def _lash_lengths(x: Floats, rng: np.random.Generator, *, is_upper: bool) -> Floats:
    """Return lengths in mm: longest in the outer half, short towards the nose."""
    along = (x + 12.0) / 24.5
    shape = 0.50 + 0.55 * np.sin(np.pi * np.clip(0.12 + 0.72 * along, 0, 1)) ** 1.2
    longest = 7.8 if is_upper else 4.3
    grown = np.where(rng.random(len(x)) < 0.25, 0.55, 1.0)  # a quarter is still growing
    return np.asarray(longest * shape * grown * rng.uniform(0.75, 1.08, len(x)))


def _lash_directions(
    root: Floats, rng: np.random.Generator, *, is_upper: bool
) -> tuple[Floats, Floats]:
    """Return unit directions at the root and at the tip: forwards, fanning out, curling away."""
    count = len(root)
    fan = np.clip(root[:, 0] / 13.0 + 0.10, -1, 1) * (0.62 if is_upper else 0.5)
    # Neighbours lean alike, so that hairs seldom cross.
    knots = np.linspace(-13.0, 13.0, 19)
    fan = fan + np.interp(root[:, 0], knots, rng.normal(0, 0.14, len(knots)))
    fan = fan + rng.normal(0, 0.08, count)
    lift = rng.normal(0, 0.11, count)
    if is_upper:
        first = np.column_stack([fan * 0.6, -0.22 + lift, np.full(count, 0.95)])
        last = np.column_stack([fan * 1.2, 1.05 + lift, np.full(count, 0.40)])
    else:
        first = np.column_stack([fan * 0.8, -0.35 + lift, np.full(count, 0.85)])
        last = np.column_stack([fan * 1.3, -0.42 + lift, np.full(count, 0.62)])
    # Near the temple the whole fan turns sideways with the lid.
    turn = np.clip((root[:, 0] - 4.0) / 9.0, 0, 1)[:, None] * np.array([0.45, 0.0, -0.2])
    first, last = first + turn, last + turn
    return (
        first / np.linalg.norm(first, axis=1, keepdims=True),
        last / np.linalg.norm(last, axis=1, keepdims=True),
    )


def _towards_clump(tip: Floats, rng: np.random.Generator) -> Floats:
    """Return shifts that draw neighbouring tips together in tufts of two to five."""
    order = np.argsort(tip[:, 0], kind="stable")
    shift = np.zeros_like(tip)
    at = 0
    while at < len(order):
        size = int(rng.integers(1, 7))
        members = order[at : at + size]
        strength = rng.uniform(0.1, 0.95)
        shift[members] = strength * (tip[members].mean(axis=0) - tip[members])
        at += size
    return shift


def grow_brow(socket: Socket, rng: np.random.Generator) -> Strands:
    """Return the eyebrow above one eye in patch space."""
    along = rng.beta(1.15, 1.1, BROW_COUNT)
    across = np.clip(rng.normal(0, 0.48, BROW_COUNT), -1.1, 1.1)
    knots = np.linspace(0, 1, len(BROW))
    x, y, half, angle = (np.interp(along, knots, column) for column in BROW.T)
    slope = np.gradient(np.interp(np.linspace(0, 1, 101), knots, BROW[:, 1]))
    normal_lean = -np.interp(along, np.linspace(0, 1, 101), slope) * 2.0
    root = np.column_stack([x + across * half * normal_lean * 0.3, y + across * half])
    # Hairs of the upper border lean down, those of the lower border up: they meet in the middle.
    angle = angle - across * 24.0 * np.clip(along * 3, 0, 1) + rng.normal(0, 9.0, BROW_COUNT)
    length = (7.2 - 2.2 * np.abs(along - 0.4)) * rng.uniform(0.55, 1.1, BROW_COUNT)
    length *= np.where(along > 0.85, 0.75, 1.0)
    points = _lay_on_face(socket, root, angle, length=length, rng=rng)
    width = rng.uniform(0.055, 0.095, BROW_COUNT)
    tone = rng.uniform(0.6, 1.7, size=(BROW_COUNT, 1))
    return Strands(points, width, np.array(BROW_COLOUR) * tone)


def _lay_on_face(
    socket: Socket,
    root: Floats,
    angle_deg: Floats,
    *,
    length: Floats,
    rng: np.random.Generator,
) -> Floats:
    """Return hairs (n, BROW_POINTS, 3) that rise from the skin and lie down along their way."""
    bend = rng.normal(-10.0, 9.0, len(root))
    height = rng.uniform(0.5, 1.1, len(root))
    steps = np.linspace(0, 1, BROW_POINTS)
    place = root.copy()
    points = []
    for number, s in enumerate(steps):
        lift = height * np.sin(np.pi * min(0.15 + 0.75 * s, 1.0)) - 0.35
        z = socket.height(place) + np.maximum(lift, -0.1 if number == 0 else 0.12)
        points.append(np.column_stack([place, z]))
        heading = np.radians(angle_deg + bend * s)
        step = (length / (BROW_POINTS - 1))[:, None]
        place = place + step * np.column_stack([np.cos(heading), np.sin(heading)])
    return np.stack(points, axis=1)
