"""Light on the iris, measured by the path tracer with its camera inside the anterior chamber.

No path can be traced from a point-like sun through a smooth cornea to a camera outside. From
inside, sunlight is a caustic on a matt plane, which particles find easily.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.certification.environments import SoftEnvironment
from renderer.certification.tracing import DEPTH, emitter
from renderer.certification.twin import even_iris, eye_shapes
from renderer.eye.anatomy import IRIS_Z_MM
from renderer.eye.caustics import MAP_EDGE_MM, caustic_map
from renderer.eye.chamber import chamber_irradiance

Array = npt.NDArray[np.float64]

CAMERA_MM: Final = 2.6  # above the iris plane: still below the cornea
HALF_MM: Final = 5.2  # half the side of the square that the camera sees
DISC_MM: Final = 5.0  # what is compared: beyond it lie the limbus's soft shadow and the root
CAUSTIC_PX: Final = 256  # of the level high: 0.05 mm
MATT: Final = 0.02  # the iris's reflectance: what it sends back to itself counts for nothing
_GREY: Final = np.full((2, 2, 3), 0.5)


@dataclass(frozen=True)
class Irradiance:
    """Irradiance on the iris plane by both, (n, n) each, row 0 highest; noise of the traced one."""

    ours: Array
    traced: Array
    noise: Array

    @property
    def disc(self) -> npt.NDArray[np.bool_]:
        """The texels that are compared."""
        x, y = _points(len(self.ours))
        return np.asarray(np.hypot(x, y) < DISC_MM)

    @property
    def mean_error(self) -> float:
        """Relative difference of the two means over the disc."""
        return float(self.ours[self.disc].mean() / self.traced[self.disc].mean() - 1.0)

    @property
    def mean_noise(self) -> float:
        """Relative standard error of the traced mean."""
        half = self.noise[self.disc]
        return float(np.sqrt(np.mean(half**2) / len(half)) / self.traced[self.disc].mean())

    @property
    def spatial_rms(self) -> float:
        """Rms difference over the disc relative to the mean, the tracer's noise included."""
        gap = (self.ours - self.traced)[self.disc]
        return float(np.sqrt(np.mean(gap**2)) / self.traced[self.disc].mean())

    @property
    def spatial_noise(self) -> float:
        """Rms noise of the traced picture over the disc relative to the mean."""
        return float(np.sqrt(np.mean(self.noise[self.disc] ** 2)) / self.traced[self.disc].mean())


def sun_inside(mi: Any, angle_deg: float, *, size_px: int, spp: int, seed: int = 0) -> Irradiance:
    """Compare the caustic of a sun ``angle_deg`` off the gaze, irradiance 1 where it faces it."""
    sun = np.array([math.sin(math.radians(angle_deg)), 0.0, math.cos(math.radians(angle_deg))])
    light = {"type": "directional", "direction": (-sun).tolist(), "irradiance": 1.0}
    traced, noise = _traced(mi, light, "ptracer", size_px=size_px, spp=spp, seed=seed)
    return Irradiance(_on_pixels(caustic_map(sun, CAUSTIC_PX)[..., 2], size_px), traced, noise)


def environment_inside(
    mi: Any, environment: SoftEnvironment, *, size_px: int, spp: int, seed: int = 0
) -> Irradiance:
    """Compare the light that an environment sends into the chamber; means of the three channels."""
    light = emitter(mi, environment)
    traced, noise = _traced(mi, light, "path", size_px=size_px, spp=spp, seed=seed)
    ours = chamber_irradiance(environment.sky().radiance, np.eye(3), rims=None).mean(axis=-1)
    return Irradiance(_on_pixels(ours, size_px), traced, noise)


def _traced(
    mi: Any, light: dict[str, Any], integrator: str, *, size_px: int, spp: int, seed: int
) -> tuple[Array, Array]:
    scene = mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": integrator, "max_depth": DEPTH, "hide_emitters": True},
            "sensor": _camera(mi, size_px),
            "light": light,
            **eye_shapes(mi, even_iris(MATT), _GREY),
        }
    )
    first, second = (
        math.pi / MATT * np.asarray(mi.render(scene, spp=spp // 2, seed=2 * seed + half))
        for half in (0, 1)
    )
    mean, half_gap = 0.5 * (first + second), 0.5 * (first - second)
    return mean.mean(axis=-1, dtype=np.float64), half_gap.mean(axis=-1, dtype=np.float64)


def _camera(mi: Any, size_px: int) -> dict[str, Any]:
    place = [0.0, 0.0, IRIS_Z_MM + CAMERA_MM]
    return {
        "type": "perspective",
        "fov": 2 * math.degrees(math.atan(HALF_MM / CAMERA_MM)),
        "near_clip": 0.01,
        "to_world": mi.ScalarTransform4f().look_at(
            origin=place, target=[0.0, 0.0, 0.0], up=[0.0, 1.0, 0.0]
        ),
        "film": {
            "type": "hdrfilm",
            "width": size_px,
            "height": size_px,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
            "component_format": "float32",
        },
    }


def _points(size_px: int) -> tuple[Array, Array]:
    axis = ((np.arange(size_px) + 0.5) / size_px * 2 - 1) * HALF_MM
    x, y = np.meshgrid(axis, -axis)
    return x, y


def _on_pixels(plane: npt.NDArray[np.floating], size_px: int) -> Array:
    """Return a map of the iris plane (row 0 lowest) as the camera sees it, averaged per pixel."""
    fine = 4
    x, y = _points(size_px * fine)
    texel = np.stack([y, x]) * (len(plane) / (2 * MAP_EDGE_MM)) + (len(plane) - 1) / 2
    seen = ndimage.map_coordinates(np.asarray(plane, np.float64), texel, order=1, mode="nearest")
    return np.asarray(seen.reshape(size_px, fine, size_px, fine).mean(axis=(1, 3)))
