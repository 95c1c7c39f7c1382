"""Spheres that hold the crowd, and which of them a view may show. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.crowd.figure import BONES
from renderer.crowd.figures import Figure
from renderer.crowd.turns import Floats, applied

Bools = npt.NDArray[np.bool_]

# In front of the camera and within the picture's sides: rows and signs of a world-to-clip matrix.
_SIDES: Final = np.array(
    [[0, 0, 0, 1], [1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1]], dtype=float
)


@dataclass(frozen=True)
class Bounds:
    """Spheres of figures, those of each side by side: centres (n, 3), radii (n,).

    ``firsts`` (f,) are the numbers of each figure's first sphere.
    """

    centres_mm: Floats
    reach_mm: Floats
    firsts: npt.NDArray[np.int64]

    def in_view(self, world_to_clip: npt.NDArray[np.floating]) -> Bools:
        """Return (f,) whether a view may show a figure."""
        inside = in_view(self.centres_mm, self.reach_mm, world_to_clip=world_to_clip)
        return np.logical_or.reduceat(inside, self.firsts)


class Spheres:
    """The spheres at rest that hold figures: ``carried`` to a pose."""

    def __init__(self, figures: Sequence[Figure]) -> None:
        spheres = [figure.spheres for figure in figures]
        counts = [len(radii) for _, radii, _ in spheres]
        self._firsts = np.cumsum([0, *counts])[:-1]
        self._centres_mm = np.concatenate([np.zeros((0, 3)), *(own for own, _, _ in spheres)])
        self._reach_mm = np.concatenate([np.zeros(0), *(radii for _, radii, _ in spheres)])
        self._bones = [
            number * len(BONES) + bone
            for number, (_, _, bones) in enumerate(spheres)
            for bone in bones.tolist()
        ]

    def carried(self, bones: Floats) -> Bounds:
        """Return where everybody's bones (f, b, 4, 4) carry them."""
        carriers = bones.reshape(-1, 4, 4)[self._bones]
        centres = applied(carriers[:, :3, :3], self._centres_mm) + carriers[:, :3, 3]
        return Bounds(centres, self._reach_mm, self._firsts)


def in_view(
    centres_mm: Floats, reach_mm: Floats, *, world_to_clip: npt.NDArray[np.floating]
) -> Bools:
    """Return (k,) whether spheres around centres (k, 3) reach into what a view shows.

    Never False for a sphere that does: only spheres wholly beyond a side, or behind, are left out.
    """
    sides = _SIDES @ np.asarray(world_to_clip, dtype=float)
    sides /= np.linalg.norm(sides[:, :3], axis=1, keepdims=True)
    inwards = centres_mm @ sides[:, :3].T + sides[:, 3]
    return np.asarray((inwards > -reach_mm[:, None]).all(axis=1))
