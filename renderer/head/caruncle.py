"""The pink bump in the inner corner of the eye, and the membrane that closes the outer corner.

Pure numpy, patch space (see ``lid_pose``): both bridge what lies between the rims where they have
left the globe, and go along with lids and gaze.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.head.corner_sheet import CRESCENT_MM, Corner, sheet_quads, span_sheet
from renderer.head.lid_pose import STRAIGHT, LidPose
from renderer.head.lid_rims import LATERAL_MM, MEDIAL_MM, soft_max
from renderer.head.lid_shell import on_globe
from renderer.textures.easing import ease

CARUNCLE_END_MM: Final = -7.5  # towards the pupil: under the globe's surface from here on
COVER_MM: Final = (-8.1, -9.4)  # the conjunctiva fades in over the sclera between these
BRIDGE_MM: Final = 5.0  # how softly it leaves the globe: a valley would show the globe's outline
PLICA_MM: Final = -11.2  # free edge of the fold, a crescent that embraces the cornea
PLICA_EDGE_MM: Final = 0.35  # from its foot on the globe to its height ...
PLICA_WIDTH_MM: Final = 0.95  # ... and on from there, down to the lake before the caruncle
PLICA_RISE_MM: Final = 0.5
BUMP_MM: Final = (-14.0, 1.75, 2.5)  # the caruncle's middle, half widths to temple and nose
BUMP_RISE_MM: Final = 1.2
LAKE_MM: Final = 0.35  # depth of the tears around its foot
GRANULE_MM: Final = 0.06  # height of its granules, which lie on lobes twice as high
LATERAL_COVER_MM: Final = (10.5, 11.4)  # off the gaze axis: where the outer sheet fades in
MEMBRANE_START_MM: Final = 8.6
DRAWN: Final = (0.28, 0.12)  # share of the cornea's way to nose and temple that drags the fold
FULL_OPENING_MM: Final = 3.0  # of the lids, at which the caruncle stands out fully
CARUNCLE_GRID: Final = (112, 44)  # points from canthus inwards, and from lid to lid
MEMBRANE_GRID: Final = (22, 16)


def caruncle(pose: LidPose = STRAIGHT) -> Corner:
    """Return the inner corner: conjunctiva off the sclera, the plica's fold, the caruncle."""
    drawn = _drawn_mm(pose)
    sheet = span_sheet(MEDIAL_MM[0], CARUNCLE_END_MM + drawn, pose, grid=CARUNCLE_GRID)
    b = sheet.upwards
    x, y, z = (sheet.points_mm[..., axis] for axis in range(3))
    between = np.sin(np.pi * b)
    room = ease(sheet.opening_mm / FULL_OPENING_MM)
    crescent = (
        x - drawn + CRESCENT_MM * (2 * b - 1) ** 2
    )  # lines of equal depth bend around the pupil
    foot = _caruncle_foot(x - 0.3 * drawn, y, b)
    dome = room * _dome(foot)
    lake = room * np.exp(-(((foot - 1.12) / 0.2) ** 2)) * between * ease((x - BUMP_MM[0]) / 1.2)
    fold, way = _plica(x - drawn, b)
    sag = 0.75 * between * ease((x - MEDIAL_MM[0]) / 1.5)
    globe = on_globe(sheet.points_mm[..., :2], pose)
    off = ease((-7.9 - crescent) / 1.4)
    under = ease((crescent + 8.3) / 0.6)
    over = np.minimum(0.09, 0.05 + 0.2 * sheet.opening_mm)
    bridge = BRIDGE_MM * room * between * off
    base = soft_max(globe + over, z - sag, 0.05 + bridge) - 0.6 * under
    lobes, granules = _lobes(x, y)
    bumps = BUMP_RISE_MM * dome + GRANULE_MM * (2 * lobes + granules) * np.sqrt(dome)
    bumps += PLICA_RISE_MM * room * fold * between - LAKE_MM * lake
    sheet.points_mm[..., 2] = base + bumps
    cover = ease((COVER_MM[0] - crescent) / (COVER_MM[0] - COVER_MM[1]))
    cover = np.maximum(cover, _beside_globe(sheet.points_mm))
    # White before the fold, pinker on it, red in the lake behind.
    white = 1.0 - 0.5 * ease(way / 0.5 + 0.6) - 0.4 * ease((way - 0.8) / 0.7)
    pink = ease(2.5 * dome)
    return Corner(
        sheet.points_mm.reshape(-1, 3),
        sheet_quads(CARUNCLE_GRID),
        pink.ravel(),
        (room * pink).ravel(),
        np.clip(white * (1 - pink) + 0.15 * np.clip(granules, 0, 1) * pink, 0, 1).ravel(),
        cover.ravel(),
    )


def _caruncle_foot(x: Floats, y: Floats, b: Floats) -> Floats:
    """Return 0 at the caruncle's middle, 1 at its uneven foot, more beyond."""
    middle, temple, nose = BUMP_MM
    across, up = (x - middle) / np.where(x > middle, temple, nose), (b - 0.46) / 0.5
    uneven = 1 + 0.045 * np.sin(2.9 * y + 1.7 * x) + 0.04 * np.sin(5.3 * y - 2.1 * x + 1.0)
    return np.asarray(np.hypot(across, up) * uneven)


def _dome(foot: Floats) -> Floats:
    """Return the height, 0 to 1, of a round top that leaves its foot at an angle."""
    t = np.clip(1 - foot * foot, 0.0, 1.0)
    return np.asarray(t * (2 - t))


def _plica(x: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Return the fold's height, 0 to 1, and the way in mm from its free edge towards the nose.

    The edge looks towards the cornea; behind it the fold sinks to the lake of tears.
    """
    way = PLICA_MM + 4.0 * (b - 0.45) ** 2 + 0.07 * np.sin(7.0 * b + 1.0) - x
    rise = ease(way / PLICA_EDGE_MM + 0.5)
    fall = ease((way - 0.5 * PLICA_EDGE_MM) / PLICA_WIDTH_MM)
    return rise * (1 - fall), way


def _drawn_mm(pose: LidPose) -> float:
    """Return how far the turning globe drags the plica's fold towards the temple."""
    sideways = pose.corneal_shift_mm[0]
    return sideways * (DRAWN[0] if sideways < 0 else DRAWN[1])


def _beside_globe(points: Floats) -> Floats:
    """Return 1 where no globe would be seen through the sheet, 0 well inside its outline."""
    return ease((np.hypot(points[..., 0], points[..., 1]) - 10.95) / 0.5)


def _lobes(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Return the caruncle's lobes of a millimetre, about 0, and its pale granules, too."""
    u, v = x + 0.13 * np.sin(4.1 * y), y + 0.15 * np.sin(3.3 * x + 1.0)
    lobes = np.sin(5.1 * u + 2.3 * v + 0.4) * np.sin(4.7 * v - 2.9 * u)
    granules = np.sin(8.3 * u - 3.1 * v) * np.sin(7.7 * v + 4.3 * u + 1.0)
    return np.asarray(lobes), np.asarray(granules)


def outer_membrane(pose: LidPose = STRAIGHT) -> Corner:
    """Return the conjunctiva in the outer corner."""
    sheet = span_sheet(LATERAL_MM[0], MEMBRANE_START_MM, pose, grid=MEMBRANE_GRID)
    a, b = sheet.inwards, sheet.upwards
    globe = on_globe(sheet.points_mm[..., :2], pose)
    under = ease((a - 0.85) / 0.15)
    between = np.sin(np.pi * b) * ease(sheet.opening_mm)
    start, end = LATERAL_COVER_MM
    hollow = sheet.points_mm[..., 2] - 0.35 * between
    sheet.points_mm[..., 2] = soft_max(globe + 0.05, hollow, 0.05 + between) - 0.5 * under
    return Corner(
        sheet.points_mm.reshape(-1, 3),
        sheet_quads(MEMBRANE_GRID)[:, ::-1],
        np.zeros(a.size),
        np.zeros(a.size),
        ease(a / 0.45).ravel(),
        ease(
            (np.hypot(*np.moveaxis(sheet.points_mm[..., :2], -1, 0)) - start) / (end - start)
        ).ravel(),
    )
