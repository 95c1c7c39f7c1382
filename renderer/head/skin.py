"""The paint of the skin: colour by zone, gloss, and the tile of pores. Pure numpy.

Albedos are linear Rec. 709. A light, warm European skin; blood shows where skin is thin (lids,
lips, nose, cheeks), melanin and veins tint the skin around the eyes.
"""

from __future__ import annotations

import functools
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats
from renderer.camera import eye_centre_mm
from renderer.head.brows import BROW_COLOUR, stubble
from renderer.head.face_mesh import SkinPart, face_mesh
from renderer.head.hair import COLOUR as HAIR_COLOUR
from renderer.head.hair import inside_hairline

SCALP: Final = 0.55  # what is dark between the hairs, as a share of their colour
BASE: Final = (0.60, 0.375, 0.275)
LIPS: Final = (0.50, 0.235, 0.205)
MARGIN: Final = (0.59, 0.350, 0.265)
WET: Final = (0.60, 0.320, 0.265)
SCLERA: Final = (0.66, 0.555, 0.49)  # seen through the conjunctiva in the corners
CARUNCLE: Final = (0.62, 0.255, 0.215)
# Tints: centre x, y in mm, radii in mm, factor of the albedo. Both sides alike unless x is 0.
ZONES: Final = (
    (44.0, -40.0, 22.0, 18.0, (1.03, 0.86, 0.84)),  # cheeks
    (0.0, -42.0, 13.0, 12.0, (1.02, 0.83, 0.80)),  # tip of the nose
    (14.0, -46.0, 7.0, 7.0, (1.00, 0.84, 0.82)),  # wings of the nose
    (0.0, 45.0, 60.0, 22.0, (1.02, 0.98, 0.94)),  # forehead, a little yellower
    (0.0, -100.0, 20.0, 12.0, (1.00, 0.93, 0.92)),  # chin
    (75.0, -20.0, 12.0, 30.0, (1.02, 0.87, 0.85)),  # ears
)
TILE_MM: Final = 24.0  # edge of the tile of pores
TILE_PX: Final = 1024
FACE_X_MM: Final = (-40, 40)  # where the face's relief stretches a cylinder around the head
FACE_Y_MM: Final = (-50, 48)


def paint(part: SkinPart) -> tuple[Floats, Floats]:
    """Return albedo (n, 3) and gloss (n,), 0 dry to 1 oily, of a mesh's vertices."""
    x, y, _ = part.points_mm.T
    albedo = np.tile(BASE, (len(x), 1))
    for cx, cy, rx, ry, factor in ZONES:
        weight = np.exp(-(((np.abs(x) - cx) / rx) ** 2) - ((y - cy) / ry) ** 2)
        albedo *= 1 + weight[:, None] * (np.array(factor) - 1)
    _tint_around_eyes(albedo, part)
    _stubble(albedo, part)
    for share, colour in (
        (part.lips, LIPS),
        (part.margin, MARGIN),
        (part.wet * (1 - part.caruncle), WET),
        (part.caruncle, CARUNCLE),
        (part.sclera * np.ones(len(x)), SCLERA),
    ):
        albedo += share[:, None] * (np.array(colour) - albedo)
    return albedo, _gloss(part)


def _stubble(albedo: Floats, part: SkinPart) -> None:
    """Darken the scalp and the skin under the brows: roots too fine to be drawn."""
    above = inside_hairline(part.points_mm)
    scalp = np.clip((above + 2.0) / 8.0, 0, 1)[:, None]
    albedo += 0.9 * scalp * (SCALP * np.array(HAIR_COLOUR) - albedo)
    for eye in (0, 1):
        local = part.points_mm - eye_centre_mm(eye)
        x, y = local[:, 0] * (1.0 if eye else -1.0), local[:, 1]
        front = part.points_mm[:, 2] > -20.0
        albedo += (stubble(x, y) * front)[:, None] * (np.array(BROW_COLOUR) - albedo)


def _tint_around_eyes(albedo: Floats, part: SkinPart) -> None:
    """Redden the lids, darken the hollow beside the nose and the ring under the eye."""
    for eye in (0, 1):
        local = part.points_mm - eye_centre_mm(eye)
        x, y = local[:, 0] * (1.0 if eye else -1.0), local[:, 1]
        lid = np.exp(-((x / 17.0) ** 2) - ((y - 1.0) / 11.0) ** 2)
        upper = np.exp(-(((x + 1.0) / 14.0) ** 2) - ((y - 8.0) / 4.5) ** 2)
        ring = np.exp(-(((x + 2.0) / 15.0) ** 2) - ((y + 11.5) / 5.0) ** 2)
        plate = 4.1 * (1 - ((x + 1.2) / 14.5) ** 2) + 1.7  # between lashes and crease
        plate = np.exp(-(((y - plate) / 1.9) ** 2) - (x / 14.0) ** 4)
        inner = np.exp(-(((x + 16.0) / 6.0) ** 2) - ((y + 1.0) / 9.0) ** 2)
        for weight, factor in (
            (lid, (1.01, 0.94, 0.92)),
            (upper, (1.08, 1.06, 1.06)),
            (plate, (0.90, 0.83, 0.81)),
            (ring, (0.94, 0.89, 0.92)),
            (inner, (0.98, 0.93, 0.95)),
        ):
            albedo *= 1 + weight[:, None] * (np.array(factor) - 1)


def _gloss(part: SkinPart) -> Floats:
    """Return how oily the skin is: nose and forehead shine, lids a little, wet rims fully."""
    x, y, _ = part.points_mm.T
    gloss = 0.35 + 0.25 * np.exp(-((x / 14.0) ** 2) - ((y + 25.0) / 28.0) ** 2)
    gloss += 0.15 * np.exp(-((x / 50.0) ** 2) - ((y - 50.0) / 25.0) ** 2)
    gloss += 0.25 * part.lips - 0.12 * part.lid
    return np.asarray(np.clip(np.maximum(gloss, 0.5 * part.margin), 0.0, 1.0))


def pore_tile(seed: int = 11) -> npt.NDArray[np.uint8]:
    """Return the periodic detail tile (TILE_PX, TILE_PX, 4) uint8.

    Red and green: slope of the micro-relief (0.5 flat, scale +-1); blue: cavity (1 open); alpha:
    mottle of the pigment (0.5 average).
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    relief = _relief(rng)
    step = TILE_MM / TILE_PX
    slopes = [np.gradient(np.pad(relief, 1, mode="wrap"), step, axis=a)[1:-1, 1:-1] for a in (1, 0)]
    cavity = np.clip(1.0 + 14.0 * (relief - _blur(relief, 0.35)), 0.0, 1.0)
    mottle = 0.5 + 0.16 * sum(
        share * _blur_noise(rng, size)
        for share, size in ((0.5, 0.09), (0.8, 0.25), (0.8, 0.7), (0.5, 1.6))
    )
    layers = [0.5 + 0.5 * slopes[0], 0.5 + 0.5 * slopes[1], cavity, mottle]
    return np.stack([np.clip(layer * 255 + 0.5, 0, 255).astype(np.uint8) for layer in layers], -1)


def _relief(rng: np.random.Generator) -> Floats:
    """Return heights in mm: polygons between fine furrows, pores, and soft waviness."""
    fine = _furrows(rng, cells=52)
    coarse = _furrows(rng, cells=30)
    height = -0.008 * np.exp(-fine / 0.06) - 0.007 * np.exp(-coarse / 0.09)
    height += 0.006 * _blur_noise(rng, 0.08) + 0.012 * _blur_noise(rng, 0.5)
    return np.asarray(height - 0.030 * _pores(rng, count=560))


def _furrows(rng: np.random.Generator, *, cells: int) -> Floats:
    """Return the distance in mm to the nearest furrow: borders of jittered, stretched cells."""
    px = TILE_PX / cells
    jitter = rng.uniform(0.1, 0.9, size=(cells, cells, 2))
    y, x = np.indices((TILE_PX, TILE_PX)) / px
    cell_x, cell_y = x.astype(int), y.astype(int)
    nearest, second = np.full((2, TILE_PX, TILE_PX), 9.0)
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            point = jitter[(cell_y + dy) % cells, (cell_x + dx) % cells]
            d = np.hypot(cell_x + dx + point[..., 0] - x, cell_y + dy + point[..., 1] - y)
            second = np.minimum(second, np.maximum(nearest, d))
            nearest = np.minimum(nearest, d)
    return np.asarray((second - nearest) * (TILE_MM / cells))


def _pores(rng: np.random.Generator, *, count: int) -> Floats:
    """Return pits of 0.1 to 0.25 mm, depth 0 to 1."""
    pits = np.zeros((TILE_PX, TILE_PX))
    scale = TILE_PX / TILE_MM
    reach = np.arange(-12, 13)
    for x, y, radius, depth in rng.uniform(
        (0, 0, 0.05, 0.2), (TILE_PX, TILE_PX, 0.12, 1.0), (count, 4)
    ):
        rows, columns = (int(y) + reach) % TILE_PX, (int(x) + reach) % TILE_PX
        d2 = (reach[:, None] ** 2 + reach[None, :] ** 2) / (radius * scale) ** 2
        pits[np.ix_(rows, columns)] += depth * np.exp(-d2)
    return np.minimum(pits, 1.2)


def _blur_noise(rng: np.random.Generator, size_mm: float) -> Floats:
    """Return periodic noise of zero mean and unit variance with features of about ``size_mm``."""
    noise = _blur(rng.standard_normal((TILE_PX, TILE_PX)), size_mm)
    return np.asarray((noise - noise.mean()) / noise.std())


def _blur(field: Floats, size_mm: float) -> Floats:
    """Blur periodically by a Gaussian of standard deviation ``size_mm``."""
    fy = np.fft.fftfreq(TILE_PX)[:, None]
    fx = np.fft.rfftfreq(TILE_PX)[None, :]
    sigma = size_mm * TILE_PX / TILE_MM
    gain = np.exp(-2 * (np.pi * sigma) ** 2 * (fx * fx + fy * fy))
    return np.asarray(np.fft.irfft2(np.fft.rfft2(field) * gain, s=field.shape))


def detail_coordinates(points_mm: Floats) -> Floats:
    """Return (n, 2) coordinates in the pore tile: wound around the head, in tiles."""
    x, y, z = points_mm.T
    longer = ndimage.map_coordinates(
        _surplus_width(), np.array([y - FACE_Y_MM[0], x - FACE_X_MM[0]]), order=1, mode="nearest"
    )
    wound = 95.0 * np.arctan2(x, z + 95.0) + longer
    is_ear = (np.abs(x) > 71.0) & (z < -60.0) & (np.abs(y + 15.0) < 50.0)
    return np.column_stack([np.where(is_ear, z, wound), y]) / TILE_MM


@functools.cache
def _surplus_width() -> Floats:
    """Return by how many mm the way over the face from its middle exceeds that on a cylinder.

    A grid (y, x) of 1 mm over FACE_Y_MM and FACE_X_MM: without it pores smear on the nose's flanks.
    """
    x = np.arange(FACE_X_MM[0], FACE_X_MM[1] + 1.0)
    y = np.arange(FACE_Y_MM[0], FACE_Y_MM[1] + 1.0)
    grid = np.stack(np.meshgrid(x, y), axis=-1)
    front = face_mesh().fine.points_mm
    front = front[front[:, 2] > -10.0]
    distance, near = map(np.asarray, cKDTree(front[:, :2]).query(grid, k=4))
    share = 1 / (distance + 0.3) ** 2
    depth = (front[near, 2] * share).sum(axis=-1) / share.sum(axis=-1)
    depth = ndimage.gaussian_filter(depth, (8.0, 1.5), mode="nearest")
    over_face = np.hypot(1.0, np.gradient(depth, axis=1))
    around = np.gradient(95.0 * np.arctan2(x, depth + 95.0), axis=1)
    way = np.cumsum(over_face - around, axis=1)
    return np.asarray(ndimage.gaussian_filter(way - way[:, [len(x) // 2]], 2.0, mode="nearest"))
