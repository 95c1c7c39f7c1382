"""The cameras of a picture as plain numbers, and where they draw a point. Pure numpy."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from renderer.camera import VERTICAL_FOV_DEG, views
from renderer.clip import ClipSpec
from renderer.exchange.meshes import Floats
from renderer.view import View

CONVENTIONS: Final = {
    "matrices": "rows of a matrix that multiplies column vectors from the left",
    "world_to_camera": "to camera space in mm: x right, y up, the camera looks along -z (OpenGL)",
    "projection": "camera space to clip space (OpenGL): x, y, z from -1 to 1 after division by w",
    "rectangle_px": "x, y, width, height of the view in the picture, from its upper left corner",
    "pixel": "column = x + (ndc_x + 1) / 2 * width, row = y + (1 - ndc_y) / 2 * height; a pixel's "
    "middle lies at half numbers",
}


def cameras(spec: ClipSpec, azimuth_deg: float, elevation_deg: float) -> dict[str, Any]:
    """Return what camera.json holds: one camera per view of the picture, and the conventions."""
    return {
        "size_px": [spec.width, spec.height],
        "azimuth_deg": azimuth_deg,
        "elevation_deg": elevation_deg,
        "unit": "mm",
        "conventions": CONVENTIONS,
        "views": [_camera(spec, view) for view in views(spec, azimuth_deg, elevation_deg)],
    }


def _camera(spec: ClipSpec, view: View) -> dict[str, Any]:
    x, y, width, height = view.rectangle
    world_to_camera = view.view_matrix.astype(np.float64)
    return {
        "eyes": [("left", "right")[eye] for eye in view.eyes],
        "rectangle_px": [x, spec.height - y - height, width, height],
        "position": view.position_mm.tolist(),
        "forward": (-world_to_camera[2, :3]).tolist(),
        "up": world_to_camera[1, :3].tolist(),
        "vertical_fov_deg": VERTICAL_FOV_DEG,
        "world_to_camera": world_to_camera.tolist(),
        "camera_to_world": np.linalg.inv(world_to_camera).tolist(),
        "projection": view.projection.astype(np.float64).tolist(),
    }


def project(camera: dict[str, Any], points: Floats) -> Floats:
    """Return the pixels (n, 2), column and row, of points (n, 3), as camera.json describes."""
    matrix = np.array(camera["projection"]) @ np.array(camera["world_to_camera"])
    clip = np.column_stack([points, np.ones(len(points))]) @ matrix.T
    ndc = clip[:, :2] / clip[:, 3:]
    x, y, width, height = camera["rectangle_px"]
    return np.column_stack([x + (ndc[:, 0] + 1) / 2 * width, y + (1 - ndc[:, 1]) / 2 * height])
