"""A user's HDR picture as surroundings: read, checked, its sun made a light of its own.

Pure numpy; ``surroundings`` brings it to the GPU. The picture is scaled so that the brightest side
of a white Lambertian ball leaves with radiance 1, as a photographer would expose it.
``environment_exposure_ev`` moves it from there.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt
from PIL import Image

from renderer.clip import ClipSpec
from renderer.light import Sky, Vector
from renderer.park.lat_long import lat_long_directions, sh_of_lat_long
from renderer.park.sky import LUMINANCE
from renderer.park.sun import separate_sun
from renderer.spherical_harmonics import sh_basis

Radiance = npt.NDArray[np.float32]

LEAST_WIDTH_PX: Final = 64  # below it a picture shows neither a horizon nor a light's place
MOST_WIDTH_PX: Final = 4096  # finer than a cornea can show; wider pictures are averaged down
BRIGHTEST: Final = 6.0e4  # that a half float holds
# Ramamoorthi and Hanrahan 2001, eq. 10: what a cosine lobe does to each order.
_LOBE: Final = np.array([math.pi] + [2 * math.pi / 3] * 3 + [math.pi / 4] * 5)


@dataclass(frozen=True)
class ImageEnvironment:
    """A picture's radiance (height, width, 3) without its sun, scaled, and its light.

    ``sky`` is in world space, turned like the clip asks; the picture itself is not.
    """

    radiance: Radiance
    sky: Sky


def load_environment(spec: ClipSpec) -> ImageEnvironment:
    """Read the picture that a clip names; raises ValueError when it is not what it was."""
    path = Path(spec.environment_file)
    with path.open("rb") as file:
        found = hashlib.file_digest(file, "sha256").hexdigest()
    if found != spec.environment_sha256:
        raise ValueError(
            f"{path}: changed since the clip was named (SHA-256 {found[:12]}..., expected "
            f"{spec.environment_sha256[:12]}...); put the picture back or name the clip anew"
        )
    return light_from(
        read_environment(path),
        turn_deg=spec.environment_turn_deg,
        exposure_ev=spec.environment_exposure_ev,
    )


def read_environment(path: Path) -> Radiance:
    """Read a latitude-longitude picture, OpenEXR or Radiance, and check that it can be one.

    Raises OSError for a file that cannot be read, ValueError for one that cannot light a scene.
    """
    from renderer.exchange.exr import read_exr  # OpenEXR takes its time to load
    from renderer.exchange.radiance import read_radiance

    readers: dict[str, Callable[[Path], Radiance]] = {".exr": read_exr, ".hdr": read_radiance}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise ValueError(f'{path}: unknown kind of picture "{path.suffix}"; .exr or .hdr')
    radiance = reader(path)
    height, width = radiance.shape[:2]
    if width != 2 * height:
        raise ValueError(
            f"{path}: {width} x {height} pixels; a latitude-longitude picture is twice as wide as "
            "high"
        )
    if width < LEAST_WIDTH_PX:
        raise ValueError(f"{path}: {width} pixels wide; {LEAST_WIDTH_PX} or more are needed")
    if not np.isfinite(radiance).all():
        count = int((~np.isfinite(radiance)).any(axis=-1).sum())
        raise ValueError(f"{path}: {count} pixels are infinite or no number; mend the picture")
    if radiance.min() < -1e-3 * radiance.max():
        # Converted primaries and resampling leave specks below zero, negative light does not.
        raise ValueError(f"{path}: values down to {radiance.min():.3g}; radiance is never negative")
    if radiance.max() <= 0:
        raise ValueError(f"{path}: all black; there is no light in it")
    return _shrunk(np.maximum(radiance, 0.0, dtype=np.float32))


def light_from(
    radiance: Radiance, *, turn_deg: float = 0.0, exposure_ev: float = 0.0
) -> ImageEnvironment:
    """Split a picture (height, width, 3) into sun and rest, exposed like a photograph."""
    parts = separate_sun(radiance)
    direction = _turned(parts.direction, turn_deg)
    ambient = sh_of_lat_long(parts.rest, turn_deg=turn_deg)
    sides = np.concatenate([direction[None], lat_long_directions(16, 32).reshape(-1, 3)])
    from_sun = np.maximum(sides @ direction, 0.0)[:, None] * parts.irradiance
    white = ((irradiance(ambient, sides) + from_sun) @ LUMINANCE).max() / math.pi
    scale = 2.0**exposure_ev / white
    return ImageEnvironment(
        np.minimum(parts.rest * np.float32(scale), np.float32(BRIGHTEST)),
        Sky(direction, parts.irradiance * scale, ambient * scale),
    )


def irradiance(sh: Vector, normals: Vector) -> Vector:
    """Return the irradiance (n, 3) of harmonics (9, 3) on surfaces with unit normals (n, 3)."""
    return np.asarray(np.maximum((sh_basis(normals) * _LOBE) @ sh, 0.0))


def _turned(direction: Vector, turn_deg: float) -> Vector:
    """Turn a direction about the vertical axis, from before the face to the viewer's right."""
    sine, cosine = math.sin(math.radians(turn_deg)), math.cos(math.radians(turn_deg))
    x, y, z = direction
    return np.array([x * cosine + z * sine, y, z * cosine - x * sine])


def _shrunk(radiance: Radiance) -> Radiance:
    """Average a wide picture down."""
    if radiance.shape[1] <= MOST_WIDTH_PX:
        return radiance
    size = (MOST_WIDTH_PX, MOST_WIDTH_PX // 2)
    planes = [
        np.asarray(Image.fromarray(radiance[..., c]).resize(size, Image.Resampling.BOX))
        for c in range(3)
    ]
    return np.stack(planes, axis=-1)
