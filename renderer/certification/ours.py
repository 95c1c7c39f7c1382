"""Our side of a comparison: the real eye program, lids wide open, no head, linear radiance.

The effects that the path tracer's twin has: the iris map, refraction, caustics, the analytic
surface and a smooth tear film. Off: subsurface, the relief of iris and tear film (levels below
high have none), the sclera's bumps.
"""

from __future__ import annotations

import math
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.certification.environments import FACE_PX, SoftEnvironment
from renderer.certification.view import HALF_MM, TARGET_MM, View
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.calibration import open_lids
from renderer.eye.eyes import Eyes
from renderer.eye.models import EyeModels
from renderer.eye.place import eye_centre_mm
from renderer.light import Light
from renderer.view import look_at

Picture = npt.NDArray[np.float32]

CERTIFIED: Final = Detail(
    texture="medium",
    refraction="ultra",
    reflection="medium",
    subsurface="off",
    caustics="high",
    tessellation="ultra",
    sclera="medium",
)
# Samples lie so close that the maps are read unfiltered, and a pixel is their mean: a box filter,
# as the path tracer's.
SAMPLES_PER_MM: Final = 40


def spec_of(
    iris_seed: int, iris_colour: str, *, pupil_mm: float = 4.0, is_even: bool = False
) -> ClipSpec:
    """Return the clip whose left eye is certified; ``is_even`` gives the iris one colour."""
    return ClipSpec(
        left=CERTIFIED.with_levels(texture="off") if is_even else CERTIFIED,
        right=Detail.uniform("off"),
        iris_seed=iris_seed,
        iris_colour=iris_colour,
        pupil_mm=pupil_mm,
        crowd=0,
    )


def our_eye(gl: moderngl.Context, spec: ClipSpec, environment: SoftEnvironment) -> Eyes:
    """Build the eye in its light."""
    nothing_in_the_way = gl.texture((1, 1), 1, np.ones(1, np.float32).tobytes(), dtype="f4")
    light = Light(environment.sky(), nothing_in_the_way, np.eye(4, dtype=np.float32))
    faces = np.pad(environment.faces(FACE_PX), ((0, 0), (0, 0), (0, 0), (0, 1)))
    data = np.ascontiguousarray(faces, dtype=np.float16).tobytes()
    rims = open_lids()
    return Eyes(
        gl,
        EyeModels(
            gl,
            spec,
            rims=(rims, rims),
            light=light,
            static_cube=lambda _size: gl.texture_cube((FACE_PX, FACE_PX), 4, data, dtype="f2"),
            crowd_cube=None,
            has_face=False,
        ),
    )


def our_picture(gl: moderngl.Context, eyes: Eyes, view: View) -> Picture:
    """Draw the viewer's left eye; linear radiance (n, n, 3), first row on top."""
    samples = math.ceil(SAMPLES_PER_MM * 2 * HALF_MM / view.size_px)  # along each axis of a pixel
    side = samples * view.size_px
    target = gl.framebuffer(
        [gl.texture((side, side), 4, dtype="f4")], gl.depth_texture((side, side))
    )
    target.use()
    target.clear()
    centre = eye_centre_mm(0)
    camera = centre + view.camera_mm
    uniforms: dict[str, Any] = {
        "view_matrix": look_at(camera, centre + TARGET_MM),
        "projection": view.projection,
        "camera_mm": camera,
    }
    eyes.draw(0, **uniforms)
    pixels = np.frombuffer(target.read(components=3, dtype="f4"), np.float32)
    boxes = pixels.reshape(view.size_px, samples, view.size_px, samples, 3)
    return np.asarray(boxes.mean(axis=(1, 3))[::-1], dtype=np.float32)
