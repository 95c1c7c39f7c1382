"""A camera and its rectangle of the picture: the matrices of any camera. Pure numpy.

World space as ``renderer.camera`` has it, in mm. Where a clip's cameras stand is said there.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, replace
from typing import TypedDict

import numpy as np
import numpy.typing as npt

Matrix = npt.NDArray[np.float32]


class CameraUniforms(TypedDict):
    """What every draw call of a view is given."""

    view_matrix: Matrix
    projection: Matrix
    camera_mm: npt.NDArray[np.float64]


@dataclass(frozen=True)
class View:
    """One rectangle of the picture with its camera.

    ``rectangle`` is x, y, width, height in pixels from the picture's lower left (GL's order).
    ``eyes`` names the eyes that this view shows as stimulus: (0,) left, (1,) right or both.
    """

    rectangle: tuple[int, int, int, int]
    view_matrix: Matrix
    projection: Matrix
    position_mm: npt.NDArray[np.float64]
    eyes: tuple[int, ...]

    def __post_init__(self) -> None:
        # Programs know again what cannot change: many draws of a view are given the same camera.
        for array in (self.view_matrix, self.projection, self.position_mm):
            array.flags.writeable = False

    @property
    def uniforms(self) -> CameraUniforms:
        """The view as keyword arguments of a draw call."""
        return {
            "view_matrix": self.view_matrix,
            "projection": self.projection,
            "camera_mm": self.position_mm,
        }


def cropped(view: View, box: tuple[int, int, int, int]) -> View:
    """Return the view of a part of a picture as a picture of its own.

    ``box`` is x, y, width, height in pixels from the view's lower left. What it shows has the same
    size in pixels as before.
    """
    x, y, width, height = box
    across, up = view.rectangle[2] / width, view.rectangle[3] / height
    cut = np.eye(4)
    cut[0, 0], cut[1, 1] = across, up
    cut[0, 3] = across - 2 * x / width - 1
    cut[1, 3] = up - 2 * y / height - 1
    projection = (cut @ view.projection).astype(np.float32)
    return replace(view, rectangle=(0, 0, width, height), projection=projection)


def look_at(position: npt.NDArray[np.float64], target: npt.NDArray[np.float64]) -> Matrix:
    """Return the 4 x 4 world-to-camera matrix, column vectors, y up."""
    back = (position - target) / np.linalg.norm(position - target)
    right = np.cross([0.0, 1.0, 0.0], back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    matrix = np.eye(4)
    matrix[:3, :3] = right, up, back
    matrix[:3, 3] = -matrix[:3, :3] @ position
    return matrix.astype(np.float32)


@functools.lru_cache(maxsize=64)
def perspective(fov_deg: float, aspect: float, near_mm: float, far_mm: float) -> Matrix:
    """Return OpenGL's perspective matrix, read-only, for a vertical field of view in degrees."""
    scale = 1 / math.tan(math.radians(fov_deg) / 2)
    matrix = np.zeros((4, 4))
    matrix[0, 0], matrix[1, 1] = scale / aspect, scale
    matrix[2, 2] = (far_mm + near_mm) / (near_mm - far_mm)
    matrix[2, 3] = 2 * far_mm * near_mm / (near_mm - far_mm)
    matrix[3, 2] = -1
    found = matrix.astype(np.float32)
    found.flags.writeable = False
    return found
