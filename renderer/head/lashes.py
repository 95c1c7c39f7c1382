"""Eyelashes, hair by hair, rooted on the lids that they are given. Pure numpy.

A lash grows in the frame of its root: along the rim, away from the fissure over the lid's skin, and
straight off the skin. So when the lid moves, its lashes move with it. Patch space (see
``lid_fit``), mm.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats
from renderer.body.normals import unit
from renderer.head.lash_marks import pores, root_shades
from renderer.head.lash_rows import LOWER, UPPER, Growth, LashRow, draw_growth
from renderer.head.lid_fit import LidPatch
from renderer.head.lid_ground import frames_at, on_skin, rim_columns, skin_facing
from renderer.head.strand_group import Strands, joined

POINTS: Final = 16
SUNK_MM: Final = 0.08  # roots lie in the skin; hair.frag fades them in
CLEAR_MM: Final = 0.25  # hairs keep so far off the skin
MOST_BEND_MM: Final = 3.0  # in each of BEND_STEPS
BEND_STEPS: Final = 6
COLOUR: Final = (0.062, 0.037, 0.024)  # dark brown; tips let more light through (fibre.glsl)


class Lashes(NamedTuple):
    """One eye's lashes, in the order in which they are drawn; upper lid before lower."""

    shades: Strands
    pores: Strands
    hairs: Strands


def grow_lashes(lid: LidPatch, rng: np.random.Generator) -> Lashes:
    """Return the lashes of one eye and their marks on the skin, in patch space."""
    grown = [_grow_row(lid, row, draw_growth(row, rng)) for row in (UPPER, LOWER)]
    return Lashes(*(joined(list(both)) for both in zip(*grown, strict=True)))


def _grow_row(lid: LidPatch, row: LashRow, growth: Growth) -> Lashes:
    """Grow one lid's lashes."""
    column = rim_columns(lid, growth.place, is_upper=row.is_upper, between_mm=row.between_mm)
    frame = frames_at(lid, column)
    local, direction = _way(growth)
    root = on_skin(lid, column, growth.beyond_mm)
    root -= SUNK_MM * np.einsum("nc,ncd->nd", direction[:, 0], frame)
    points = root[:, None] + np.einsum("nsk,nkc->nsc", local, frame)
    points = _off_the_skin(lid, _gathered(points, growth), frame[:, 2])
    return Lashes(
        root_shades(lid, row, growth, column=column, local_mm=local),
        pores(lid, row, growth, column=column),
        Strands(points, growth.width_mm, np.array(COLOUR) * growth.tone[:, None]),
    )


def _way(growth: Growth) -> tuple[Floats, Floats]:
    """Return how hairs run from their roots in their frames, and their directions (n, k, 3)."""
    s = np.linspace(0, 1, POINTS)
    curl = np.radians(_through(growth.curl_deg, s))
    lean = np.radians(growth.lean_deg[:, None] + growth.sway_deg[:, None] * s)
    direction = np.stack(
        [np.sin(lean), np.cos(lean) * np.sin(curl), np.cos(lean) * np.cos(curl)], -1
    )
    step = (growth.length_mm / (POINTS - 1))[:, None, None]
    way = np.zeros_like(direction)
    way[:, 1:] = np.cumsum((direction[:, 1:] + direction[:, :-1]) / 2 * step, axis=1)
    return way, direction


def _through(values: Floats, s: Floats) -> Floats:
    """Return parabolas (n, k) at places s (k,) through values (n, 3) at 0, 1/2 and 1."""
    basis = np.stack([2 * (s - 0.5) * (s - 1), 4 * s * (1 - s), 2 * s * (s - 0.5)])
    return np.asarray(values @ basis)


def _gathered(points: Floats, growth: Growth) -> Floats:
    """Draw the hairs of a tuft together, more towards their tips."""
    members = np.bincount(growth.tuft)
    middle = np.zeros((len(members), *points.shape[1:]))
    np.add.at(middle, growth.tuft, points)
    middle = (middle / np.maximum(members, 1)[:, None, None])[growth.tuft]
    s = np.linspace(0, 1, points.shape[1])
    return np.asarray(points + (growth.pull[:, None] * s**1.5)[..., None] * (middle - points))


def _off_the_skin(lid: LidPatch, points: Floats, normal: Floats) -> Floats:
    """Bend hairs (n, k, 3) whose way leads into the skin away from it.

    Skin bulges where a lid folds: under the eye that looks down, or over the open one. Hairs give
    way along their roots' normals and, as the nose's side rises steeply, along the skin's own.
    """
    skin, facing = skin_facing(lid)
    tree = cKDTree(skin)
    s = np.linspace(0, 1, points.shape[1])
    free = s > 0.15  # the root itself lies in the skin
    length = _length(points)
    for _ in range(BEND_STEPS):
        _, near = tree.query(points[:, free].reshape(-1, 3))
        away = points[:, free].reshape(-1, 3) - skin[near]
        height = (away * facing[near]).sum(axis=1).reshape(len(points), -1)
        lacking = (CLEAR_MM * np.minimum(4 * s[free], 1.0) - height) / s[free]
        bend = np.clip(lacking.max(axis=1), 0.0, MOST_BEND_MM)
        worst = np.argmax(lacking, axis=1)
        wall = facing[near].reshape(*height.shape, 3)[np.arange(len(points)), worst]
        aside = unit(normal + wall)
        way = points - points[:, :1] + (bend[:, None] * s)[..., None] * aside[:, None]
        points = points[:, :1] + way * (length / _length(way))[:, None, None]
    return points


def _length(points: Floats) -> Floats:
    return np.asarray(np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1))
