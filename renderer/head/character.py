"""The main character's shape: a grown woman with a calm face, posed, her eyes at the origin.

Pure numpy. World space: millimetres, origin midway between the globes, x to the viewer's right, y
up, z towards the viewer.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Mesh, base_mesh
from renderer.body.phenotype import phenotype, target_offsets
from renderer.body.rig import Rig, fit_rig, pose_vertices, rotation
from renderer.eye.place import INTEROCULAR_MM

# MakeHuman's globes have 15 mm radius, ours 11.75: her lids meet ours when the head steps back.
SET_BACK_MM: Final = 4.9
BROW_MM: Final = 5.6
CHEEK_MM: Final = 1.8
PHENOTYPE: Final = {"gender": 0.1, "age": 0.56, "muscle": 0.5, "weight": 0.47, "proportions": 0.7}
RACES: Final = {"caucasian": 0.75, "asian": 0.13, "african": 0.12}
# Away from the average that MakeHuman starts from: an average of faces looks like a doll.
FACE: Final = {
    "eyebrows/eyebrows-trans-backward": 0.8,
    "head/head-oval": 0.4,
    "head/head-scale-vert-decr": 0.15,
    "head/head-scale-horiz-decr": 0.35,
    "chin/chin-width-decr": 0.25,
    "mouth/mouth-upperlip-height-incr": 0.25,
    "mouth/mouth-lowerlip-height-incr": 0.2,
    "nose/nose-scale-depth-decr": 0.2,
    "nose/nose-width1-decr": 0.3,
    "nose/nose-point-width-decr": 0.2,
    "neck/neck-scale-horiz-decr": 0.25,
    "asym/asym-nose-1-l": 0.12,
    "asym/asym-jaw-2-r": 0.15,
}
BOTH_SIDES: Final = {"ears/{}-ear-scale-decr": 0.35, "cheek/{}-cheek-bones-incr": 0.3}


@dataclass(frozen=True)
class Figure:
    """The posed character: every vertex of MakeHuman's mesh in world mm, and its skeleton."""

    mesh: Mesh
    vertices_mm: Floats
    rig: Rig


@functools.cache
def figure() -> Figure:
    """Return the main character, standing with her arms down."""
    mesh = base_mesh()
    face = FACE | {name.format(s): weight for name, weight in BOTH_SIDES.items() for s in "lr"}
    vertices = mesh.vertices_mm + phenotype(races=RACES, **PHENOTYPE) + target_offsets(face)
    centres = [vertices[mesh.vertices_of(f"helper-{s}-eye")].mean(axis=0) for s in "lr"]
    middle = (centres[0] + centres[1]) / 2
    vertices = (vertices - middle) * INTEROCULAR_MM / (centres[0][0] - centres[1][0])
    vertices[:, 2] -= SET_BACK_MM
    vertices[:, 2] -= _brow_ridge(vertices)
    vertices[:, 2] += _under_eyes(vertices)
    rig = fit_rig(vertices)
    return Figure(mesh, pose_vertices(vertices, rig, rotations=_arms_down()), rig)


def _brow_ridge(vertices: Floats) -> Floats:
    """Return by how many mm to push back the brow, which hangs far over MakeHuman's eyes."""
    x, y, z = vertices.T
    sideways = np.exp(-(((np.abs(x) - 24.0) / 26.0) ** 2))
    return np.where(z > 0.0, BROW_MM * sideways * np.exp(-(((y - 18.5) / 11.0) ** 2)), 0.0)


def _under_eyes(vertices: Floats) -> Floats:
    """Return by how many mm to bring forward the upper cheek, which the smaller globes bare."""
    x, y, z = vertices.T
    sideways = np.exp(-(((np.abs(x) - 38.0) / 18.0) ** 2))
    return np.where(z > -25.0, CHEEK_MM * sideways * np.exp(-(((y + 16.0) / 10.0) ** 2)), 0.0)


def _arms_down() -> dict[str, Floats]:
    """Return the turns from MakeHuman's rest pose, arms half raised, to arms at the sides."""
    turns = {}
    for side, sign in (("l", -1.0), ("r", 1.0)):
        turns[f"clavicle_{side}"] = rotation([0, 0, 1], sign * 4.0)
        turns[f"upperarm_{side}"] = rotation([0, 0, 1], sign * 34.0)
        turns[f"lowerarm_{side}"] = rotation([1, 0, 0], 14.0) @ rotation([0, 0, 1], sign * 8.0)
    return {bone: np.asarray(turn) for bone, turn in turns.items()}
