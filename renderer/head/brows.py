"""Eyebrows, hair by hair, on the brow's ridge. Pure numpy, patch space (see ``lid_fit``) in mm."""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.head.lid_socket import Socket
from renderer.head.strand_group import Strands, joined

COUNT: Final = 540
VELLUS: Final = 220  # fine pale hairs at the outline and beyond
POINTS: Final = 6
BROW_COLOUR: Final = (0.058, 0.035, 0.022)
VELLUS_COLOUR: Final = (0.34, 0.23, 0.16)
# The brow's middle line from nose to temple: x, y, half width in mm; direction of growth in degrees
# above the way to the temple; length in mm; how thick the hairs stand.
BROW: Final = np.array(
    [
        (-18.0, 18.4, 2.8, 84.0, 5.0, 0.4),
        (-14.5, 19.2, 3.6, 70.0, 6.5, 0.95),
        (-9.0, 20.5, 3.9, 50.0, 7.6, 1.1),
        (-2.0, 22.0, 3.6, 34.0, 8.2, 1.05),
        (5.0, 23.4, 3.1, 21.0, 8.0, 1.0),
        (12.0, 23.9, 2.4, 2.0, 7.2, 0.85),
        (19.0, 22.1, 1.7, -20.0, 6.2, 0.6),
        (25.0, 19.2, 1.1, -30.0, 5.2, 0.35),
        (29.0, 16.8, 0.7, -36.0, 4.2, 0.1),
    ]
)


def grow_brow(socket: Socket, rng: np.random.Generator) -> Strands:
    """Return the eyebrow above one eye in patch space."""
    return joined([_hairs(socket, rng), _vellus(socket, rng)])


def stubble(x: Floats, y: Floats) -> Floats:
    """Return how much of the skin at places (n,) is hidden by hairs too fine to be drawn."""
    middle, half, dense = (np.interp(x, BROW[:, 0], BROW[:, column]) for column in (1, 2, 5))
    ends = (x > BROW[0, 0]) & (x < BROW[-1, 0])
    return np.asarray(0.3 * dense * ends * np.exp(-(((y - middle) / (0.9 * half)) ** 2)))


def _hairs(socket: Socket, rng: np.random.Generator) -> Strands:
    """Grow the brow's own hairs: thick in its middle, thin and fewer at its outline."""
    along = _scattered(rng, COUNT)
    # The lower border is crisper than the upper one.
    across = np.clip(rng.normal(-0.05, 0.46, COUNT), -1.05, 1.3)
    root, angle, length = _laid_out(along, across)
    border = np.clip(1.0 - across**2 * 0.45, 0.5, 1.0)
    angle += rng.normal(0, 8.0, COUNT)
    length *= rng.uniform(0.6, 1.12, COUNT) * border
    width = rng.uniform(0.050, 0.082, COUNT) * border
    tone = rng.uniform(0.65, 1.6, COUNT) / border
    points = _lie_on_face(socket, root, angle, length=length, rng=rng)
    return Strands(points, width, np.array(BROW_COLOUR) * tone[:, None])


def _vellus(socket: Socket, rng: np.random.Generator) -> Strands:
    """Grow pale down around the outline, below most of all."""
    along = rng.uniform(0.0, 1.0, VELLUS)
    side = np.where(rng.random(VELLUS) < 0.6, -1.0, 1.0)
    across = side * (0.8 + rng.gamma(1.6, 0.42, VELLUS))
    root, angle, length = _laid_out(along, across)
    points = _lie_on_face(
        socket,
        root,
        angle + rng.normal(0, 16.0, VELLUS),
        length=length * rng.uniform(0.25, 0.5, VELLUS),
        rng=rng,
    )
    tone = rng.uniform(0.6, 1.2, VELLUS)
    return Strands(
        points, rng.uniform(0.010, 0.018, VELLUS), np.array(VELLUS_COLOUR) * tone[:, None]
    )


def _scattered(rng: np.random.Generator, count: int) -> Floats:
    """Return places along the brow, 0 to 1, as dense as BROW says."""
    knots, fine = np.linspace(0, 1, len(BROW)), np.linspace(0, 1, 401)
    dense = np.interp(fine, knots, BROW[:, 5]) * np.interp(fine, knots, BROW[:, 2])
    dense *= np.interp(fine, knots, np.gradient(BROW[:, 0]))
    share = np.cumsum(dense)
    share = (share - share[0]) / (share[-1] - share[0])
    even = (np.arange(count) + rng.uniform(-0.8, 0.8, count)) / count
    return np.interp(np.clip(even, 0, 1), share, fine)


def _laid_out(along: Floats, across: Floats) -> tuple[Floats, Floats, Floats]:
    """Return roots (n, 2) in the frontal plane, directions in degrees, lengths in mm."""
    knots = np.linspace(0, 1, len(BROW))
    x, y, half, angle, length, _ = (np.interp(along, knots, column) for column in BROW.T)
    slope = np.interp(along, knots, np.gradient(BROW[:, 1]) / np.gradient(BROW[:, 0]))
    root = np.column_stack([x - across * half * slope, y + across * half])
    # Hairs of the upper border lean down, those of the lower border up: they meet in the middle.
    meeting = np.clip(3.2 * along - 0.25, 0, 1) * 26.0
    return root, angle - across.clip(-1.3, 1.3) * meeting, length


def _lie_on_face(
    socket: Socket,
    root: Floats,
    angle_deg: Floats,
    *,
    length: Floats,
    rng: np.random.Generator,
) -> Floats:
    """Return hairs (n, POINTS, 3) that rise from the skin and lie down along their way."""
    bend = rng.normal(-12.0, 9.0, len(root))
    height = rng.uniform(0.35, 0.95, len(root))
    place, points = root.copy(), []
    for number, s in enumerate(np.linspace(0, 1, POINTS)):
        lift = height * np.sin(np.pi * (0.08 + 0.72 * s)) - 0.25
        z = socket.height(place) + np.maximum(lift, -0.1 if number == 0 else 0.08)
        points.append(np.column_stack([place, z]))
        heading = np.radians(angle_deg + bend * s)
        step = (length / (POINTS - 1))[:, None]
        place = place + step * np.column_stack([np.cos(heading), np.sin(heading)])
    return np.stack(points, axis=1)
