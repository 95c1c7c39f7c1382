"""Eyes and brows of the crowd as small painted meshes of their own, moving with the head.

Pure numpy: vertex colours of a thinned face are too coarse for them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices, base_mesh
from renderer.crowd.people import Person
from renderer.crowd.scalp import Places, head_triangles, hits

GLOSSY: Final = 1.0  # the last channel of ``surface`` on wet eyes
_SEGMENTS: Final = 14
_BROW_STEPS: Final = 9


@dataclass(frozen=True)
class FacePart:
    """A small mesh: positions in mm and normals (n, 3), surface (n, 4), triangles (m, 3)."""

    positions_mm: Floats
    normals: Floats
    surface: Floats
    triangles: Indices


def eyes(person: Person, shape: Floats) -> list[FacePart]:
    """Return two caps: rings of pupil, iris, its darker rim and sclera."""
    pupil = (0.012, 0.010, 0.010)
    sclera = (0.62, 0.58, 0.54)
    rings = (
        (0.00, pupil), (0.14, pupil), (0.16, person.iris), (0.36, person.iris),
        (0.41, sclera), (0.75, sclera), (1.25, sclera),
    )  # fmt: skip
    angle = np.array([ring for ring, _ in rings])
    turn = np.arange(_SEGMENTS) / _SEGMENTS * 2 * np.pi
    cap = np.stack(
        [
            np.sin(angle)[:, None] * np.cos(turn),
            np.sin(angle)[:, None] * np.sin(turn),
            np.cos(angle)[:, None] * np.ones(_SEGMENTS),
        ],
        axis=-1,
    ).reshape(-1, 3)
    surface = np.repeat([[*colour, GLOSSY] for _, colour in rings], _SEGMENTS, axis=0)
    row, column = np.divmod(np.arange((len(rings) - 1) * _SEGMENTS), _SEGMENTS)
    a, b = row * _SEGMENTS + column, row * _SEGMENTS + (column + 1) % _SEGMENTS
    triangles = _halve(np.stack([a, a + _SEGMENTS, b + _SEGMENTS, b], axis=1))
    parts = []
    for side in "lr":
        helper = shape[base_mesh().vertices_of(f"helper-{side}-eye")]
        centre = helper.mean(axis=0)
        radius = float(np.linalg.norm(helper - centre, axis=1).mean())
        parts.append(FacePart(cap * radius + centre, cap, surface, triangles))
    return parts


def brow_colour(person: Person) -> tuple[float, ...]:
    """Return the albedo of brows: hair with skin between."""
    return tuple(0.75 * h + 0.25 * s for h, s in zip(person.hair, person.skin, strict=True))


def brows(person: Person, shape: Floats) -> list[FacePart]:
    """Return two strips on the brow ridge, thick at the nose and tapering outwards."""
    along = np.linspace(0, 1, _BROW_STEPS)
    half = 3.0 * np.sqrt(np.clip(1.02 - along, 0, 1)) * np.clip(0.35 + along * 3, 0, 1)
    middle = 750.0 + 4.0 * np.sin(along * 2.5)
    row, column = np.divmod(np.arange(2 * (_BROW_STEPS - 1)), _BROW_STEPS - 1)
    a = row * _BROW_STEPS + column
    quads = np.stack([a, a + 1, a + 1 + _BROW_STEPS, a + _BROW_STEPS], axis=1)
    surface = np.tile([*brow_colour(person), 0.0], (3 * _BROW_STEPS, 1))
    lift = np.array([0.0, 0.25, 0.97])  # outwards on the brow ridge
    parts = []
    for side in (-1.0, 1.0):
        x = side * (15.5 + 38.0 * along)
        rows = [np.stack([x, middle + sign * half], axis=1) for sign in (-1.0, 0.0, 1.0)]
        places = _on_face(np.concatenate(rows), shape)
        places += lift * np.repeat([1.0, 2.4, 1.0], _BROW_STEPS)[:, None]
        wound = quads if side > 0 else quads[:, ::-1]
        normals = np.tile(lift, (len(places), 1))
        parts.append(FacePart(places, normals, surface, _halve(wound)))
    return parts


def _on_face(places: Floats, shape: Floats) -> Floats:
    """Carry places (n, 2) of the base mesh's forehead over to a person's (n, 3)."""
    triangles = head_triangles()
    base = base_mesh().vertices_mm
    near = triangles[(np.abs(base[triangles, 1] - 750) < 45).all(axis=1)]
    near = near[(base[near, 2] > 60).all(axis=1)]
    origins = np.column_stack([places, np.zeros(len(places))])
    ahead = np.tile([0.0, 0.0, 1.0], (len(places), 1))
    way, weights = hits(np.broadcast_to(base[near], (len(places), *near.shape, 3)), origins, ahead)
    outermost = np.where(np.isfinite(way), way, -1.0).argmax(axis=1)
    found = Places(near[outermost], weights[np.arange(len(places)), outermost])
    return found.of(shape)


def _halve(quads: Indices) -> Indices:
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
