"""Soft light for certification: surroundings as plain functions of direction. Pure numpy.

Without a sun: light that falls in through a smooth cornea cannot be traced from a point-like
source. World axes: y up, z from the face to the viewer.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.light import Sky
from renderer.park.cube_faces import face_directions
from renderer.park.environments import project_to_sh

Array = npt.NDArray[np.float64]

FACE_PX: Final = 128  # of the cube that the cornea mirrors
GATHER_PX: Final = 32  # of the cube that it gathers light from
LAT_LONG_PX: Final = 256  # height of the path tracer's picture

_ZENITH: Final = np.array([0.55, 0.75, 1.05])
_HORIZON: Final = np.array([0.75, 0.78, 0.80])
_GROUND: Final = np.array([0.22, 0.20, 0.16])
_BOX: Final = np.array([2.6, 2.5, 2.35])
_BOX_AXIS: Final = np.array([-0.45, 0.50, 0.74]) / math.sqrt(0.45**2 + 0.50**2 + 0.74**2)
_BOX_HALF_DEG: Final = 40.0
_BOX_EDGE_DEG: Final = 10.0


@dataclass(frozen=True)
class SoftEnvironment:
    """Surroundings by name: ``radiance`` of unit directions (n, 3) is linear Rec. 709 (n, 3)."""

    name: str
    title: str
    radiance: Callable[[Array], Array]

    def faces(self, size: int) -> Array:
        """Return the surroundings as cube faces (6, size, size, 3)."""
        directions = [face_directions(size, face).reshape(-1, 3) for face in range(6)]
        return np.stack([self.radiance(d).reshape(size, size, 3) for d in directions])

    def sky(self) -> Sky:
        """Return the light as the renderer knows it, without a sun."""
        return Sky(
            sun_direction=np.array([0.0, 0.0, 1.0]),
            sun_irradiance=np.zeros(3),
            ambient_sh=project_to_sh(self.faces(FACE_PX)),
            faces=self.faces(GATHER_PX),
        )


def constant(directions: Array) -> Array:
    """Return radiance 1 from everywhere."""
    return np.ones((len(directions), 3))


def gradient(directions: Array) -> Array:
    """Return an overcast day: blue above, bright at the horizon, dark soil below."""
    up = directions[:, 1:2]
    above = _HORIZON + (_ZENITH - _HORIZON) * np.clip(up, 0.0, 1.0)
    below = _HORIZON + (_GROUND - _HORIZON) * _smooth(np.clip(-3.0 * up, 0.0, 1.0))
    return np.asarray(np.where(up > 0.0, above, below))


def soft_box(directions: Array) -> Array:
    """Return a dim room with one broad lamp, 80 degrees wide, above and beside the camera."""
    off_deg = np.degrees(np.arccos(np.clip(directions @ _BOX_AXIS, -1.0, 1.0)))[:, None]
    share = _smooth(np.clip((_BOX_HALF_DEG - off_deg) / _BOX_EDGE_DEG + 0.5, 0.0, 1.0))
    return np.asarray(0.25 * gradient(directions) + share * _BOX)


def _smooth(x: Array) -> Array:
    return x * x * (3.0 - 2.0 * x)


ENVIRONMENTS: Final = (
    SoftEnvironment("constant", "the same light from everywhere", constant),
    SoftEnvironment("gradient", "an overcast sky over dark soil", gradient),
    SoftEnvironment("soft-box", "a dim room with one broad lamp", soft_box),
)
