"""Where the texels of the lids' map lie on the skin: in space, laid out flat, and with which axes.

Pure numpy. Both eyes' maps lie on top of each other in one picture. Along u runs the way around the
fissure (from the temple over the upper lid), along v the way across the skin from the lid's inner
edge.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import ndimage

from renderer.body.makehuman import Floats
from renderer.body.normals import unit
from renderer.head.lid_rims import LATERAL_MM
from renderer.head.patch_space import to_patch
from renderer.head.skin_part import SkinPart

AROUND_MM: Final = 68.0  # what the patches' first coordinate runs over
ACROSS_MM: Final = 17.0
MAP_PX: Final = (512, 2048)  # of one eye: across, around; 30 texels a mm at the rim
COARSE: Final = 64  # places across at which the patch is read before texels are filled in


@dataclass(frozen=True)
class Layout:
    """Where each texel lies; every field is (across, around).

    ``x, y`` patch space in mm; ``flat`` (2, ...) the skin laid out flat; ``stretch`` the way around
    per mm of u; ``along, outward`` (..., 3) unit tangents; ``normal``; ``beyond`` mm from the
    lid's outer edge; ``upper`` 0 to 1.
    """

    x: Floats
    y: Floats
    flat: Floats
    stretch: Floats
    along: Floats
    outward: Floats
    normal: Floats
    around: Floats
    across: Floats
    beyond: Floats
    upper: Floats


def lid_coordinates(part: SkinPart, eye: int) -> Floats:
    """Return (n, 2) coordinates in the map; u grows past 1 nowhere, so seams need care."""
    around, across = part.along_mm.T
    return np.column_stack(
        [around / AROUND_MM, (np.clip(across / ACROSS_MM, 0.004, 0.996) + eye) / 2]
    )


def lay_out(part: SkinPart, eye: int, *, edge: Floats, upper: Floats) -> Layout:
    """Return the layout of one eye's patch; ``edge`` and ``upper`` (around,) as in ``lid_map``."""
    rows = len(edge)
    places = np.linspace(0.0, ACROSS_MM, COARSE)
    across_mm = part.along_mm[:, 1].reshape(rows, -1)
    local = _read(to_patch(part.points_mm, eye).reshape(rows, -1, 3), across_mm, places)
    normal = _read(part.normals.reshape(rows, -1, 3), across_mm, places)
    along = (np.roll(local, -1, 1) - np.roll(local, 1, 1)) * (rows / (2 * AROUND_MM))
    along = ndimage.gaussian_filter(along, (1.0, 1.5, 0.0), mode=("nearest", "wrap", "nearest"))
    outward = np.gradient(local, places, axis=0)
    stretch = np.linalg.norm(along, axis=-1, keepdims=True)
    # Laid out flat: straight on from the rim, as far as the skin's own way.
    rim, end = local[COARSE // 8, :, :2], local[-1, :, :2]
    away = (end - rim) / np.linalg.norm(end - rim, axis=1, keepdims=True)
    flat = rim[None] + away[None] * places[:, None, None]
    mirror = [1.0 if eye else -1.0, 1.0, 1.0]  # from patch space to the world
    around, across = _texel_places()
    fields = [local[..., :2], flat, stretch, unit(along) * mirror, unit(outward) * mirror, normal]
    xy, flat, stretch, along, outward, normal = (_fill(field, rows) for field in fields)
    column = np.stack([edge, upper], axis=-1)[None].repeat(COARSE, axis=0)
    own = _fill(column, rows)
    return Layout(
        x=xy[..., 0],
        y=xy[..., 1],
        flat=np.moveaxis(flat, -1, 0),
        stretch=np.maximum(stretch[..., 0], 0.3),
        along=along,
        outward=outward,
        normal=normal,
        around=around,
        across=across,
        beyond=across - own[..., 0],
        upper=own[..., 1],
    )


def _read(values: Floats, across_mm: Floats, places: Floats) -> Floats:
    """Resample a patch's values (rows, along, k) to places across: (places, rows, k)."""
    columns = [
        [
            np.interp(places, across, row[:, k])
            for across, row in zip(across_mm, values, strict=True)
        ]
        for k in range(values.shape[2])
    ]
    return np.array(columns).transpose(2, 1, 0)


def _texel_places() -> tuple[Floats, Floats]:
    """Return the texels' ways around and across in mm."""
    across = (np.arange(MAP_PX[0]) + 0.5) * (ACROSS_MM / MAP_PX[0])
    around = (np.arange(MAP_PX[1]) + 0.5) * (AROUND_MM / MAP_PX[1])
    return (
        np.broadcast_to(around[None, :], MAP_PX),
        np.broadcast_to(across[:, None], MAP_PX),
    )


def _fill(field: Floats, rows: int) -> Floats:
    """Fill in the texels (across, around, k) between the places and rows of a field."""
    row = (np.arange(MAP_PX[0]) + 0.5) / MAP_PX[0] * (COARSE - 1)
    column = (np.arange(MAP_PX[1]) + 0.5) / MAP_PX[1] * rows
    at = np.stack(np.meshgrid(row, column, indexing="ij"))
    closed = np.concatenate([field, field[:, :1]], axis=1)
    layers = [
        ndimage.map_coordinates(closed[..., k], at, order=1, mode="nearest")
        for k in range(field.shape[2])
    ]
    return np.stack(layers, axis=-1)


def from_outer_canthus(place: Layout) -> tuple[Floats, Floats]:
    """Return distance in mm from the outer canthus and angle from the temple's direction."""
    dx, dy = place.x - LATERAL_MM[0] + 1.5, place.y - LATERAL_MM[1]
    return np.hypot(dx, dy), np.arctan2(dy, dx)


def tangent_slopes(height: Floats, place: Layout) -> tuple[Floats, Floats]:
    """Return slopes along the horizontal and the upright tangent that the skin's shader uses."""
    step = AROUND_MM / MAP_PX[1]
    d_around = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) / (2 * step) / place.stretch
    d_across = np.gradient(height, ACROSS_MM / MAP_PX[0], axis=0)
    gradient = d_around[..., None] * place.along + d_across[..., None] * place.outward
    n = place.normal
    t = np.stack([n[..., 2], np.zeros(n.shape[:2]), -n[..., 0]], axis=-1)
    t /= np.maximum(np.linalg.norm(t, axis=-1, keepdims=True), 1e-3)
    return (gradient * t).sum(-1), (gradient * np.cross(n, t)).sum(-1)
