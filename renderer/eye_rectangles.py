"""Where the open eyes lie on the picture: the parts in which pictures are compared. Pure numpy."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from renderer.camera import IRIS_DIAMETER_MM, views
from renderer.clip import ClipSpec
from renderer.eye.place import eye_centre_mm

Rectangle = tuple[slice, slice]  # rows, columns

APERTURE_IRISES: Final = (2.6, 1.1)  # the open eye's width and height in iris diameters
LEAST_PX: Final = 8  # of a rectangle's sides


def eye_rectangles(
    spec: ClipSpec, azimuth_deg: float, *, distance_px: float | None = None
) -> tuple[Rectangle, Rectangle]:
    """Return each eye's rectangle on the picture as (rows, columns), left and right eye."""
    found: dict[int, Rectangle] = {}
    for view in views(spec, azimuth_deg, distance_px=distance_px):
        x0, y0, width, height = view.rectangle
        for eye in view.eyes:
            clip = view.projection @ view.view_matrix @ np.append(eye_centre_mm(eye), 1.0)
            centre_x = x0 + (clip[0] / clip[3] + 1) / 2 * width
            centre_y = spec.height - (y0 + (clip[1] / clip[3] + 1) / 2 * height)
            px_per_mm = view.projection[1, 1] / clip[3] * height / 2
            half_w, half_h = (0.5 * n * IRIS_DIAMETER_MM * px_per_mm for n in APERTURE_IRISES)
            found[eye] = (
                _span(centre_y, half_h, 0, spec.height),
                _span(centre_x, half_w, x0, x0 + width),
            )
    return found[0], found[1]


def frame_rectangles(spec: ClipSpec, number: int) -> tuple[Rectangle, Rectangle]:
    """Return the rectangles of both eyes in one frame of a clip as (rows, columns)."""
    return eye_rectangles(spec, spec.azimuth_deg(number), distance_px=spec.distance_px(number))


def _span(centre: float, half: float, low: int, high: int) -> slice:
    start = min(max(int(centre - half), low), high - LEAST_PX)
    return slice(start, max(min(math.ceil(centre + half), high), start + LEAST_PX))
