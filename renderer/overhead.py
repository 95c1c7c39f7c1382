"""The whole scene from above: a camera that shows everybody and the clip's camera. Pure numpy.

The thesis's Figure 3.1. People see it beside the picture that the clip's camera takes.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.clip import ClipSpec
from renderer.crowd.stage import FRONT, GROUND_MM, Member, members
from renderer.view import View, look_at, perspective

FOV_DEG: Final = 24.0
TOWARDS: Final = (0.35, 0.56, 0.75)  # from the scene to its camera: high, to one side
TALLEST_MM: Final = 250.0  # a tall person's crown above the main character's eyes
MARGIN: Final = 0.94  # of the picture's half height and width
LEAST_REACH_MM: Final = 1300.0  # nearer cameras share one picture; twice and four times: 1.5, 5 m
WALK_S: Final = (0.0, 5.0)  # when who passes the face is in the picture: a clip's time


def overhead_view(spec: ClipSpec, *, reach_mm: float = 0.0) -> View:
    """Return a camera above the scene that holds everybody, and cameras so far around the face.

    Who walks past behind them comes and goes.
    """
    points = np.array([*_people(spec.crowd), *_around(reach_mm)])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    outwards = np.array(TOWARDS) / np.linalg.norm(TOWARDS)
    turn = look_at(middle + outwards, middle)[:3, :3].astype(float)
    aside, up, back = turn @ (points - middle).T
    half_height = MARGIN * math.tan(math.radians(FOV_DEG) / 2)
    half_width = half_height * spec.width / spec.height
    away = float(np.max([back + abs(aside) / half_width, back + abs(up) / half_height]))
    position = middle + away * outwards
    projection = perspective(FOV_DEG, spec.width / spec.height, 500.0, 120000.0)
    rectangle = (0, 0, spec.width, spec.height)
    return View(rectangle, look_at(position, middle), projection, position, (0, 1))


def reach_mm(camera_mm: float) -> float:
    """Return how far around the face a picture for a camera so far off it reaches, in steps of two:

    a camera that moves does not change the picture all the time.
    """
    octaves = math.ceil(math.log2(max(1.0, camera_mm / LEAST_REACH_MM)))
    return LEAST_REACH_MM * 2.0**octaves


def on_picture(view: View, point_mm: npt.ArrayLike) -> tuple[float, float] | None:
    """Return where a view shows a point: shares of the width and height, from the upper left.

    None for a point behind the camera.
    """
    clip = view.projection @ view.view_matrix @ np.append(np.asarray(point_mm, float), 1.0)
    if clip[3] <= 0.0:
        return None
    return float(0.5 + 0.5 * clip[0] / clip[3]), float(0.5 - 0.5 * clip[1] / clip[3])


def _around(reach_mm: float) -> list[tuple[float, float, float]]:
    """Return four points of a circle around the face, at the eyes' height."""
    return [(x * reach_mm, 0.0, z * reach_mm) for x, z in ((-1, 0), (0, 1), (1, 0), (0, -1))]


def _people(crowd: int) -> list[tuple[float, float, float]]:
    """Return the feet and crowns of everybody who stays, and of who passes the face."""
    cast = [member for member in members(crowd) if member.path == FRONT]
    places = [(0.0, 0.0), *(place for member in cast for place in _places(member))]
    return [(x, y, z) for x, z in places for y in (GROUND_MM, TALLEST_MM)]


def _places(member: Member) -> list[tuple[float, float]]:
    return [member.place_mm(time_s) for time_s in WALK_S]
