"""Where a clip's cameras stand: distances, orbit, an iris's size on the picture. Pure numpy.

World space is in millimetres, right-handed: x to the viewer's right, y up, z from the face towards
the viewer; the origin lies midway between the centres of the two globes.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.clip import ClipSpec
from renderer.clip_values import REFERENCE_LINES
from renderer.eye.place import eye_centre_mm
from renderer.view import View, look_at, perspective

VERTICAL_FOV_DEG: Final = 12.0  # a portrait lens: no wide-angle faces
IRIS_DIAMETER_MM: Final = 11.7  # horizontal visible iris diameter, 11.71 +- 0.42
LIMBUS_Z_MM: Final = 10.19  # limbus plane in front of the globe's centre, sqrt(11.75^2 - 5.85^2)
IRIS_PX: Final = {"macroscopic": 350.0, "near": 160.0, "medium": 40.0, "far": 12.0}


def camera_radius_mm(distance: str) -> float:
    """Return the orbit's radius that gives the distance's iris diameter at azimuth 0."""
    return radius_of_px(IRIS_PX[distance])


def radius_of_px(distance_px: float) -> float:
    """Return the radius at which an iris is ``distance_px`` wide on 1080 lines, seen in front."""
    return focal_px(REFERENCE_LINES) * IRIS_DIAMETER_MM / distance_px + LIMBUS_Z_MM


def focal_px(lines: float) -> float:
    """Return the lens's focal length in pixels of a picture with so many lines."""
    return lines / 2 / math.tan(math.radians(VERTICAL_FOV_DEG) / 2)


def views(
    spec: ClipSpec,
    azimuth_deg: float,
    elevation_deg: float = 0.0,
    *,
    distance_px: float | None = None,
    eyes: tuple[int, ...] = (0, 1),
) -> tuple[View, ...]:
    """Return the picture's views: two half frames of an orbit at macroscopic, elsewhere one.

    ``eyes`` narrows what is shown as stimulus; one eye alone has the whole picture at macroscopic.
    ``distance_px`` puts the camera where an iris is so wide on 1080 lines. Without it an orbit's
    camera keeps its distance and an approach's is at its end.
    """
    is_approach = spec.motion == "approach"
    if distance_px is None:
        distance_px = spec.approach_end_px if is_approach else IRIS_PX[spec.distance]
    share = spec.width // len(eyes)
    rows: tuple[tuple[tuple[int, int, int, int], npt.NDArray[np.float64], tuple[int, ...]], ...]
    if spec.distance == "macroscopic" and not is_approach:
        rows = tuple(
            ((place * share, 0, share, spec.height), eye_centre_mm(eye), (eye,))
            for place, eye in enumerate(eyes)
        )
    else:
        rows = (((0, 0, spec.width, spec.height), np.zeros(3), eyes),)
    return tuple(
        _view(
            rectangle,
            target,
            radius_mm=radius_of_px(distance_px),
            azimuth_deg=azimuth_deg,
            elevation_deg=elevation_deg,
            eyes=shown,
        )
        for rectangle, target, shown in rows
    )


def _view(
    rectangle: tuple[int, int, int, int],
    target: npt.NDArray[np.float64],
    *,
    radius_mm: float,
    azimuth_deg: float,
    elevation_deg: float,
    eyes: tuple[int, ...],
) -> View:
    azimuth, elevation = math.radians(azimuth_deg), math.radians(elevation_deg)
    direction = np.array(
        [
            math.sin(azimuth) * math.cos(elevation),
            math.sin(elevation),
            math.cos(azimuth) * math.cos(elevation),
        ]
    )
    position = target + radius_mm * direction
    projection = perspective(VERTICAL_FOV_DEG, rectangle[2] / rectangle[3], radius_mm * 0.5, 60000)
    return View(rectangle, look_at(position, target), projection, position, eyes)


def iris_px(
    spec: ClipSpec, azimuth_deg: float, *, distance_px: float | None = None
) -> tuple[float, float]:
    """Return the iris's diameter on the picture in pixels, left and right eye.

    The larger axis of the projected limbus: the size that decides which details can be seen.
    """
    diameters = {}
    for view in views(spec, azimuth_deg, distance_px=distance_px):
        for eye in view.eyes:
            limbus = eye_centre_mm(eye) + np.array([0.0, 0.0, LIMBUS_Z_MM])
            depth = -(view.view_matrix @ np.append(limbus, 1.0))[2]
            diameters[eye] = float(focal_px(view.rectangle[3]) * IRIS_DIAMETER_MM / depth)
    return diameters[0], diameters[1]


def iris_px_of_frame(spec: ClipSpec, frame: int) -> tuple[float, float]:
    """Return ``iris_px`` in a frame of the clip (0-based)."""
    return iris_px(spec, spec.azimuth_deg(frame), distance_px=spec.distance_px(frame))
