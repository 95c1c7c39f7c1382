"""What stands in a scene as meshes, read back from the GPU: what is exported is what is drawn.

World space in mm. Light is left out: albedo goes with the vertices, another renderer lights it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

import moderngl
import numpy as np

from renderer.body.normals import unit
from renderer.crowd.crowd import Crowd
from renderer.exchange.meshes import Floats, Mesh, Triangles, joined
from renderer.head.buffers import STATIC, CellMesh
from renderer.head.head import Head
from renderer.head.strands import LAYOUT, StrandMesh

# The head's surfaces by the names of its own table; what is not listed keeps its own.
NAMES: Final = {
    "fine": "face",
    "rest": "head",
    "patch0": "lids_left",
    "patch1": "lids_right",
    "corner0": "corners_left",
    "corner1": "corners_right",
    "cloth": "sweater",
    "cap": "hair_mass",
}
DISTANT: Final = ("coarse",)  # drawn instead of others from far away
TUBE_SIDES: Final = 5
BROW_Y_MM: Final = 12.0  # above it a hair before the face belongs to a brow, below to the lashes


def head_meshes(head: Head) -> Iterator[tuple[str, Mesh]]:
    """Yield the main character's surfaces by name: skin, lids, corners of the eyes, clothes."""
    for name, surface in head._surfaces.items():
        if name not in DISTANT:
            parts = [read_cells(mesh) for mesh in (surface.mesh, surface.veil) if mesh is not None]
            yield NAMES.get(name, name), joined(parts)


def hair_meshes(head: Head) -> Iterator[tuple[str, Mesh]]:
    """Yield lashes, brows and hair by name, every hair a tube that tapers to its tip."""
    groups: dict[str, list[Mesh]] = {}
    for strands, _ in head._hair:
        mesh = read_strands(strands)
        if len(mesh.positions):  # else soft shadows of hairs, which are no things
            groups.setdefault(_place(mesh), []).append(mesh)
    for name, parts in groups.items():
        yield name, joined(parts)


def crowd_meshes(crowd: Crowd, time_s: float) -> Iterator[tuple[str, Mesh]]:
    """Yield the other characters by name, as they stand at a time."""
    if not crowd.figures:
        return
    rows = crowd.vertices(time_s).astype(np.float64)
    for number, figure in enumerate(crowd.figures):
        body = figure.body
        part = slice(figure.first_vertex, figure.first_vertex + len(body.positions_mm))
        yield (
            f"crowd_{number + 1}_{figure.member.person.name.lower()}",
            Mesh(rows[part, :3], unit(rows[part, 3:]), body.triangles, albedo=body.surface[:, :3]),
        )


def read_cells(mesh: CellMesh) -> Mesh:
    """Read a surface of the head back: positions, normals, albedo."""
    rows = _columns(mesh._static, *STATIC)
    triangles = np.frombuffer(mesh._index.read(), np.int32).reshape(-1, 3)
    normals = _without_gaps(unit(rows["in_normal"]), triangles)
    return Mesh(rows["in_position"], normals, triangles, albedo=rows["in_albedo"])


def _without_gaps(normals: Floats, triangles: Triangles) -> Floats:
    """Give vertices without a normal, where a surface ends in a point, that of their neighbours."""
    for vertex in np.flatnonzero(np.linalg.norm(normals, axis=1) < 0.5):
        beside = triangles[(triangles == vertex).any(axis=1)].ravel()
        normals[vertex] = unit(normals[beside].sum(axis=0))
    return normals


def read_strands(strands: StrandMesh) -> Mesh:
    """Read hairs back as tubes: each as thick as its ribbon is wide, pointed at its tip."""
    rows = _columns(strands._vertices, *LAYOUT)
    ribbon = rows["in_ribbon"]
    middle = ribbon[:, 0] < 0  # either side of a ribbon has the same middle line
    along = ribbon[middle, 2]
    ends = np.flatnonzero(np.diff(along) < 0)
    count = int(ends[0]) + 1 if len(ends) else len(along)
    colour = rows["in_colour"][middle].reshape(-1, count, rows["in_colour"].shape[1])
    # A fourth channel above 0 marks the soft shadow of a hair.
    is_hair = colour[:, 0, 3] <= 0 if colour.shape[2] > 3 else np.ones(len(colour), bool)
    return tubes(
        rows["in_position"][middle].reshape(-1, count, 3)[is_hair],
        ribbon[middle, 1].reshape(-1, count)[is_hair],
        colour[is_hair, :, :3],
    )


def tubes(points_mm: Floats, radius_mm: Floats, colour: Floats, *, sides: int = TUBE_SIDES) -> Mesh:
    """Return hairs (n, k, 3) as tubes; ``radius_mm`` (n, k) at the root shrinks to the tip."""
    count, steps, _ = points_mm.shape
    tangent = np.gradient(points_mm, axis=1)
    tangent = unit(tangent.reshape(-1, 3)).reshape(points_mm.shape)
    # Any direction across will do; the axis that the root leaves most is never along the hair.
    least = np.eye(3)[np.abs(tangent[:, 0]).argmin(axis=1)][:, None]
    side = unit(np.cross(tangent, least).reshape(-1, 3)).reshape(points_mm.shape)
    other = np.cross(tangent, side)
    angle = 2 * np.pi * np.arange(sides) / sides
    outward = np.cos(angle)[:, None] * side[:, :, None] + np.sin(angle)[:, None] * other[:, :, None]
    taper = np.maximum(1.0 - np.linspace(0.0, 1.0, steps) ** 2, 0.02)  # as shaders/hair.vert
    places = points_mm[:, :, None] + outward * (radius_mm * taper)[..., None, None]
    hair, step, this = np.meshgrid(
        np.arange(count), np.arange(steps - 1), np.arange(sides), indexing="ij"
    )
    first = (hair * steps + step) * sides
    a, b = first + this, first + (this + 1) % sides
    quads = np.stack([a, b, b + sides, a + sides], axis=-1).reshape(-1, 4)
    return Mesh(
        places.reshape(-1, 3),
        outward.reshape(-1, 3),
        np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]),
        albedo=np.repeat(colour.reshape(-1, 3), sides, axis=0),
    )


def _place(mesh: Mesh) -> str:
    """Name hairs by where they grow: lashes and brow of an eye, or the scalp."""
    x, y, z = mesh.positions.mean(axis=0)
    if z < -20.0:
        return "hair"
    return ("brow" if y > BROW_Y_MM else "lashes") + ("_left" if x < 0 else "_right")


def _columns(buffer: moderngl.Buffer, layout: str, names: Sequence[str]) -> dict[str, Floats]:
    """Split a vertex buffer of floats by its layout, such as "3f 3f"."""
    widths = [int(part[:-1]) for part in layout.split()]
    rows = np.frombuffer(buffer.read(), np.float32).reshape(-1, sum(widths)).astype(np.float64)
    ends = np.cumsum(widths)
    return {
        name: rows[:, end - width : end]
        for name, width, end in zip(names, widths, ends, strict=True)
    }
