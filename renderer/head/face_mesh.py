"""The main character's skin as meshes: the face as it stays, with the lids as they are posed.

Pure numpy, world space in mm. Lids come as fine patches, and with them the corners of the eyes.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.body.normals import unit, vertex_normals
from renderer.body.subdivide import triangles_of
from renderer.head import lid_fit
from renderer.head.caruncle import caruncle, outer_membrane
from renderer.head.fixed_skin import fixed_skin
from renderer.head.lid_pose import STRAIGHT, LidPose
from renderer.head.lid_socket import Socket
from renderer.head.patch_space import to_world
from renderer.head.skin_part import SkinPart, seam
from renderer.textures.easing import ease

SEAM_SINK_MM: Final = 0.12  # the patches' last rings dive under the face


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


LidPoses = tuple[LidPose, LidPose]
BOTH_STRAIGHT: Final[LidPoses] = (STRAIGHT, STRAIGHT)


@functools.lru_cache(maxsize=8)
def face_mesh(poses: LidPoses = BOTH_STRAIGHT) -> FaceMesh:
    """Build the skin of the main character with the lids of the viewer's left and right eye."""
    face = fixed_skin()
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


def _ramp(x: Floats, start: Floats, end: Floats) -> Floats:
    return ease((x - start) / (end - start))
