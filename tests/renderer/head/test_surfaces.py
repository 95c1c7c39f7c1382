"""What software GL would shade twice is drawn once."""

from __future__ import annotations

import moderngl
import numpy as np

from renderer.head.buffers import CellMesh
from renderer.head.face_mesh import face_mesh
from renderer.head.surfaces import skin_surfaces


def places(mesh: CellMesh) -> set[bytes]:
    """Return what tells a mesh's triangles apart: their middles."""
    return {row.tobytes() for row in mesh.points_mm[mesh.triangles].mean(axis=1).round(6)}


def test_conjunctiva_is_either_solid_or_lets_something_through(gl: moderngl.Context) -> None:
    surfaces = skin_surfaces(gl, face_mesh())
    for name in ("corner0", "corner1"):
        solid, veil = surfaces[name].mesh, surfaces[name].veil
        assert veil is not None
        assert not places(solid) & places(veil), name
        rims = np.intersect1d(solid.points_mm.round(6), veil.points_mm.round(6))
        assert len(rims), f"{name}: the two kinds do not meet"
