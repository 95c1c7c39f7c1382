"""How a model eye stands before a camera, and where its points lie in the picture.

Its pupil is seen through its own cornea, and the limbus is no circle but 5 % lower than wide.
Eye space in mm (see renderer.eye.anatomy); pictures with x to the right, y down.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import CORNEA_IOR, LIMBUS_Z_MM
from renderer.eye.optics import refract, surface_height, surface_normal, to_iris_plane, unit
from renderer.unrefraction.limbus import half_way_mm

Array = npt.NDArray[np.float64]

RUFF_MM: Final = 0.005  # how far outside of the pupil's rim its dark lining begins to show
LIMBUS_DEPTH_MM: Final = 0.035  # sclera shines from so far beneath the surface
RIM_DEPTH_MM: Final = 0.075  # the rim lies so far behind the iris's mean surface, its plane
TELECENTRIC_MM: Final = 1e5  # far enough to be parallel
CONTOUR: Final = 48


@dataclass(frozen=True)
class Pose:
    """A model eye before a camera.

    ``x``, ``y`` is the limbus's centre in pixels, ``px_per_mm`` the scale there, ``yaw`` and
    ``pitch`` the gaze to the right and up from the line of sight and ``roll`` the eye's turn
    anticlockwise, all in radians; ``distance_mm`` from the camera to the limbus's centre.
    ``pupil_mm`` is the pupil's radius on the iris plane, ``pupil_x_mm``, ``pupil_y_mm`` its centre
    there, ``oval`` how much it is longer along x and along y = x than across, in shares of its
    radius, and ``height_ratio`` the limbus's height over its width.
    """

    x: float
    y: float
    px_per_mm: float
    yaw: float
    pitch: float
    roll: float
    distance_mm: float
    pupil_mm: float
    pupil_x_mm: float
    pupil_y_mm: float
    height_ratio: float
    oval: tuple[float, float] = (0.0, 0.0)

    @property
    def tilt_deg(self) -> float:
        """The angle between the gaze and the line of sight."""
        return math.degrees(math.acos(math.cos(self.yaw) * math.cos(self.pitch)))

    @property
    def camera_mm(self) -> Array:
        """The camera in eye space."""
        return np.asarray(_LIMBUS + self.distance_mm * self._turn()[2])

    def project(self, p_eye: Array) -> Array:
        """Return the pixels (..., 2) where points (..., 3) of eye space appear."""
        q = (p_eye - _LIMBUS) @ self._turn().T
        scale = self.px_per_mm * self.distance_mm / (self.distance_mm - q[..., 2])
        return np.stack([self.x + scale * q[..., 0], self.y - scale * q[..., 1]], axis=-1)

    def entry(self, x_mm: Array) -> Array:
        """Return the points (..., 3) of the cornea through which iris points (..., 2) are seen.

        Newton's method on the entry point, its Jacobian by differences of 0.01 mm.
        """
        camera = self.camera_mm
        s = 0.85 * x_mm + 0.3 * self._turn()[2][:2]
        step = 0.01
        for _ in range(4):
            error = x_mm - seen_through(s, camera)
            jx = (seen_through(s + [step, 0.0], camera) - x_mm + error) / step
            jy = (seen_through(s + [0.0, step], camera) - x_mm + error) / step
            det = jx[..., 0] * jy[..., 1] - jx[..., 1] * jy[..., 0]
            det = np.where(np.abs(det) < 0.05, 0.05, det)
            move = np.stack(
                [
                    (jy[..., 1] * error[..., 0] - jy[..., 0] * error[..., 1]) / det,
                    (jx[..., 0] * error[..., 1] - jx[..., 1] * error[..., 0]) / det,
                ],
                axis=-1,
            )
            s = s + np.clip(move, -1.0, 1.0)
            s = s * np.minimum(
                1.0, 6.4 / np.maximum(np.linalg.norm(s, axis=-1, keepdims=True), 1e-9)
            )
        return on_surface(s)

    def limbus(self) -> Array:
        """Return the visible limbus in the picture, (CONTOUR, 2)."""
        circle = VISIBLE_LIMBUS_MM * _CIRCLE * [1.0, self.height_ratio]
        return self.project(on_surface(circle) - [0.0, 0.0, LIMBUS_DEPTH_MM])

    def pupil(self) -> Array:
        """Return the pupil's edge in the picture as the cornea shows it, (CONTOUR, 2)."""
        longer = 1.0 + self.oval[0] * _TWICE[:, :1] + self.oval[1] * _TWICE[:, 1:]
        circle = (self.pupil_mm + RUFF_MM) * longer * _CIRCLE + [self.pupil_x_mm, self.pupil_y_mm]
        sideways = self._turn()[2][:2] / CORNEA_IOR
        shift = sideways / math.sqrt(1.0 - float(sideways @ sideways))
        return self.project(self.entry(circle + RIM_DEPTH_MM * shift))

    def _turn(self) -> Array:
        """Return the rotation (3, 3) from eye space to the camera's axes."""
        cy, sy, cp, sp = (
            math.cos(self.yaw),
            math.sin(self.yaw),
            math.cos(self.pitch),
            math.sin(self.pitch),
        )
        forward = np.array([sy * cp, sp, cy * cp])
        right = np.array([cy, 0.0, -sy])
        turn = np.column_stack([right, np.cross(forward, right), forward])
        c, s = math.cos(self.roll), math.sin(self.roll)
        return np.asarray(turn @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))


_TWICE: Final = np.stack(
    [f(np.arange(CONTOUR) / CONTOUR * 4 * np.pi) for f in (np.cos, np.sin)], axis=-1
)
_LIMBUS: Final = np.array([0.0, 0.0, LIMBUS_Z_MM])
_CIRCLE: Final = np.stack(
    [f(np.arange(CONTOUR) / CONTOUR * 2 * np.pi) for f in (np.cos, np.sin)], axis=-1
)
# Where half of the light is the sclera's: further out above and below, where the edge is softer.
VISIBLE_LIMBUS_MM: Final = np.array(
    [[half_way_mm(k / CONTOUR * 2 * np.pi)] for k in range(CONTOUR)]
)


def on_surface(s: Array) -> Array:
    """Return the points (..., 3) of the eye's front above (..., 2)."""
    height, _ = surface_height(np.hypot(s[..., 0], s[..., 1]))
    return np.concatenate([s, height[..., None]], axis=-1)


def seen_through(s: Array, camera_mm: Array) -> Array:
    """Return the iris points (..., 2) that a camera sees through the cornea above (..., 2)."""
    p = on_surface(s)
    bent = refract(unit(p - camera_mm), surface_normal(p), ior_ratio=1.0 / CORNEA_IOR)
    return to_iris_plane(p, bent)
