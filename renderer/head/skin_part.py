"""One mesh of skin, and how two of them join. Pure numpy, world space in mm.

Each part carries what the colour of skin depends on; light and paint are put on by ``skin`` and
``skin_light``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats, Indices

SEAM_LID: Final = 0.08  # share of lid below which a patch takes on the face's light


@dataclass(frozen=True)
class SkinPart:
    """One mesh of skin: (n, 3) points and unit normals, (m, 3) triangles, and per vertex

    ``lips`` 0 to 1; ``lid`` 0 on the face to 1 on the lids, in the corners how much they cover;
    ``margin`` 1 on the wet rim of a lid; ``caruncle`` 1 on it; ``wet`` 1 where tears stand;
    ``along_mm`` (n, 2) along and across the lid.
    """

    points_mm: Floats
    normals: Floats
    triangles: Indices
    lips: Floats
    lid: Floats
    margin: Floats
    caruncle: Floats
    wet: Floats
    along_mm: Floats
    grain: Floats | None = None  # of the eye's corners: how rough they are, 0 to 1
    sclera: Floats | float = 0.0  # 1 where the conjunctiva lies on the white of the eye
    sink_mm: Floats | float = 0.0  # below the surface, so that overlapping meshes do not fight


@dataclass(frozen=True)
class Seam:
    """How a patch takes on its neighbour's values at its outer edge, so that no seam shows.

    ``weight`` (n,) of the neighbour; ``near`` (n, 4) its vertices and ``shares`` (n, 4) of them.
    """

    weight: Floats
    near: Indices
    shares: Floats

    def blend(self, own: Floats, neighbours: Floats) -> Floats:
        """Return (n, ...) values of the patch that run into the neighbour's (m, ...)."""
        flat = neighbours.reshape(len(neighbours), -1)
        beside = (flat[self.near] * self.shares[..., None]).sum(axis=1).reshape(own.shape)
        weight = self.weight.reshape((-1,) + (1,) * (own.ndim - 1))
        return np.asarray(own + weight * (beside - own))


def seam(patch: SkinPart, face: SkinPart) -> Seam:
    """Return the seam between a patch and the face around it."""
    distance, near = map(np.asarray, cKDTree(face.points_mm).query(patch.points_mm, k=4))
    shares = 1 / (distance + 0.1) ** 2
    weight = np.clip(1 - patch.lid / SEAM_LID, 0, 1)
    return Seam(weight, near, shares / shares.sum(axis=1, keepdims=True))
