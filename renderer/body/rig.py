"""Skeletons of MakeHuman's people: joints fitted to a shape, skin weights, posing.

Pure numpy, CC0 data read through ``renderer.body.makehuman``. Rotations are given in world
axes about a bone's head, relative to its parent: x pitches forwards (nod), y turns, z leans.
"""

from __future__ import annotations

import functools
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, Indices, base_mesh, data_folder


@dataclass(frozen=True)
class Rig:
    """A skeleton fitted to one shape, parents before children.

    ``heads_mm`` and ``tails_mm`` (b, 3); ``parents`` (b,), -1 for the root; ``weights`` (n, b)
    share every vertex, helpers included, among the bones and sum to 1.
    """

    names: tuple[str, ...]
    parents: Indices
    heads_mm: Floats
    tails_mm: Floats
    weights: npt.NDArray[np.float32]

    def index(self, name: str) -> int:
        """Return a bone's number; raises ValueError naming the bones there are."""
        if name not in self.names:
            raise ValueError(f'no bone "{name}"; choose one of {", ".join(self.names)}')
        return self.names.index(name)


def fit_rig(vertices_mm: Floats, *, name: str = "game_engine") -> Rig:
    """Place a rig's joints in a shape (n, 3) of the base mesh.

    ``name``: a rig of mpfb2/rigs/standard, such as game_engine (53 bones) or default (163).
    """
    bones = _bones(name)
    names = _parents_first(bones)
    number = {bone: row for row, bone in enumerate(names)}
    return Rig(
        names=names,
        parents=np.array([number.get(bones[bone]["parent"], -1) for bone in names]),
        heads_mm=np.array([_joint(bones[bone]["head"], vertices_mm) for bone in names]),
        tails_mm=np.array([_joint(bones[bone]["tail"], vertices_mm) for bone in names]),
        weights=_weights(name, names),
    )


def bone_transforms(
    rig: Rig, rotations: Mapping[str, Floats], *, shift_mm: Floats | None = None
) -> Floats:
    """Return the (b, 4, 4) transforms that carry each bone from rest to a pose.

    ``rotations``: 3 x 3 matrices by bone name, absent ones stay; ``shift_mm`` moves the whole body.
    """
    turns = {rig.index(name): np.asarray(turn) for name, turn in rotations.items()}
    transforms = np.tile(np.eye(4), (len(rig.names), 1, 1))
    for bone, parent in enumerate(rig.parents):
        local = np.eye(4)
        if bone in turns:
            local[:3, :3] = turns[bone]
            local[:3, 3] = rig.heads_mm[bone] - turns[bone] @ rig.heads_mm[bone]
        transforms[bone] = transforms[parent] @ local if parent >= 0 else local
    if shift_mm is not None:
        transforms[:, :3, 3] += shift_mm
    return transforms


def skin_vertices(vertices_mm: Floats, transforms: Floats, *, weights: npt.ArrayLike) -> Floats:
    """Return vertices (n, 3) blended linearly between bone transforms by ``weights`` (n, b)."""
    weights = np.asarray(weights)
    turned = np.einsum("vb,bij->vij", weights, transforms[:, :3, :3], optimize=True)
    moved = weights @ transforms[:, :3, 3]
    return np.asarray(np.einsum("vij,vj->vi", turned, vertices_mm) + moved)


def pose_vertices(
    vertices_mm: Floats,
    rig: Rig,
    *,
    rotations: Mapping[str, Floats],
    shift_mm: Floats | None = None,
) -> Floats:
    """Return a shape's vertices (n, 3) in mm in a pose given by bone rotations."""
    transforms = bone_transforms(rig, rotations, shift_mm=shift_mm)
    return skin_vertices(vertices_mm, transforms, weights=rig.weights)


def rotation(axis: npt.ArrayLike, angle_deg: float) -> Floats:
    """Return the 3 x 3 rotation about an axis (right-hand rule), angle in degrees."""
    x, y, z = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(angle_deg)
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return np.asarray(turn)


@functools.cache
def _bones(name: str) -> dict[str, Any]:
    folder = data_folder() / "mpfb2" / "rigs" / "standard"
    path = folder / f"rig.{name}.json"
    if not path.is_file():
        known = sorted(found.name.split(".")[1] for found in folder.glob("rig.*.json"))
        raise ValueError(f'unknown rig "{name}"; choose one of {", ".join(known)}')
    bones = json.loads(path.read_text(encoding="utf-8"))
    return dict(bones.get("bones", bones))


def _parents_first(bones: Mapping[str, Any]) -> tuple[str, ...]:
    ordered: list[str] = []
    waiting = list(bones)
    while waiting:
        ready = [bone for bone in waiting if bones[bone]["parent"] in ("", *ordered)]
        ordered += ready
        waiting = [bone for bone in waiting if bone not in ready]
    return tuple(ordered)


def _joint(place: Mapping[str, Any], vertices_mm: Floats) -> Floats:
    """Return a joint's place: the mean of a joint cube or of named vertices."""
    if place["strategy"] == "CUBE":
        rows = base_mesh().vertices_of(place["cube_name"])
    elif place["strategy"] == "MEAN":
        rows = np.array(place["vertex_indices"])
    else:
        rows = np.array([place["vertex_index"]])
    return np.asarray(vertices_mm[rows].mean(axis=0))


@functools.cache
def _weights(name: str, names: tuple[str, ...]) -> npt.NDArray[np.float32]:
    path = data_folder() / "mpfb2" / "rigs" / "standard" / f"weights.{name}.json"
    table = json.loads(path.read_text(encoding="utf-8"))["weights"]
    weights = np.zeros((len(base_mesh().vertices_mm), len(names)), dtype=np.float32)
    for column, bone in enumerate(names):
        for vertex, weight in table.get(bone, []):
            weights[vertex, column] = weight
    total = weights.sum(axis=1)
    weights[total == 0, 0] = 1.0  # joint cubes and such follow the root
    weights /= weights.sum(axis=1, keepdims=True)
    return weights
