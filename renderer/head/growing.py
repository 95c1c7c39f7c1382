"""All hair of the main character as meshes: lashes, brows, scalp hair."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import moderngl
import numpy as np

from renderer.head.brows import grow_brow
from renderer.head.face_mesh import FaceMesh
from renderer.head.hair import grow_hair
from renderer.head.hair_cap import hair_cap
from renderer.head.lashes import grow_lashes
from renderer.head.patch_space import to_world
from renderer.head.strands import StrandMesh

FACE_HAIR_BIAS_MM: Final = 1.2  # hairs nearer than this to a surface are not in its shadow
SCALP_HAIR_BIAS_MM: Final = 5.0
HEAD_MIDDLE_MM: Final = (0.0, 10.0, -85.0)
HAIR_SEED: Final = 20


def grow_all_hair(gl: moderngl.Context, face: FaceMesh) -> list[tuple[StrandMesh, float]]:
    """Grow lashes, brows and hair, each with its shadow bias in mm.

    Both sides obey the same laws; hair by hair they differ.
    """
    meshes: list[tuple[StrandMesh, float]] = []
    for eye in (0, 1):
        rng = np.random.Generator(np.random.PCG64(HAIR_SEED + eye))
        for strands in (*grow_lashes(face.lids[eye], rng), grow_brow(face.sockets[eye], rng)):
            placed = replace(strands, points_mm=to_world(strands.points_mm, eye))
            meshes.append((StrandMesh(gl, placed, rng), FACE_HAIR_BIAS_MM))
    rng = np.random.Generator(np.random.PCG64(HAIR_SEED + 2))
    scalp_hair = StrandMesh(gl, grow_hair(hair_cap(face), rng), rng, around_mm=HEAD_MIDDLE_MM)
    meshes.append((scalp_hair, SCALP_HAIR_BIAS_MM))
    return meshes
