"""The main character's skin as meshes: smooth face, fine lid patches, corners of the eyes.

Pure numpy, world space in mm. Each part carries what the colour of skin depends on; light and
paint are put on by ``skin`` and ``skin_light``.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Final

import imageio.v3 as iio
import numpy as np
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats, Indices, Mesh, data_folder
from renderer.body.normals import unit, vertex_normals
from renderer.body.subdivide import subdivide
from renderer.camera import eye_centre_mm
from renderer.head import lid_fit
from renderer.head.caruncle import caruncle, outer_membrane
from renderer.head.character import SET_BACK_MM, Figure, figure
from renderer.head.lid_outline import OUTLINE_MM
from renderer.head.lid_pose import STRAIGHT, LidPose
from renderer.head.lid_socket import Socket

FINE_BOX_MM: Final = ((-86.0, -52.0, -62.0), (86.0, 50.0, 60.0))  # what close views can show
LOWEST_MM: Final = -215.0  # below it the collar hides the neck
SHOULDER_MM: Final = (75.0, -160.0)  # further out and down the sweater may lie below the skin
SEAM_LID: Final = 0.08  # share of lid below which a patch takes on the face's light
SEAM_SINK_MM: Final = 0.12  # the patches' last rings dive under the face
SOCKET_MM: Final = 18.2  # around MakeHuman's globe: everything nearer is socket or inner lid


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
class FaceMesh:
    """All skin: ``fine`` with ``rest`` for close views, ``coarse`` from further away."""

    fine: SkinPart
    rest: SkinPart
    coarse: SkinPart
    patches: tuple[SkinPart, SkinPart]
    corners: tuple[SkinPart, SkinPart]
    lids: tuple[lid_fit.LidPatch, lid_fit.LidPatch]
    sockets: tuple[Socket, Socket]


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


LidPoses = tuple[LidPose, LidPose]
BOTH_STRAIGHT: Final[LidPoses] = (STRAIGHT, STRAIGHT)


@dataclass(frozen=True)
class _Face:
    """What the lids do not move."""

    fine: SkinPart
    rest: SkinPart
    coarse: SkinPart
    sockets: tuple[Socket, Socket]


@functools.lru_cache(maxsize=8)
def face_mesh(poses: LidPoses = BOTH_STRAIGHT) -> FaceMesh:
    """Build the skin of the main character with the lids of the viewer's left and right eye."""
    face = _face()
    lids = (
        lid_fit.fit_lids(face.sockets[0], poses[0]),
        lid_fit.fit_lids(face.sockets[1], poses[1]),
    )
    patches = [_patch(lids[eye], eye) for eye in (0, 1)]
    patches = [
        replace(patch, normals=unit(seam(patch, face.fine).blend(patch.normals, face.fine.normals)))
        for patch in patches
    ]
    return FaceMesh(
        fine=face.fine,
        rest=face.rest,
        coarse=face.coarse,
        patches=(patches[0], patches[1]),
        corners=(_corners(0, poses[0]), _corners(1, poses[1])),
        lids=lids,
        sockets=face.sockets,
    )


@functools.cache
def _face() -> _Face:
    vertices, quads = _head_cage(figure())
    level1, quads1 = subdivide(vertices, quads)
    level2, quads2 = subdivide(level1, quads1)
    sockets = (_socket(level2, quads2, 0), _socket(level2, quads2, 1))
    normals1 = vertex_normals(level1[:, :3], triangles_of(quads1))
    normals2 = vertex_normals(level2[:, :3], triangles_of(quads2))
    quads1 = quads1[~_in_eye(level1, quads1)]
    quads2 = quads2[~_in_eye(level2, quads2)]
    near1, near2 = _in_box(level1, quads1, inset_mm=6.0), _in_box(level2, quads2)
    return _Face(
        fine=_part(level2, quads2[near2], normals=normals2),
        rest=_part(level1, quads1[~near1], normals=normals1),
        coarse=_part(level1, quads1, normals=normals1),
        sockets=sockets,
    )


def to_world(points: Floats, eye: int) -> Floats:
    """Carry patch space (temple at +x) of the viewer's left (0) or right (1) eye to world."""
    return np.asarray(points * [1.0 if eye else -1.0, 1.0, 1.0] + eye_centre_mm(eye))


def to_patch(points: Floats, eye: int) -> Floats:
    """Carry world space to patch space."""
    return np.asarray((points - eye_centre_mm(eye)) * [1.0 if eye else -1.0, 1.0, 1.0])


def triangles_of(quads: Indices) -> Indices:
    """Split quads (m, 4) into triangles (2 m, 3)."""
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


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


def _patch(lid: lid_fit.LidPatch, eye: int) -> SkinPart:
    around, along, _ = lid.points_mm.shape
    points = to_world(lid.points_mm.reshape(-1, 3), eye)
    triangles = triangles_of(lid_fit.grid_quads(around, along))
    if eye == 0:
        triangles = triangles[:, ::-1]
    across = lid.across_mm
    edge = across[:, lid.rim_row][:, None]
    # Shut lids show nothing of their margins.
    shown = 1.0 - 0.35 * lid.pose.blink
    margin = 1.0 - _ramp(across, edge * 0.75 * shown, edge * 1.15 * shown)
    wet = 1.0 - _ramp(across, edge * 0.08, edge * 0.34)
    beyond = across - edge
    total = beyond[:, -1:]
    fade = 1.0 - _ramp(beyond, 0.25 * total, 0.85 * total)
    turn = np.broadcast_to(np.arange(around)[:, None] * (68.0 / around), across.shape)
    zero = np.zeros(points.shape[0])
    return SkinPart(
        points,
        vertex_normals(points, triangles),
        triangles,
        zero,
        fade.ravel(),
        margin.ravel(),
        zero,
        wet.ravel(),
        np.stack([turn, across], axis=-1).reshape(-1, 2),
        sink_mm=(SEAM_SINK_MM * (np.arange(along) >= along - 3) * np.ones((around, 1))).ravel(),
    )


def _ramp(x: Floats, start: Floats, end: Floats) -> Floats:
    t = np.clip((x - start) / (end - start), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))


def _corners(eye: int, pose: LidPose) -> SkinPart:
    inner, outer = caruncle(pose), outer_membrane(pose)
    points = to_world(np.concatenate([inner.points_mm, outer.points_mm]), eye)
    triangles = triangles_of(np.concatenate([inner.quads, outer.quads + len(inner.points_mm)]))
    if eye == 0:
        triangles = triangles[:, ::-1]
    one = np.ones(len(points))
    return SkinPart(
        points,
        vertex_normals(points, triangles),
        triangles,
        0 * one,
        np.concatenate([inner.cover, outer.cover]),
        one,
        np.concatenate([inner.pink, outer.pink]),
        one,
        points[:, :2].copy(),
        grain=np.concatenate([inner.grain, outer.grain]),
        sclera=np.concatenate([inner.sclera, outer.sclera]),
    )
