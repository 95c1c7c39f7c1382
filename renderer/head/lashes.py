"""Eyelashes, hair by hair, rooted on the lids that they are given. Pure numpy.

A lash grows in the frame of its root: along the rim, away from the fissure over the lid's skin, and
straight off the skin. All numbers are drawn before the lid is looked at. So when the lid moves, its
lashes move with it and stay the same hairs. Patch space (see ``lid_fit``), mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats, Indices
from renderer.head.lid_fit import LidPatch

POINTS: Final = 12
SHADOW_POINTS: Final = 5
SUNK_MM: Final = 0.3  # roots lie in the skin
OWN_SKIN: Final = 0.3  # what the lid's skin says against the globe beneath, about a lash's frame
CLEAR_MM: Final = 0.25  # hairs keep so far off the skin
MOST_BEND_MM: Final = 3.0  # in each of BEND_STEPS
BEND_STEPS: Final = 6
SHADOW_MM: Final = 0.8  # width of the soft shadow at a root
COLOUR: Final = (0.062, 0.037, 0.024)  # dark brown; tips let more light through (fibre.glsl)


@dataclass(frozen=True)
class Strands:
    """Hairs: points (n, k, 3) in mm, width at the root (n,) in mm, linear colour (n, 3).

    ``shadow`` (n,) is what a strand takes from the light of what lies under it: above 0 it is no
    hair but the soft shadow of one. None means hairs only.
    """

    points_mm: Floats
    width_mm: Floats
    colour: Floats
    shadow: Floats | None = None


@dataclass(frozen=True)
class LashRow:
    """How the lashes of one lid grow; numbers of adults.

    ``along`` holds columns: place from the nose's end (0) to the temple's (1), length in mm, lean
    towards the temple in degrees, how thick the hairs stand. ``curl_deg`` are the angles between
    the lid's normal and the hair at root, middle and tip, positive away from the fissure.
    ``between_mm`` is where along the rim's chord lashes begin and end.
    """

    count: int
    is_upper: bool
    along: tuple[tuple[float, float, float, float], ...]
    curl_deg: tuple[float, float, float]
    curl_spread_deg: float
    rows_mm: tuple[float, ...]  # beyond the lid's outer edge
    width_mm: tuple[float, float]
    between_mm: tuple[float, float]
    shadow: float


# About 150 upper lashes of 8 to 12 mm and 75 lower of 6 to 8 mm, in two or three rows.
UPPER: Final = LashRow(
    count=150,
    is_upper=True,
    along=(
        (0.0, 4.8, -13.0, 0.6),
        (0.15, 7.0, -10.0, 0.9),
        (0.4, 9.2, -1.0, 1.1),
        (0.65, 10.0, 8.0, 1.1),
        (0.85, 9.0, 15.0, 1.0),
        (1.0, 6.8, 20.0, 0.7),
    ),
    curl_deg=(-14.0, 14.0, 48.0),
    curl_spread_deg=10.0,
    rows_mm=(-0.3, 0.05, 0.38),
    width_mm=(0.068, 0.100),
    between_mm=(-12.0, 11.6),
    shadow=0.17,
)
LOWER: Final = LashRow(
    count=75,
    is_upper=False,
    along=(
        (0.0, 4.2, -16.0, 0.5),
        (0.2, 5.6, -10.0, 0.9),
        (0.5, 6.9, 2.0, 1.1),
        (0.8, 6.6, 12.0, 1.0),
        (1.0, 4.4, 16.0, 0.4),
    ),
    curl_deg=(2.0, 24.0, 18.0),
    curl_spread_deg=9.0,
    rows_mm=(0.0, 0.35),
    width_mm=(0.044, 0.066),
    between_mm=(-10.0, 11.3),
    shadow=0.16,
)


@dataclass(frozen=True)
class _Growth:
    """What chance gives each hair of a row, in the order of their roots from the nose."""

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


def grow_lashes(lid: LidPatch, rng: np.random.Generator) -> tuple[Strands, Strands]:
    """Return the soft shadows at the roots of one eye's lashes, and the lashes, in patch space.

    Both hold ``UPPER.count`` strands, then ``LOWER.count``, in the same order.
    """
    rows = [(row, _chance(row, rng)) for row in (UPPER, LOWER)]
    shadows = joined([_shadows(lid, row, growth) for row, growth in rows])
    return shadows, joined([_hairs(lid, row, growth) for row, growth in rows])


def joined(groups: list[Strands]) -> Strands:
    """Return groups of hairs, or groups of shadows, as one."""
    shadows = [group.shadow for group in groups if group.shadow is not None]
    return Strands(
        np.concatenate([group.points_mm for group in groups]),
        np.concatenate([group.width_mm for group in groups]),
        np.concatenate([group.colour for group in groups]),
        np.concatenate(shadows) if shadows else None,
    )


def _chance(row: LashRow, rng: np.random.Generator) -> _Growth:
    """Draw all random numbers of a row."""
    n = row.count
    knots, length, lean, density = np.array(row.along).T
    fine = np.linspace(0, 1, 201)
    share = np.cumsum(np.interp(fine, knots, density))
    place = np.interp((np.arange(n) + rng.normal(0.5, 0.75, n)) / n, share / share[-1], fine)
    place = np.sort(np.clip(place, 0.0, 1.0))
    tuft = _tufts(rng, n)
    is_new = rng.random(n) < 0.09  # a few have just grown
    grown = np.where(is_new, rng.uniform(0.35, 0.65, n), rng.normal(1.0, 0.10, n).clip(0.75, 1.18))
    # Hairs of a tuft lean alike, neighbouring tufts nearly so; some hairs cross their neighbours.
    strays = np.where(rng.random(n) < 0.10, 12.0, 3.0)
    waves = np.interp(place, np.linspace(0, 1, 23), rng.normal(0, 5.0, 23))
    lean_deg = np.interp(place, knots, lean) + waves
    lean_deg += rng.normal(0, 4.5, n)[tuft] + rng.normal(0, 1, n) * strays
    turn = rng.normal(0, 0.75, n)[tuft] * row.curl_spread_deg + rng.normal(0, 0.6, n) * 5.0
    curl = np.array(row.curl_deg) + turn[:, None] * np.array([0.35, 0.8, 1.3])
    curl[:, 0] += rng.normal(0, 5.0, n)
    return _Growth(
        place=place,
        beyond_mm=rng.choice(row.rows_mm, size=n) + rng.normal(0, 0.09, n),
        length_mm=np.interp(place, knots, length) * grown,
        lean_deg=lean_deg,
        sway_deg=0.6 * np.interp(place, knots, lean) + rng.normal(0, 7.0, n),
        curl_deg=curl,
        width_mm=rng.uniform(*row.width_mm, n) * np.where(is_new, 0.7, 1.0),
        tuft=tuft,
        pull=(rng.uniform(0.15, 0.85, n) * (rng.random(n) < 0.8))[tuft],
        tone=rng.uniform(0.7, 1.45, n),
    )


def _tufts(rng: np.random.Generator, count: int) -> Indices:
    """Return tuft numbers (count,) of hairs in a row: ones, twos and threes."""
    sizes = rng.choice([1, 2, 3], size=count, p=[0.34, 0.36, 0.30])
    return np.repeat(np.arange(count), sizes)[:count]


def _hairs(lid: LidPatch, row: LashRow, growth: _Growth) -> Strands:
    """Grow one lid's lashes."""
    index, frame = _roots(lid, row, growth)
    s = np.linspace(0, 1, POINTS)
    curl = np.radians(_through(growth.curl_deg, s))
    lean = np.radians(growth.lean_deg[:, None] + growth.sway_deg[:, None] * s)
    local = np.stack([np.sin(lean), np.cos(lean) * np.sin(curl), np.cos(lean) * np.cos(curl)], -1)
    direction = np.einsum("nsk,nkc->nsc", local, frame)
    root = _on_skin(lid, index, growth.beyond_mm) - SUNK_MM * direction[:, 0]
    step = (growth.length_mm / (POINTS - 1))[:, None, None]
    way = np.cumsum((direction[:, 1:] + direction[:, :-1]) / 2 * step, axis=1)
    points = root[:, None] + np.concatenate([np.zeros((row.count, 1, 3)), way], axis=1)
    points = _off_the_skin(lid, _gathered(points, growth), frame[:, 2])
    colour = np.array(COLOUR) * growth.tone[:, None]
    return Strands(points, growth.width_mm, colour)


def _off_the_skin(lid: LidPatch, points: Floats, normal: Floats) -> Floats:
    """Bend hairs (n, k, 3) whose way leads into the skin away from it.

    Skin bulges where a lid folds: under the eye that looks down, or over the open one. Hairs give
    way along their roots' normals and, as the nose's side rises steeply, along the skin's own.
    """
    skin = lid.points_mm[:, lid.rim_row + 1 :]
    around = np.roll(skin, -1, axis=0) - np.roll(skin, 1, axis=0)
    facing = _unit(np.cross(around, np.gradient(skin, axis=1)) + 1e-12)
    facing *= np.sign((facing * skin).sum())  # one sign for all: the nose's side faces the eye
    tree, flat_facing = cKDTree(skin.reshape(-1, 3)), facing.reshape(-1, 3)
    s = np.linspace(0, 1, points.shape[1])
    free = s > 0.15  # the root itself lies in the skin
    length = _length(points)
    for _ in range(BEND_STEPS):
        _, near = tree.query(points[:, free].reshape(-1, 3))
        away = points[:, free].reshape(-1, 3) - skin.reshape(-1, 3)[near]
        height = (away * flat_facing[near]).sum(axis=1).reshape(len(points), -1)
        lacking = (CLEAR_MM * np.minimum(4 * s[free], 1.0) - height) / s[free]
        bend = np.clip(lacking.max(axis=1), 0.0, MOST_BEND_MM)
        worst = np.argmax(lacking, axis=1)
        wall = flat_facing[near].reshape(*height.shape, 3)[np.arange(len(points)), worst]
        aside = _unit(normal + wall)
        way = points - points[:, :1] + (bend[:, None] * s)[..., None] * aside[:, None]
        points = points[:, :1] + way * (length / _length(way))[:, None, None]
    return points


def _length(points: Floats) -> Floats:
    return np.asarray(np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1))


def _through(values: Floats, s: Floats) -> Floats:
    """Return parabolas (n, k) at places s (k,) through values (n, 3) at 0, 1/2 and 1."""
    basis = np.stack([2 * (s - 0.5) * (s - 1), 4 * s * (1 - s), 2 * s * (s - 0.5)])
    return np.asarray(values @ basis)


def _gathered(points: Floats, growth: _Growth) -> Floats:
    """Draw the hairs of a tuft together, more towards their tips."""
    members = np.bincount(growth.tuft)
    middle = np.zeros((len(members), *points.shape[1:]))
    np.add.at(middle, growth.tuft, points)
    middle = (middle / np.maximum(members, 1)[:, None, None])[growth.tuft]
    s = np.linspace(0, 1, points.shape[1])
    return np.asarray(points + (growth.pull[:, None] * s**1.5)[..., None] * (middle - points))


def _shadows(lid: LidPatch, row: LashRow, growth: _Growth) -> Strands:
    """Lay a short soft shadow on the skin at each root."""
    index, _ = _roots(lid, row, growth)
    reach = 1.5 if row.is_upper else 1.1
    shift = np.tan(np.radians(np.clip(growth.lean_deg, -50, 50))) * (-1.0 if row.is_upper else 1.0)
    step = _rim_step_mm(lid)
    ways = np.linspace(0.0, reach, SHADOW_POINTS)
    points = [_on_skin(lid, index + shift * way / step, growth.beyond_mm + way) for way in ways]
    black = np.zeros((row.count, 3))
    return Strands(
        np.stack(points, axis=1),
        np.full(row.count, SHADOW_MM),
        black,
        np.full(row.count, row.shadow),
    )


def _rim_step_mm(lid: LidPatch) -> float:
    """Return the mean distance of the rim's points."""
    ring = lid.points_mm[:, lid.rim_row]
    return float(np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1).mean())


def _roots(lid: LidPatch, row: LashRow, growth: _Growth) -> tuple[Floats, Floats]:
    """Return fractional places (n,) on the ring, and frames (n, 3, 3): temple, outwards, normal."""
    around = len(lid.points_mm)
    ring = lid.points_mm[:, lid.rim_row]
    on_lid = lid.is_upper > 0.5 if row.is_upper else lid.is_upper < 0.5
    low, high = row.between_mm
    allowed = np.flatnonzero(on_lid & (ring[:, 0] > low) & (ring[:, 0] < high))
    first, last = float(allowed[0]), float(allowed[-1])
    # The ring runs from the temple over the upper lid to the nose, and back below.
    index = (
        last - growth.place * (last - first)
        if row.is_upper
        else first + growth.place * (last - first)
    )
    frames = rim_frames(lid)
    base = np.floor(index).astype(int)
    share = (index - base)[:, None, None]
    frame = frames[base % around] * (1 - share) + frames[(base + 1) % around] * share
    return index, _unit(frame)


def rim_frames(lid: LidPatch) -> Floats:
    """Return unit frames (around, 3, 3) on the rim: along it to the temple, outwards, normal.

    Outwards is the way over the lid's skin, away from the fissure. The normal is mostly the
    globe's, on which lids slide, turned a little by the lid's own skin; all are smoothed along the
    rim, so that lashes fan evenly over small bumps.
    """
    points, rim = lid.points_mm, lid.rim_row
    forward = np.roll(points[:, rim], -1, axis=0) - np.roll(points[:, rim], 1, axis=0)
    temple = _unit(_smoothed(forward * np.where(lid.is_upper > 0.5, -1.0, 1.0)[:, None]))
    skin = np.array([np.interp(1.6, a - a[rim], np.arange(len(a))) for a in lid.across_mm])
    outwards = _unit(_smoothed(_at_rows(points, skin) - points[:, rim]))
    globe = _unit(points[:, rim])
    own = np.cross(temple, outwards)
    own *= np.sign((own * globe).sum(axis=1, keepdims=True))
    normal = _smoothed(globe + OWN_SKIN * own)
    normal = _unit(normal - temple * (normal * temple).sum(axis=1, keepdims=True))
    across = np.cross(normal, temple)
    across *= np.where(lid.is_upper > 0.5, 1.0, -1.0)[:, None]
    return np.stack([temple, across, normal], axis=1)


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


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


def _on_skin(lid: LidPatch, index: Floats, beyond_mm: Floats) -> Floats:
    """Return points of the lid (n, 3) at places on the ring, so far beyond its outer edge."""
    around = len(lid.points_mm)
    base = np.floor(index).astype(int)
    sides = []
    for column in (base % around, (base + 1) % around):
        across = lid.across_mm[column]
        wanted = across[:, lid.rim_row] + beyond_mm
        rows = np.array(
            [
                np.interp(at, line, np.arange(len(line)))
                for at, line in zip(wanted, across, strict=True)
            ]
        )
        sides.append(_at_rows(lid.points_mm[column], rows))
    share = (index - base)[:, None]
    return np.asarray(sides[0] * (1 - share) + sides[1] * share)
