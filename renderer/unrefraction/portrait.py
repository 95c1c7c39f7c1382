"""Draw one eye alone, lids open, as a photograph saw it: the proof of an iris file. Needs GL."""

from __future__ import annotations

import math
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.clip import ClipSpec
from renderer.colour import linear_to_srgb
from renderer.eye.anatomy import LIMBUS_Z_MM
from renderer.eye.calibration import open_lids
from renderer.eye.eyes import Eyes
from renderer.eye.model import gaze_rotation
from renderer.eye.models import EyeModels
from renderer.eye.place import eye_centre_mm
from renderer.light import Light, Sky
from renderer.view import look_at, perspective

Array = npt.NDArray[np.float64]

SKY: Final = 0.9  # radiance of the even sky: white tissue stays just below full brightness
MIRRORED: Final = 0.35  # of it, what the cornea mirrors: a photographer stands in the way


def portrait(
    gl: moderngl.Context,
    spec: ClipSpec,
    *,
    size_px: int,
    half_view_mm: float = 7.0,
    distance_mm: float = 400.0,
    sky: Sky | None = None,
) -> npt.NDArray[np.float32]:
    """Return the left eye's linear radiance (size_px, size_px, 3), first row on top.

    The camera stands before the face and looks at the limbus's centre; the clip's gaze turns the
    eye. ``sky`` None is an even one without a sun.
    """
    light = Light(sky or even_sky(), _unshaded(gl), np.eye(4, dtype=np.float32))
    mirrored = np.full((6, 4), SKY * MIRRORED, np.float16).tobytes()
    nobody = np.zeros((6, 4), np.float16).tobytes()
    eyes = Eyes(
        gl,
        EyeModels(
            gl,
            spec,
            rims=(open_lids(), open_lids()),
            light=light,
            static_cube=lambda _size: gl.texture_cube((1, 1), 4, mirrored, dtype="f2"),
            crowd_cube=gl.texture_cube((1, 1), 4, nobody, dtype="f2"),
        ),
    )
    turn = gaze_rotation(spec.gaze_yaw_deg, spec.gaze_pitch_deg)
    target = eye_centre_mm(0) + turn @ np.array([0.0, 0.0, LIMBUS_Z_MM])
    camera = target + [0.0, 0.0, distance_mm]
    fov_deg = 2 * math.degrees(math.atan(half_view_mm / distance_mm))
    size = (size_px, size_px)
    frame = gl.framebuffer([gl.texture(size, 4, dtype="f4")], gl.depth_texture(size))
    frame.use()
    frame.viewport = (0, 0, *size)
    frame.clear()
    eyes.draw(
        0,
        view_matrix=look_at(camera, target),
        projection=perspective(fov_deg, 1.0, 0.5 * distance_mm, 2 * distance_mm),
        camera_mm=camera,
    )
    pixels = np.frombuffer(frame.read(components=3, dtype="f4"), np.float32)
    return np.ascontiguousarray(pixels.reshape(size_px, size_px, 3)[::-1])


def developed(radiance: npt.NDArray[np.float32], exposure: float = 1.0) -> npt.NDArray[np.uint8]:
    """Return radiance as a plain camera stores it: scaled, clipped, sRGB, 8 bits."""
    encoded = linear_to_srgb(np.clip(radiance * np.float32(exposure), 0.0, 1.0))
    return np.asarray(np.rint(encoded * 255.0), np.uint8)


def even_sky(sun: float = 0.0) -> Sky:
    """Return a sky of one radiance all around, with a sun of an irradiance high on the left."""
    ambient = np.zeros((9, 3))
    ambient[0] = SKY / 0.282095
    toward = np.array([-0.4, 0.5, 0.77])
    return Sky(toward / np.linalg.norm(toward), np.full(3, sun), ambient)


def _unshaded(gl: moderngl.Context) -> moderngl.Texture:
    return gl.texture((1, 1), 1, np.ones(1, np.float32).tobytes(), dtype="f4")
