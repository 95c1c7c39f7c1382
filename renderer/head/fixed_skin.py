"""The skin that lids do not move: head and neck around the eyes, and the sockets lids lie on.

Pure numpy, world space in mm.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final

import imageio.v3 as iio
import numpy as np

from renderer.body.makehuman import Floats, Indices, Mesh, data_folder
from renderer.body.normals import vertex_normals
from renderer.body.subdivide import subdivide, triangles_of
from renderer.head.character import SET_BACK_MM, Figure, figure
from renderer.head.lid_outline import OUTLINE_MM
from renderer.head.lid_socket import Socket
from renderer.head.patch_space import to_patch
from renderer.head.skin_part import SkinPart

FINE_BOX_MM: Final = ((-86.0, -52.0, -62.0), (86.0, 50.0, 60.0))  # what close views can show
LOWEST_MM: Final = -215.0  # below it the collar hides the neck
SHOULDER_MM: Final = (75.0, -160.0)  # further out and down the sweater may lie below the skin
SOCKET_MM: Final = 18.2  # around MakeHuman's globe: everything nearer is socket or inner lid


@dataclass(frozen=True)
class FixedSkin:
    """What the lids do not move."""

    fine: SkinPart
    rest: SkinPart
    coarse: SkinPart
    sockets: tuple[Socket, Socket]


@functools.cache
def fixed_skin() -> FixedSkin:
    """Return the head's skin around the eyes, smooth near them and coarse from further away."""
    vertices, quads = _head_cage(figure())
    level1, quads1 = subdivide(vertices, quads)
    level2, quads2 = subdivide(level1, quads1)
    sockets = (_socket(level2, quads2, 0), _socket(level2, quads2, 1))
    normals1 = vertex_normals(level1[:, :3], triangles_of(quads1))
    normals2 = vertex_normals(level2[:, :3], triangles_of(quads2))
    quads1 = quads1[~_in_eye(level1, quads1)]
    quads2 = quads2[~_in_eye(level2, quads2)]
    near1, near2 = _in_box(level1, quads1, inset_mm=6.0), _in_box(level2, quads2)
    return FixedSkin(
        fine=_part(level2, quads2[near2], normals=normals2),
        rest=_part(level1, quads1[~near1], normals=normals1),
        coarse=_part(level1, quads1, normals=normals1),
        sockets=sockets,
    )


def _head_cage(body: Figure) -> tuple[Floats, Indices]:
    """Return head and neck with the lips' mask as a fourth column, mouth's inside taken away."""
    mesh = body.mesh
    quads = mesh.quads[mesh.quads_of("body")]
    x, y, _ = body.vertices_mm[quads].mean(axis=1).T
    is_head = (y > LOWEST_MM) & ((np.abs(x) < SHOULDER_MM[0]) | (y > SHOULDER_MM[1]))
    column = np.column_stack([body.vertices_mm, _mask(mesh, "lips")])
    return column, quads[is_head]


def _mask(mesh: Mesh, name: str) -> Floats:
    """Sample one of MakeHuman's region masks at the mesh's vertices, 0 to 1."""
    picture = iio.imread(data_folder() / "mpfb2" / "textures" / f"mpfb_{name}.jpg") / 255.0
    rows = np.clip((1 - mesh.uv[:, 1]) * picture.shape[0], 0, picture.shape[0] - 1).astype(int)
    columns = np.clip(mesh.uv[:, 0] * picture.shape[1], 0, picture.shape[1] - 1).astype(int)
    values = np.zeros(len(mesh.vertices_mm))
    values[mesh.quads.ravel()] = picture[rows, columns][mesh.uv_quads.ravel()]
    return values


def _socket(level: Floats, quads: Indices, eye: int) -> Socket:
    points = level[:, :3]
    normals = vertex_normals(points, triangles_of(quads))
    local = to_patch(points, eye)
    x, y, z = local.T
    outside = np.linalg.norm(local + [0.0, 0.0, SET_BACK_MM], axis=1) > SOCKET_MM
    near = (np.abs(y) < 34.0) & (x > -31.0) & (x < 36.0) & (z > -25.0)
    return Socket(local[outside & near & (normals[:, 2] > 0.05)])


def _in_eye(level: Floats, quads: Indices) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return which quads the patches replace: inside the outline, or in the socket behind.

    Quads on the outline stay and lap over the patches: a view that grazes the cheek must not see
    between the two.
    """
    inside = np.zeros(len(quads), dtype=bool)
    temple, nose, up, down = OUTLINE_MM
    for eye in (0, 1):
        x, y, z = np.moveaxis(to_patch(level[quads][:, :, :3], eye), -1, 0)
        ratio = (x / np.where(x > 0, temple, nose)) ** 2 + (y / np.where(y > 0, up, down)) ** 2
        inside |= ((ratio < 1.0) & (z > -40.0)).all(axis=1)
    return inside


def _in_box(
    level: Floats, quads: Indices, *, inset_mm: float = 0.0
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return which quads close views can show; an inset lets the two meshes overlap."""
    centre = level[quads][:, :, :3].mean(axis=1)
    low, high = np.array(FINE_BOX_MM) + np.array([[inset_mm], [-inset_mm]])
    return np.asarray(((centre > low) & (centre < high)).all(axis=1))


def _part(level: Floats, quads: Indices, *, normals: Floats) -> SkinPart:
    used, rows = np.unique(quads, return_inverse=True)
    triangles = triangles_of(rows.reshape(-1, 4))
    points = level[used, :3]
    zero = np.zeros(len(points))
    return SkinPart(
        points,
        normals[used],
        triangles,
        np.clip(level[used, 3], 0, 1),
        zero,
        zero,
        zero,
        zero,
        np.zeros((len(points), 2)),
    )
