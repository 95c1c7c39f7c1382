"""Hair of the crowd's people: the scalp lifted off the skull, and long hair over it. Pure numpy."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats, Indices
from renderer.crowd.hems import open_edges
from renderer.crowd.people import Person
from renderer.crowd.pieces import Piece, flat, group_triangles, quad_centres

# Height of the hairline on the base mesh over depth: nape, behind and above the ear, temple, brow.
_HAIRLINE: Final = (
    (-60.0, 0.0, 12.0, 30.0, 60.0, 95.0, 120.0, 145.0),
    (668.0, 690.0, 742.0, 742.0, 768.0, 788.0, 796.0, 800.0),
)
END_MM: Final = 600.0  # of long hair, just above the collar


def short_hair(person: Person, base: Floats, body: Indices) -> Piece:
    """Return short hair: the scalp lifted off the skull, thinner towards the hairline."""
    centre = quad_centres("body")
    row = np.interp(centre[:, 2], *_HAIRLINE)
    triangles = body[(centre[:, 1] > row) & (np.abs(centre[:, 0]) < 90)]
    rim = np.unique(open_edges(triangles))
    shift = _snap(base, rim)
    # Where the line runs up behind the ear its height says little: hair is thin near its rim.
    within = np.asarray(cKDTree(base[rim] + shift[rim]).query(base)[0])
    within[rim] = 0.0
    lumps = 1 + 0.12 * np.sin(base @ [0.19, 0.07, 0.13]) * np.sin(base @ [-0.11, 0.23, 0.17])
    push = (1.5 + 11.5 * np.clip(within / 45, 0, 1) ** 0.7) * lumps
    streaks = 1 + 0.18 * np.sin(base @ [0.9, 0.2, 0.35])
    surface = flat(person.hair, len(base))
    surface[:, :3] *= streaks[:, None]
    return Piece("hair", triangles, push, surface, 420, shift_mm=shift, turned_in_above_mm=0.0)


def _snap(base: Floats, rim: Indices) -> Floats:
    """Return shifts (n, 3) that bring the rim of the hair on the hairline: no jags."""
    shift = np.zeros_like(base)
    for _ in range(4):  # the shortest way there, sideways where the line is steep
        y, z = (base[rim] + shift[rim]).T[1:]
        above = y - np.interp(z, *_HAIRLINE)
        slope = (np.interp(z + 1, *_HAIRLINE) - np.interp(z - 1, *_HAIRLINE)) / 2
        step = -above / (1 + slope * slope)
        shift[rim, 1] += step
        shift[rim, 2] -= slope * step
    length = np.linalg.norm(shift, axis=1, keepdims=True)
    return np.asarray(shift * np.minimum(1.0, 25.0 / np.maximum(length, 1e-9)))


def long_hair(person: Person, base: Floats) -> Piece:
    """Return hair down to the collar, cut straight: longer strands would pierce the shoulders."""
    triangles, centre = group_triangles("helper-hair"), quad_centres("helper-hair")
    frames_face = (centre[:, 2] < 62) | (centre[:, 1] > 800)
    kept = triangles[(base[triangles, 1].max(axis=1) > END_MM) & frames_face]
    surface = flat(person.hair, len(base))
    surface[:, :3] *= (1 + 0.2 * np.sin(base @ [0.5, 0.0, 0.5]))[:, None]
    push = np.full(len(base), 2.0)
    return Piece("hair", kept, push, surface, 300, shift_mm=_cut(base, kept), is_two_sided=True)


def _cut(base: Floats, triangles: Indices) -> Floats:
    """Return shifts (n, 3) that take what hangs lower than END_MM up its strand to there."""
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edges = np.concatenate([edges, edges[:, ::-1]])
    low, high = edges[(base[edges[:, 0], 1] < END_MM) & (base[edges[:, 1], 1] >= END_MM)].T
    way = base[high] - base[low]
    steepest_last = np.argsort(way[:, 1] / np.linalg.norm(way, axis=1), kind="stable")
    share = (END_MM - base[low, 1]) / way[:, 1]
    shift = np.zeros_like(base)
    shift[low[steepest_last]] = (share[:, None] * way)[steepest_last]
    return shift
