"""The triangles of a mesh while its vertices vanish one by one into their neighbours."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Indices = npt.NDArray[np.int64]


class LivingMesh:
    """Triangles (m, 3) over ``n`` vertices, and which of them touch each vertex.

    A triangle that has vanished is an empty list, so rows keep their numbers.
    """

    def __init__(self, triangles: Indices, n: int) -> None:
        self.triangles: list[list[int]] = triangles.tolist()
        self.around: list[set[int]] = [set() for _ in range(n)]
        for row, corners in enumerate(self.triangles):
            for corner in corners:
                self.around[corner].add(row)

    def neighbours(self, vertex: int) -> set[int]:
        """Return the vertices that share an edge with this one."""
        return {other for row in self.around[vertex] for other in self.triangles[row]} - {vertex}

    def merge(self, gone: int, kept: int) -> int:
        """Let one vertex of an edge vanish into the other; return how many triangles vanish."""
        shared = self.around[gone] & self.around[kept]
        for row in shared:
            for corner in self.triangles[row]:
                self.around[corner].discard(row)
            self.triangles[row] = []
        for row in self.around[gone]:
            self.triangles[row] = [kept if k == gone else k for k in self.triangles[row]]
            self.around[kept].add(row)
        self.around[gone] = set()
        return len(shared)

    def left(self) -> Indices:
        """Return the triangles that are left (m, 3)."""
        return np.array([row for row in self.triangles if row], dtype=np.int64)
