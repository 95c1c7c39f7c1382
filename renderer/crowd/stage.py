"""Who stands where in the crowd around the main character. Pure data and arithmetic.

Rule of the picture: the camera orbits where a photographer would walk, so nobody may stand there.
The walker and the waver are in front of the face, inside the orbit: the eyes reflect them, the
picture never shows them (nor the photographer). Everybody else stands beside or behind the main
character, or in front of her beyond the farthest camera.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from renderer.crowd.cast import CAST
from renderer.crowd.gait import WALK_SPEED_MM_S
from renderer.crowd.people import PEOPLE, Person
from renderer.park.panorama import EYE_HEIGHT_M

Point = tuple[float, float, float]

GROUND_MM: Final = -1000.0 * EYE_HEIGHT_M
PATH_Z_MM: Final = 1500.0  # the walker passes this far in front of the face


@dataclass(frozen=True)
class Path:
    """A straight way across the view, ``length_mm`` long: who comes to its end starts anew.

    ``centre_s`` is when the walker first passes the middle.
    """

    z_mm: float
    length_mm: float
    centre_s: float


# One turn of 8.5 s; the walker passes the face amid a five-second clip.
FRONT: Final = Path(PATH_Z_MM, 11000.0, 2.5)


@dataclass(frozen=True)
class Member:
    """A place in the crowd: azimuth (0 before the face, positive to the viewer's right), distance.

    ``heading_deg`` is where the character looks, 0 the way the main character looks; ``nod_deg``
    how far the head is bowed. Walkers follow their ``path``. ``looks_at`` is a point in world mm
    that the eyes seek; without one they look where the head points.
    """

    person: Person
    action: str
    azimuth_deg: float = 0.0
    distance_mm: float = 0.0
    heading_deg: float = 0.0
    is_shown: bool = True
    path: Path = FRONT
    nod_deg: float = 0.0
    looks_at: Point | None = None

    def place_mm(self, time_s: float) -> tuple[float, float]:
        """Return x and z in world mm at a time."""
        if self.action != "walk":
            azimuth = math.radians(self.azimuth_deg)
            return self.distance_mm * math.sin(azimuth), self.distance_mm * math.cos(azimuth)
        path = self.path
        along = WALK_SPEED_MM_S * (time_s - path.centre_s) + path.length_mm / 2
        x_mm = along % path.length_mm - path.length_mm / 2
        return x_mm * math.sin(math.radians(self.heading_deg)), path.z_mm


# Shown members come last: the picture draws the tail of the buffer.
STAGE: Final = (
    Member(PEOPLE[0], "walk", heading_deg=90.0, is_shown=False),
    Member(PEOPLE[1], "wave", 24.0, 1080.0, heading_deg=-158.0, is_shown=False),
    Member(PEOPLE[2], "stand", -86.0, 980.0, heading_deg=16.0),
    Member(PEOPLE[3], "stand", 98.0, 1020.0, heading_deg=-14.0),
    Member(PEOPLE[4], "stand", 83.0, 2000.0, heading_deg=-24.0),
)
# Azimuth, distance in mm, heading: ten around the five first places, then the wider circle.
_AROUND: Final = (
    (-118.0, 1650.0, 24.0), (136.0, 2300.0, -18.0), (-152.0, 2600.0, 8.0), (166.0, 2900.0, -30.0),
    (-97.0, 2050.0, 40.0),
    (118.0, 3300.0, -52.0), (-133.0, 3900.0, 30.0), (-167.0, 3300.0, 6.0), (-171.0, 4300.0, -12.0),
    (151.0, 4100.0, 12.0), (107.0, 4600.0, -70.0), (-110.0, 3100.0, 64.0), (-146.0, 5900.0, 20.0),
    (128.0, 5600.0, -24.0), (164.0, 6300.0, -8.0), (-162.0, 7100.0, 18.0), (174.0, 7600.0, 4.0),
    (142.0, 7300.0, -20.0),
    (-64.0, 6100.0, 118.0), (-38.0, 5700.0, 146.0), (-14.0, 6400.0, 168.0), (13.0, 5600.0, -172.0),
    (41.0, 6200.0, -136.0),
)  # fmt: skip
_BEHIND: Final = (Path(-5000.0, 30000.0, 1.2), Path(-8300.0, 30000.0, 3.6))


def _circle() -> tuple[Member, ...]:
    """Return the twenty-five members who join the five: those who stand, then two who walk."""
    standing = [
        Member(person, "stand", azimuth, distance, heading_deg=heading)
        for person, (azimuth, distance, heading) in zip(CAST[5:], _AROUND, strict=False)
    ]
    walking = [
        Member(person, "walk", heading_deg=heading, path=path)
        for person, heading, path in zip(CAST[28:], (90.0, -90.0), _BEHIND, strict=True)
    ]
    return (*standing, *walking)


CIRCLE: Final = (*STAGE, *_circle())


def members(crowd: int) -> tuple[Member, ...]:
    """Return who stands around the main character for a clip's number of other characters."""
    return CIRCLE[:crowd]
