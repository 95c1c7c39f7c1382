"""The paint of the skin: colour by zone, gloss, where its relief lies. Pure numpy.

Albedos are linear Rec. 709. A light, warm European skin; blood shows where skin is thin (lids,
lips, nose, cheeks), melanin and veins tint the skin around the eyes.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.eye.place import eye_centre_mm
from renderer.head.brows import BROW_COLOUR, stubble
from renderer.head.hair import COLOUR as HAIR_COLOUR
from renderer.head.hair_cap import inside_hairline
from renderer.head.lid_layout import AROUND_MM
from renderer.head.skin_part import SkinPart
from renderer.head.unrolling import unroll_mm

SCALP: Final = 0.55  # what is dark between the hairs, as a share of their colour
BASE: Final = (0.60, 0.368, 0.280)
LIPS: Final = (0.50, 0.235, 0.205)
MARGIN: Final = (0.525, 0.282, 0.224)
MARGIN_FLUSH: Final = (0.92, 0.84, 0.83)  # the fine vessels where the lashes grow
THIN: Final = (0.91, 0.875, 0.90)  # veins and muscle through the upper lid: bluish red
PLATE: Final = (0.86, 0.84, 0.86)  # between lashes and crease the skin is the body's thinnest
CREASE: Final = (0.86, 0.855, 0.86)  # pigment where skin folds all day
WET: Final = (0.52, 0.230, 0.195)
SCLERA: Final = (0.69, 0.535, 0.465)  # seen through the conjunctiva in the corners
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
TILE_MM: Final = 32.0  # edge of the tile of relief


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
    scalp = np.clip((above - 1.0) / 12.0, 0, 1)[:, None]
    albedo += 0.9 * scalp * (SCALP * np.array(HAIR_COLOUR) - albedo)
    for eye in (0, 1):
        local = part.points_mm - eye_centre_mm(eye)
        x, y = local[:, 0] * (1.0 if eye else -1.0), local[:, 1]
        front = part.points_mm[:, 2] > -20.0
        albedo += (stubble(x, y) * front)[:, None] * (np.array(BROW_COLOUR) - albedo)


def _tint_around_eyes(albedo: Floats, part: SkinPart) -> None:
    """Tint what lies around the eyes: veins and muscle show through the thin skin of the lids."""
    for eye in (0, 1):
        local = part.points_mm - eye_centre_mm(eye)
        x, y = local[:, 0] * (1.0 if eye else -1.0), local[:, 1]
        lid = np.exp(-((x / 17.0) ** 2) - ((y - 1.0) / 11.0) ** 2)
        fold = np.exp(-(((x + 1.0) / 14.0) ** 2) - ((y - 9.0) / 4.5) ** 2)
        ring = np.exp(-(((x + 2.0) / 15.0) ** 2) - ((y + 10.5) / 4.5) ** 2)
        trough = np.exp(-(((x + 11.0) / 7.0) ** 2) - ((y + 9.5 + 0.35 * x) / 3.5) ** 2)
        inner = np.exp(-(((x + 16.0) / 5.0) ** 2) - ((y + 1.5) / 6.0) ** 2)
        outer = np.exp(-(((x - 15.5) / 3.5) ** 2) - ((y + 0.3) / 0.7) ** 2)
        fat = np.exp(-(((x - 2.0) / 16.0) ** 2) - ((y + 18.0) / 4.0) ** 2)
        for weight, factor in (
            (lid, (1.00, 0.95, 0.95)),
            (fold, (1.05, 1.03, 1.05)),
            (ring, (0.95, 0.91, 0.97)),
            (trough, (0.90, 0.88, 0.97)),
            (inner, (0.98, 0.91, 0.92)),
            (outer, (0.99, 0.965, 1.06)),
            (fat, (1.03, 1.04, 1.02)),
        ):
            albedo *= 1 + weight[:, None] * (np.array(factor) - 1)
    around, across = part.along_mm.T
    beside_margin = part.lid * np.exp(-(((across - 2.0) / 1.1) ** 2))
    # From the lashes up into the fold, where the skin is the body's thinnest.
    is_upper = np.clip(np.sin(2 * np.pi * around / AROUND_MM), 0.0, 1.0) ** 0.5
    thin = part.lid * is_upper * np.exp(-(((across - 5.2) / 5.2) ** 4))
    plate = part.lid * is_upper * np.exp(-(((across - 3.0) / 2.0) ** 4))
    crease = part.lid * is_upper * np.exp(-(((across - 4.3) / 0.8) ** 2))
    for weight, factor in (
        (beside_margin, MARGIN_FLUSH),
        (thin, THIN),
        (plate, PLATE),
        (crease, CREASE),
    ):
        albedo *= 1 + weight[:, None] * (np.array(factor) - 1)


def _gloss(part: SkinPart) -> Floats:
    """Return how oily the skin is: nose and forehead shine, lids a little, wet rims fully."""
    x, y, _ = part.points_mm.T
    gloss = 0.35 + 0.25 * np.exp(-((x / 14.0) ** 2) - ((y + 25.0) / 28.0) ** 2)
    gloss += 0.15 * np.exp(-((x / 50.0) ** 2) - ((y - 50.0) / 25.0) ** 2)
    gloss += 0.25 * part.lips - 0.12 * part.lid
    return np.asarray(np.clip(np.maximum(gloss, 0.9 * part.margin), 0.0, 1.0))


def detail_coordinates(points_mm: Floats) -> Floats:
    """Return (n, 2) coordinates in the tile of relief, in tiles."""
    return unroll_mm(points_mm) / TILE_MM
