"""Which triangles of the skin around the eyes are drawn: fewer where the surface is even.

Software GL pays for every block of 4 x 4 pixels that a triangle touches, so triangles of a few
pixels cost several times their area. Chosen once for all poses of the lids and kept on disk.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices
from renderer.body.subdivide import triangles_of
from renderer.cache import cached_array
from renderer.head.face_mesh import face_mesh
from renderer.head.lid_fit import ALONG, AROUND, grid_quads
from renderer.head.lid_layout import AROUND_MM
from renderer.head.lid_pose import STRAIGHT, LidPose
from renderer.head.skin import paint
from renderer.head.skin_part import SkinPart
from renderer.head.thinning import thin

SPARSE_ROW: Final = 29  # of the lid patches: from here on, every other column will do
# The lids straight ahead, shut, and looking aside: what is even in one may be a fold in another.
POSES: Final = (STRAIGHT, LidPose(blink=1.0), LidPose(25.0, -20.0, 0.2), LidPose(-25.0, 15.0))
OTHER_POSES: Final = 0.35  # how much of an error counts in poses that few clips have
# Errors that nobody sees, the closest camera having 30 pixels to the mm.
POINT_MM: Final = 0.05
NORMAL: Final = 0.15
ALBEDO: Final = 0.04
SHARE: Final = 0.1  # of gloss, lid, wetness
MAP_MM: Final = 0.6  # by which pictures may slide along the skin
LONGEST_MM: Final = 2.5  # light is baked at vertices: shadows' edges must not get coarser


def near_patch(eye: int) -> Indices:
    """Return triangles (m, 3) of a lid patch for close views, of the left (0) or right (1) eye."""
    return _facing(np.asarray(cached_array("patch's triangles", _thin_patch), np.int64), eye)


def near_corners(eye: int) -> Indices:
    """Return triangles (m, 3) of an eye's corners for close views."""
    return _facing(np.asarray(cached_array("corners' triangles", _thin_corners), np.int64), eye)


def distant_patch(eye: int) -> Indices:
    """Return triangles that skip three of four rings' points: for views from further away."""
    around, along = np.arange(0, AROUND, 4), np.append(np.arange(0, ALONG - 1, 3), ALONG - 1)
    quads = grid_quads(len(around), len(along))
    number = (around[:, None] * ALONG + along[None, :]).ravel()
    return _facing(number[triangles_of(quads)], eye)


def _facing(triangles: Indices, eye: int) -> Indices:
    """Turn the right eye's triangles so that they face outwards on either eye."""
    return np.asarray(triangles[:, ::-1] if eye == 0 else triangles)


def _thin_patch() -> Indices:
    parts = [face_mesh((pose, pose)).patches[1] for pose in POSES]
    around, across = parts[0].along_mm.T
    turn = around * (2 * np.pi / AROUND_MM)
    ring_mm = AROUND_MM / (2 * np.pi) * np.column_stack([np.cos(turn), np.sin(turn)])
    places = np.column_stack([ring_mm, across]) / MAP_MM
    return _thinned(parts, _grid_triangles(), [places])


def _thin_corners() -> Indices:
    parts = [face_mesh((pose, pose)).corners[1] for pose in POSES]
    return _thinned(parts, parts[0].triangles, [])


def _thinned(parts: list[SkinPart], triangles: Indices, more: list[Floats]) -> Indices:
    albedo, gloss = paint(parts[0])
    shares = np.column_stack([gloss, parts[0].lid, parts[0].wet]) / SHARE
    columns = [albedo / ALBEDO, shares, *more]
    for part in parts:
        weight = 1.0 if part is parts[0] else OTHER_POSES
        columns += [part.points_mm * (weight / POINT_MM), part.normals * (weight / NORMAL)]
    shapes = [part.points_mm for part in parts]
    return thin(np.column_stack(columns), triangles, shapes=shapes, longest_mm=LONGEST_MM)


def _grid_triangles() -> Indices:
    """Return a patch's triangles: full near the rims, half the columns beyond."""
    inner = grid_quads(AROUND, SPARSE_ROW + 1)
    column, row = inner // (SPARSE_ROW + 1), inner % (SPARSE_ROW + 1)
    triangles = [triangles_of(column * ALONG + row)]
    outer = grid_quads(AROUND // 2, ALONG - SPARSE_ROW)
    column, row = outer // (ALONG - SPARSE_ROW), outer % (ALONG - SPARSE_ROW)
    triangles.append(triangles_of(2 * column * ALONG + row + SPARSE_ROW))
    # Where two columns become one, the first sparse row leans over the middle column.
    first, second, third = ((np.arange(0, AROUND, 2) + k) % AROUND * ALONG for k in range(3))
    triangles.append(np.column_stack([first, third, second]) + SPARSE_ROW)
    return np.concatenate(triangles)
