"""Open edges of clothes, and their hems: cloth turned in, so that nobody sees through a collar.

Pure numpy.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, Indices
from renderer.body.normals import unit

TURNED_IN_MM: Final = 26.0  # into the neck, which stands up to 18 mm behind a collar
TURNED_DOWN_MM: Final = 6.0


def open_edges(triangles: Indices) -> Indices:
    """Return directed edges (k, 2) that belong to one triangle alone."""
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, place, counts = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    return np.asarray(edges[np.sort(place[counts == 1])])


def hem(
    positions_mm: Floats, triangles: Indices, *, is_hem: npt.NDArray[np.bool_]
) -> tuple[Indices, Floats, Floats, Indices]:
    """Return what turns open edges in, to their middle, where both ends are ``is_hem`` (n,).

    Rows (k,) of the vertices that it repeats, their positions and normals, and triangles over all
    vertices, the k new ones counted on from n.
    """
    edges = open_edges(triangles)
    edges = edges[is_hem[edges].all(axis=1)]
    rows, ends = np.unique(edges, return_inverse=True)
    # Not against the normals: where a rim is jagged they point anywhere.
    inwards = unit((positions_mm[rows].mean(axis=0) - positions_mm[rows]) * [1.0, 0.0, 1.0])
    down = np.array([0.0, -TURNED_DOWN_MM, 0.0])
    inner = positions_mm[rows] + TURNED_IN_MM * inwards + down
    facing = unit(inwards + np.array([0.0, 1.5, 0.0]))
    start, end = ends.reshape(-1, 2).T + len(positions_mm)
    count = len(rows)
    quads = [(end, start, start + count), (end, start + count, end + count)]
    return (
        np.concatenate([rows, rows]),
        np.concatenate([positions_mm[rows], inner]),
        np.concatenate([facing, facing]),
        np.concatenate([np.stack(corners, axis=1) for corners in quads]),
    )
