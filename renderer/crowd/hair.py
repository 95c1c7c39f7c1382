"""Hair of the crowd's people: locks, and what hangs from them, as a mesh that the head carries.

Pure numpy, millimetres.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices
from renderer.body.normals import vertex_normals
from renderer.crowd.face_parts import FacePart
from renderer.crowd.hair_styles import STYLES, Style
from renderer.crowd.hanging import curtain, inside_tone, is_hanging
from renderer.crowd.locks import COLUMNS, HUNG_ROW, LOCKS, Locks, comb
from renderer.crowd.people import Person

# In the last channel of ``surface`` of furrows and ridges: crowd.frag gives what lies between them
# hair's highlight, and draws a strand for each share of the way.
SHEEN: Final = (0.2, 0.45)
_BESIDE: Final = 5  # columns on each side of the face


@dataclass(frozen=True)
class _Mesh:
    """Hair as it grows: points and tone per vertex, where strands are, triangles.

    The last vertices face ``inwards`` (k, 3), whatever their triangles say.
    """

    points_mm: Floats
    tone: Floats
    strand: Floats
    triangles: Indices
    inwards: Floats


def hair(person: Person, shape: Floats) -> list[FacePart]:
    """Return a person's hair; ``shape`` is the base mesh in the person's build."""
    rng = np.random.Generator(np.random.PCG64(zlib.crc32(person.body.encode())))
    style = STYLES[person.hair_style]
    locks = comb(style, shape, rng)
    mesh = _on_scalp(locks)
    if style.hangs:
        mesh = _hung(mesh, locks, shape, rng, style=style)
    normals = vertex_normals(mesh.points_mm, mesh.triangles)
    # The last row on the scalp is under the skin, and what one sees of it is lit as the tips.
    end = 1 + locks.tone.size
    normals[end - COLUMNS : end] = normals[end - 2 * COLUMNS : end - COLUMNS]
    normals[len(normals) - len(mesh.inwards) :] = mesh.inwards
    albedo = np.minimum(np.outer(mesh.tone, person.hair), 1.0)  # a strand of white hair is whiter
    surface = np.column_stack([albedo, mesh.strand])
    used, compact = np.unique(mesh.triangles, return_inverse=True)
    return [FacePart(mesh.points_mm[used], normals[used], surface[used], compact.reshape(-1, 3))]


def _on_scalp(locks: Locks) -> _Mesh:
    """Return the locks as a mesh, closed over the crown."""
    crown = locks.points_mm[0].mean(axis=0, keepdims=True)
    crown += 0.25 * np.ptp(locks.points_mm[0, :, 1]) * locks.outwards[0].mean(axis=0)
    rows = len(locks.points_mm)
    return _Mesh(
        np.concatenate([crown, locks.points_mm.reshape(-1, 3)]),
        np.concatenate([[1.0], locks.tone.ravel()]),
        np.concatenate([[np.mean(SHEEN)], np.tile(SHEEN, rows * LOCKS)]),
        np.concatenate([_cap(COLUMNS), 1 + ring(rows, COLUMNS)]),
        np.zeros((0, 3)),
    )


def _hung(
    mesh: _Mesh, locks: Locks, shape: Floats, rng: np.random.Generator, *, style: Style
) -> _Mesh:
    """Return hair of which what lies beside and behind the face hangs down over what it hides."""
    hung = np.flatnonzero(is_hanging(locks.turn))
    hung = np.roll(hung, -int(np.argmax(np.diff(hung))) - 1)  # from one temple to the other
    start = 1 + HUNG_ROW * COLUMNS + hung
    is_ridge = hung % 2 == 1
    long = curtain(
        mesh.points_mm[start],
        shape,
        rng,
        is_ridge=is_ridge,
        off_mm=style.side_mm,
        tips_mm=style.tips_mm,
    )
    number = np.concatenate([start, len(mesh.tone) + np.arange(2 * long.tone.size)])
    # Locks beside the face run forwards on the scalp: without them there is a gap to what hangs.
    hidden = np.isin((mesh.triangles - 1) % COLUMNS, hung[_BESIDE:-_BESIDE]).all(axis=1)
    hidden &= (mesh.triangles > (HUNG_ROW + 1) * COLUMNS).any(axis=1)
    both = [long.points_mm.reshape(-1, 3)] * 2
    return _Mesh(
        np.concatenate([mesh.points_mm, *both]),
        np.concatenate([mesh.tone, long.tone.ravel(), inside_tone(long.tone.ravel())]),
        np.concatenate([mesh.strand, np.tile(np.array(SHEEN)[1 * is_ridge], 2 * len(long.tone))]),
        np.concatenate([mesh.triangles[~hidden], number[long.triangles]]),
        long.inwards.reshape(-1, 3),
    )


def ring(rows: int, columns: int) -> Indices:
    """Return the triangles of rows of vertices around a closed ring, facing outwards."""
    row, column = np.divmod(np.arange((rows - 1) * columns), columns)
    a, b = row * columns + column, row * columns + (column + 1) % columns
    quads = np.stack([a, a + columns, b + columns, b], axis=1)
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _cap(columns: int) -> Indices:
    """Return the fan from the first vertex to the ring that follows it."""
    column = np.arange(columns)
    return np.stack([np.zeros_like(column), 1 + column, 1 + (column + 1) % columns], axis=1)
