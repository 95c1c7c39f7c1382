"""Triangle meshes for other programs, and PLY files of them. Pure numpy.

Positions are in the unit of the file's index (millimetres of world space in an exported scene).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.atomic_file import write_atomically
from renderer.colour import linear_to_srgb

Floats = npt.NDArray[np.float64]
Triangles = npt.NDArray[np.integer]

_TYPES: Final = {"float": "<f4", "uchar": "u1"}


@dataclass(frozen=True)
class Mesh:
    """Triangles (m, 3), counter-clockwise seen from outside, over n vertices.

    ``positions`` and unit ``normals`` (n, 3); ``uv`` (n, 2) with v upwards, or None; ``albedo``
    (n, 3) linear Rec. 709, or None where a texture has it.
    """

    positions: Floats
    normals: Floats
    triangles: Triangles
    uv: Floats | None = None
    albedo: Floats | None = None

    @property
    def bounds(self) -> list[list[float]]:
        """The lowest and the highest corner of the box that holds every vertex."""
        ends = self.positions.min(axis=0), self.positions.max(axis=0)
        return [[round(float(x), 4) for x in end] for end in ends]

    def placed(self, matrix: Floats) -> Mesh:
        """Return the mesh moved by a rotation and shift (4, 4)."""
        turn = matrix[:3, :3]
        return replace(
            self,
            positions=self.positions @ turn.T + matrix[:3, 3],
            normals=self.normals @ turn.T,
        )


def joined(meshes: list[Mesh]) -> Mesh:
    """Return several meshes as one; all have texture coordinates, colours, or none."""
    starts = np.cumsum([0, *[len(mesh.positions) for mesh in meshes]])
    uv = [mesh.uv for mesh in meshes if mesh.uv is not None]
    albedo = [mesh.albedo for mesh in meshes if mesh.albedo is not None]
    return Mesh(
        np.concatenate([mesh.positions for mesh in meshes]),
        np.concatenate([mesh.normals for mesh in meshes]),
        np.concatenate(
            [mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]
        ),
        np.concatenate(uv) if uv else None,
        np.concatenate(albedo) if albedo else None,
    )


def write_ply(path: Path, mesh: Mesh, *, comment: str = "") -> None:
    """Write a binary PLY (Turk 1994): x y z, nx ny nz, s t, r g b linear, red green blue sRGB.

    Colours stand twice: as linear floats for renderers and as sRGB bytes, which viewers know.
    """
    columns: list[tuple[str, str, npt.NDArray[np.generic]]] = []
    vectors = (("x y z", mesh.positions), ("nx ny nz", mesh.normals), ("s t", mesh.uv))
    for names, vector in vectors:
        if vector is not None:
            columns += [(name, "float", vector[:, k]) for k, name in enumerate(names.split())]
    if mesh.albedo is not None:
        shown = np.rint(np.clip(linear_to_srgb(mesh.albedo), 0, 1) * 255)
        columns += [(name, "float", mesh.albedo[:, k]) for k, name in enumerate("rgb")]
        columns += [(name, "uchar", shown[:, k]) for k, name in enumerate(("red", "green", "blue"))]
    rows = np.zeros(len(mesh.positions), [(name, _TYPES[kind]) for name, kind, _ in columns])
    for name, _, values in columns:
        rows[name] = values
    faces = np.zeros(len(mesh.triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, mesh.triangles
    head = [
        "ply",
        "format binary_little_endian 1.0",
        *([f"comment {comment}"] if comment else []),
        f"element vertex {len(rows)}",
        *[f"property {kind} {name}" for name, kind, _ in columns],
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    write_atomically(
        path, "\n".join(head).encode("ascii") + b"\n" + rows.tobytes() + faces.tobytes()
    )
