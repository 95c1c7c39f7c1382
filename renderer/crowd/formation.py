"""The group view: everybody in rows before a wide lens, looking into it. Pure numpy.

The thesis measured its frame rate on 30 characters at once. Here all their eyes are in the picture
together, from a raised camera, so that every row shows over the one before. The main character,
who is a bust, is not among them.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from renderer.crowd.cast import CAST
from renderer.crowd.people import Person
from renderer.crowd.stage import Member, Point
from renderer.view import View, look_at, perspective

FOV_DEG: Final = 32.0  # vertical
CAMERA_MM: Final[Point] = (0.0, 560.0, 3000.0)  # 2.2 m above the ground
PITCH_DEG: Final = -19.5
PIVOT_MM: Final[Point] = (0.0, 0.0, 1000.0)  # what other azimuths and elevations turn about
NEAR_MM: Final = 100.0
FAR_MM: Final = 60000.0
# Rows from the front: distance from the camera and places aside, in mm.
_ROWS: Final = (
    (950.0, (-330.0, 330.0)),
    (1300.0, (-640.0, 0.0, 640.0)),
    (1850.0, (-700.0, -240.0, 240.0, 700.0)),
    (2700.0, (-1275.0, -765.0, -255.0, 255.0, 765.0, 1275.0)),
    (4000.0, (-1820.0, -1300.0, -780.0, -260.0, 260.0, 780.0, 1300.0, 1820.0)),
    (5300.0, (-1950.0, -1300.0, -650.0, 0.0, 650.0, 1300.0, 1950.0)),
)
# Who of the cast stands there, found by search: nobody hides another's eyes, no two of the same
# body stand side by side.
_ORDER: Final = (
    *(1, 10), *(23, 6, 5), *(21, 13, 25, 27), *(0, 7, 28, 15, 8, 14),
    *(12, 4, 29, 20, 16, 2, 26, 19), *(18, 11, 9, 17, 24, 3, 22),
)  # fmt: skip
_HEADS_SHARE: Final = 0.85  # of the way up to the camera that heads turn; eyes do the rest


def formation(count: int) -> tuple[Member, ...]:
    """Return up to thirty members of the group, spread evenly over the rows.

    Raises ValueError for a group of none, or of more than there are.
    """
    if not 1 <= count <= len(CAST):
        raise ValueError(f"crowd: {count}; a group view needs 1 to {len(CAST)} people")
    places = [(distance, aside) for distance, row in _ROWS for aside in row]
    chosen = np.linspace(0, len(places) - 1, count).round().astype(int).tolist()
    return tuple(_member(CAST[_ORDER[row]], *places[row]) for row in chosen)


def _member(person: Person, distance_mm: float, aside_mm: float) -> Member:
    x_mm, z_mm = aside_mm, CAMERA_MM[2] - distance_mm
    rise = math.degrees(math.atan2(CAMERA_MM[1], math.hypot(distance_mm, aside_mm)))
    return Member(
        person,
        "stand",
        azimuth_deg=math.degrees(math.atan2(x_mm, z_mm)),
        distance_mm=math.hypot(x_mm, z_mm),
        heading_deg=math.degrees(math.atan2(-x_mm, distance_mm)),
        nod_deg=-_HEADS_SHARE * rise,
        looks_at=CAMERA_MM,
    )


def group_view(
    size: tuple[int, int], *, azimuth_deg: float = 0.0, elevation_deg: float = 0.0
) -> View:
    """Return the camera before the group, turned about its middle by an azimuth and elevation."""
    away = np.array(CAMERA_MM) - PIVOT_MM
    flat = math.hypot(away[0], away[2])
    turn = math.atan2(away[0], away[2]) + math.radians(azimuth_deg)
    rise = math.atan2(away[1], flat) + math.radians(elevation_deg)
    reach = float(np.linalg.norm(away))
    outwards = np.array(
        [math.sin(turn) * math.cos(rise), math.sin(rise), math.cos(turn) * math.cos(rise)]
    )
    position = np.array(PIVOT_MM) + reach * outwards
    pitch = math.radians(PITCH_DEG - elevation_deg)
    ahead = [-math.sin(turn) * math.cos(pitch), math.sin(pitch), -math.cos(turn) * math.cos(pitch)]
    projection = perspective(FOV_DEG, size[0] / size[1], NEAR_MM, FAR_MM)
    return View((0, 0, *size), look_at(position, position + ahead), projection, position, ())
