"""Locks of hair on the scalp: from the crown, where they whirl, to tips of their own.

Every lock is a ridge between two furrows. Pure numpy, millimetres.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, base_mesh
from renderer.body.normals import unit, vertex_normals
from renderer.crowd.hair_styles import Style
from renderer.crowd.hanging import is_hanging
from renderer.crowd.pieces import group_triangles
from renderer.crowd.scalp import directions, hairline, places

LOCKS: Final = 22
COLUMNS: Final = 2 * LOCKS
HUNG_ROW: Final = 4  # on the scalp, from which long hair hangs
_ROWS: Final = np.array([0.12, 0.27, 0.43, 0.59, 0.75, 0.9, 1.0])  # of the way to the hairline
_DENSER_BEFORE: Final = 0.3  # columns stand closer over the brow, where one looks
_HEAD_MM: Final = 95.0  # from its middle to the scalp
_RIM_MM: Final = 1.2  # hair's thickness at its tips
_SUNK_MM: Final = 3.0  # behind the tips it goes on under the skin: nobody sees below it
_TIP_SHARE: Final = 0.3  # of the way, over which hair thins to its tips
_SIDES_MM: Final = (742.0, 835.0)  # height on the base mesh: hair of the sides, hair of the top


@dataclass(frozen=True)
class Locks:
    """Hair on the scalp, rows of columns: (rows, columns, 3), with the tone of each vertex."""

    points_mm: Floats
    outwards: Floats
    tone: Floats
    turn: Floats  # of the columns around the crown, where long hair leaves the scalp


def comb(style: Style, shape: Floats, rng: np.random.Generator) -> Locks:
    """Return locks combed from the crown to where each ends, their last row under the skin."""
    even = (np.arange(COLUMNS) / COLUMNS * 2 - 1) * np.pi
    even += rng.uniform(-0.15, 0.15, COLUMNS) * 2 * np.pi / COLUMNS
    turn = even - _DENSER_BEFORE * np.sin(even)
    is_ridge = np.arange(COLUMNS) % 2 == 1
    end = hairline(tuple(turn.tolist())) + _tips(style, turn, rng, is_ridge=is_ridge) / _HEAD_MM
    share = np.append(_ROWS, 1.0)[:, None]
    way = share * end + np.append(np.zeros(len(_ROWS)), _SUNK_MM / _HEAD_MM)[:, None]
    # Locks whirl on the crown and lie each in its own direction towards their tips.
    lean = np.repeat(rng.uniform(-0.25, 0.25, LOCKS), 2) * 2 * np.pi / COLUMNS
    around = turn + style.whirl * np.sin(np.pi * np.minimum(share, 1.0)) + lean * share**2
    found = places(directions(way, around).reshape(-1, 3))
    vertices = base_mesh().vertices_mm
    outwards = unit(found.of(vertex_normals(shape, group_triangles("body"))))
    where = np.angle(np.exp(1j * around[HUNG_ROW]))
    thinned = np.where(style.hangs & is_hanging(where), 0.4 * share, share)
    push = _thickness(style, found.of(vertices)[:, 1].reshape(way.shape), thinned, rng)
    relief, tone = _relief(style, share, rng, is_ridge=is_ridge)
    push = np.maximum(push + relief, _RIM_MM)
    push[-1] = -_SUNK_MM
    points = found.of(shape) + outwards * push.reshape(-1, 1)
    return Locks(points.reshape(*way.shape, 3), outwards.reshape(*way.shape, 3), tone, where)


def _tips(
    style: Style, turn: Floats, rng: np.random.Generator, *, is_ridge: npt.NDArray[np.bool_]
) -> Floats:
    """Return how far columns reach beyond the hairline in mm: ridges beyond, furrows before it."""
    uneven = rng.uniform(0.1, 1.4, len(turn)) ** 2 * np.where(is_ridge, 1.0, -0.5)
    reach = style.tips_mm * (uneven + rng.normal(0.0, 0.2, len(turn)))
    reach += style.fringe_mm * np.exp(-((turn / 0.75) ** 4))
    temple = np.exp(-(((np.abs(turn) - 0.62) / 0.28) ** 2))
    return np.asarray(reach - style.bare_mm * temple - 0.3 * style.bare_mm * (np.abs(turn) < 0.5))


def _thickness(style: Style, y_mm: Floats, share: Floats, rng: np.random.Generator) -> Floats:
    """Return how far hair stands off the scalp (rows, columns) in mm, without its relief."""
    low, high = _SIDES_MM
    on_top = np.clip((y_mm - low) / (high - low), 0.0, 1.0)
    full = style.side_mm + (style.top_mm - style.side_mm) * on_top
    clumps = np.interp(np.linspace(0, 1, COLUMNS), np.linspace(0, 1, 9), rng.uniform(0.85, 1.15, 9))
    return np.asarray(full * clumps * np.clip((1 - share) / _TIP_SHARE, 0.0, 1.0) ** 0.6)


def _relief(
    style: Style, share: Floats, rng: np.random.Generator, *, is_ridge: npt.NDArray[np.bool_]
) -> tuple[Floats, Floats]:
    """Return the height of ridges and furrows in mm and their tone, both (rows, columns)."""
    size = (len(share), COLUMNS)
    if style.is_curled:
        bump = rng.uniform(-1.0, 1.0, size)
    else:
        bump = np.where(is_ridge, 1.0, -1.0) * np.repeat(rng.uniform(0.2, 1.0, LOCKS), 2)
        bump = bump + rng.normal(0.0, 0.3, size) + _waves(rng, len(share))
    own = np.repeat(rng.uniform(0.8, 1.25, LOCKS), 2) * rng.uniform(0.9, 1.1, size)
    tone = own * (1.0 + 0.38 * np.clip(bump, -1.2, 1.2))
    stands = np.clip(share / 0.2, 0.0, 1.0) * np.clip(0.25 + (1 - share) / 0.3, 0.0, 1.0)
    return style.relief_mm * bump * stands, tone


def _waves(rng: np.random.Generator, rows: int) -> Floats:
    """Return waves (rows, columns) some locks wide, so that no lock runs evenly to its tip."""
    coarse = rng.normal(0.0, 0.6, (4, LOCKS // 2))
    fine = np.stack(
        [np.interp(np.linspace(0, 3, rows), np.arange(4), column) for column in coarse.T], axis=1
    )
    wide = np.concatenate([fine, fine[:, :1]], axis=1)
    at = np.linspace(0, wide.shape[1] - 1, COLUMNS, endpoint=False)
    return np.stack([np.interp(at, np.arange(wide.shape[1]), row) for row in wide])
