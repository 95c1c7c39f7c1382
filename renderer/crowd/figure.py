"""A person's mesh of a few thousand triangles with a skeleton, from MakeHuman's base mesh.

Pure numpy: pieces are thinned, pushed outwards and joined; eyes, brows and hair come on top.
Rest pose, millimetres, facing +z.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from renderer.body.decimate import decimate
from renderer.body.makehuman import Floats, Indices, base_mesh
from renderer.body.normals import vertex_normals
from renderer.body.phenotype import phenotype, target_offsets
from renderer.body.rig import Rig, fit_rig
from renderer.crowd.dress import pieces
from renderer.crowd.face_parts import FacePart, brows, eyes
from renderer.crowd.hair import hair
from renderer.crowd.hems import hem
from renderer.crowd.people import Person
from renderer.crowd.pieces import PARTS, Piece

BONES: Final = (
    "Root", "pelvis", "spine_01", "spine_02", "spine_03", "neck_01", "head",
    "clavicle_l", "upperarm_l", "lowerarm_l", "hand_l",
    "clavicle_r", "upperarm_r", "lowerarm_r", "hand_r",
    "thigh_l", "calf_l", "foot_l", "ball_l", "thigh_r", "calf_r", "foot_r", "ball_r",
)  # fmt: skip


OUTLINE_TRIANGLES: Final = 1100


@dataclass(frozen=True)
class Body:
    """A person's mesh in rest pose with the skeleton of BONES.

    ``positions_mm`` and ``normals`` (n, 3); ``surface`` (n, 4) linear albedo and gloss; ``bones``
    and ``weights`` (n, 4); ``triangles`` (m, 3), ``outline`` fewer of them for the shadow;
    ``parts`` (n,) which of PARTS a vertex belongs to; ``rig`` for posing, its bones those of BONES.
    """

    positions_mm: Floats
    normals: Floats
    surface: Floats
    bones: Indices
    weights: Floats
    triangles: Indices
    outline: Indices
    parts: Indices
    rig: Rig


def build_body(person: Person) -> Body:
    """Build one person's mesh and skeleton; takes some seconds, so keep the result."""
    shape = base_mesh().vertices_mm + phenotype(races=person.races, **person.build)
    shape += target_offsets(
        {f"faceunits/mouthSmile{side}": person.smile for side in ("Left", "Right")}
    )
    shape = shape * (person.stature_mm / np.ptp(shape[base_mesh().vertices_of("body"), 1]))
    rig = fit_rig(shape)
    keep = [rig.index(name) for name in BONES]
    weights = _fold_fingers(rig)
    dressed = pieces(person)
    parts = [_thin(shape, piece) for piece in dressed]
    rows = np.concatenate([part[0] for part in parts])
    starts = np.cumsum([0, *[len(part[0]) for part in parts]])
    bones, shares = _four_strongest(weights[rows])
    small = Rig(
        names=BONES,
        parents=np.array([_parent_among(rig, bone, keep) for bone in keep]),
        heads_mm=rig.heads_mm[keep],
        tails_mm=rig.tails_mm[keep],
        weights=weights[rows].astype(np.float32),
    )
    body = Body(
        positions_mm=np.concatenate([part[1] for part in parts]),
        normals=np.concatenate([part[2] for part in parts]),
        surface=np.concatenate([part[3] for part in parts]),
        triangles=np.concatenate(
            [part[4] + start for part, start in zip(parts, starts, strict=False)]
        ),
        outline=np.zeros((0, 3), dtype=np.int64),
        parts=np.repeat([PARTS.index(p.part) for p in dressed], [len(p[0]) for p in parts]),
        rig=small,
        bones=bones,
        weights=shares,
    )
    found = {"eyes": eyes, "brows": brows, "hair": hair}
    for name, made in ((name, make(person, shape)) for name, make in found.items()):
        for part in made:
            body = _with_part(body, part, name)
    outline = decimate(body.positions_mm, body.triangles, target=OUTLINE_TRIANGLES)
    return replace(body, outline=outline)


def _thin(shape: Floats, piece: Piece) -> tuple[Indices, Floats, Floats, Floats, Indices]:
    """Return base rows, positions, normals, surface and triangles of a thinned piece."""
    used = np.unique(piece.triangles)
    numbers = np.full(len(shape), -1)
    numbers[used] = np.arange(len(used))
    triangles = numbers[piece.triangles]
    outwards = vertex_normals(shape[used], triangles)
    positions = shape[used] + outwards * piece.push_mm[used, None]
    importance = np.ones(len(shape)) if piece.importance is None else piece.importance
    fewer = _thinned(used.tobytes(), triangles.tobytes(), importance[used].tobytes(), piece.target)
    normals = vertex_normals(positions, triangles)
    kept, compact = np.unique(fewer, return_inverse=True)
    whole = compact.reshape(-1, 3)
    rows, positions, normals = used[kept], positions[kept], normals[kept]
    if piece.turned_in_above_mm is not None:
        is_hem = base_mesh().vertices_mm[rows, 1] > piece.turned_in_above_mm
        again, places, facing, more = hem(positions, whole, is_hem=is_hem)
        rows = np.concatenate([rows, rows[again]])
        positions, normals = np.concatenate([positions, places]), np.concatenate([normals, facing])
        whole = np.concatenate([whole, more])
    return rows, positions, normals, piece.surface[rows], whole


@functools.cache
def _thinned(rows: bytes, triangles: bytes, importance: bytes, target: int) -> Indices:
    """Thin a part of the base mesh: the same choice of vertices fits everybody."""
    return decimate(
        base_mesh().vertices_mm[np.frombuffer(rows, dtype=np.int64)],
        np.frombuffer(triangles, dtype=np.int64).reshape(-1, 3),
        target=target,
        importance=np.frombuffer(importance),
    )


def _fold_fingers(rig: Rig) -> Floats:
    """Return weights (n, len(BONES)): bones that BONES leaves out pass theirs to their parents."""
    weights = rig.weights.astype(float).copy()
    for bone in reversed(range(len(rig.names))):
        if rig.names[bone] not in BONES:
            weights[:, rig.parents[bone]] += weights[:, bone]
    return np.stack([weights[:, rig.index(name)] for name in BONES], axis=1)


def _parent_among(rig: Rig, bone: int, keep: list[int]) -> int:
    parent = int(rig.parents[bone])
    return keep.index(parent) if parent >= 0 else -1


def _four_strongest(weights: Floats) -> tuple[Indices, Floats]:
    bones = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    strongest = np.take_along_axis(weights, bones, axis=1)
    return bones, strongest / strongest.sum(axis=1, keepdims=True)


def _with_part(body: Body, part: FacePart, name: str) -> Body:
    """Append a part that follows the head alone."""
    count = len(part.positions_mm)
    head = np.zeros((count, 4), dtype=np.int64)
    head[:, 0] = BONES.index("head")
    return replace(
        body,
        positions_mm=np.concatenate([body.positions_mm, part.positions_mm]),
        normals=np.concatenate([body.normals, part.normals]),
        surface=np.concatenate([body.surface, part.surface]),
        bones=np.concatenate([body.bones, head]),
        weights=np.concatenate([body.weights, np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))]),
        triangles=np.concatenate([body.triangles, part.triangles + len(body.positions_mm)]),
        parts=np.concatenate([body.parts, np.full(count, PARTS.index(name))]),
    )
