"""What may surround the face, each as a shader's uniforms and as light: the park, or a picture.

An environment's shader draws cube faces with ``environment_radiance(d)``, everything but the sun.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, Protocol

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.cache import cached_arrays
from renderer.clip import ClipSpec
from renderer.light import Sky, Vector
from renderer.park.cube_faces import FACE_AXES, face_directions, read_face
from renderer.park.image import ImageEnvironment, load_environment
from renderer.park.sky import clear_sky
from renderer.park.skyline import park_skyline
from renderer.spherical_harmonics import sh_basis
from renderer.textures.tiling import tiling_noise

AMBIENT_PX: Final = 64

StaticCube = Callable[[int], moderngl.TextureCube]


class Environment(Protocol):
    """What surroundings are drawn from."""

    face_shader: str

    def uniforms(self, footprint_rad: float) -> dict[str, Any]:
        """Return what the face shader needs, for texels of that angle."""

    def sky(self, cube: StaticCube) -> Sky:
        """Return the light; ``cube`` draws the surroundings at a size."""


def make_environment(gl: moderngl.Context, spec: ClipSpec) -> Environment:
    """Return the environment of a clip."""
    if spec.environment == "image":
        return Picture(gl, load_environment(spec), turn_deg=spec.environment_turn_deg)
    return Park(gl, spec)


class Park:
    """A park on a clear day, its sun where the clip has it."""

    face_shader = "environment_face.frag"

    def __init__(self, gl: moderngl.Context, spec: ClipSpec) -> None:
        self._clear = clear_sky(spec.sun_azimuth_deg, spec.sun_elevation_deg)
        self._maps = _park_maps(gl)

    def uniforms(self, footprint_rad: float) -> dict[str, Any]:
        """Return the uniforms of ``shaders/environment.glsl``."""
        return {**self._clear.uniforms(), **self._maps, "u_footprint_rad": footprint_rad}

    def sky(self, cube: StaticCube) -> Sky:
        """Return the sun, and the ambient light of a small cube map."""
        drawn = cube(AMBIENT_PX)
        faces = np.stack([read_face(drawn, face)[..., :3] for face in range(6)])
        return Sky(
            sun_direction=self._clear.sun_direction,
            sun_irradiance=self._clear.sun_irradiance,
            ambient_sh=project_to_sh(faces),
        )


class Picture:
    """A user's HDR picture, turned about the vertical axis."""

    face_shader = "environment_image_face.frag"

    def __init__(self, gl: moderngl.Context, image: ImageEnvironment, *, turn_deg: float) -> None:
        self._sky = image.sky
        self._turn_rad = float(np.radians(turn_deg))
        data = np.ascontiguousarray(image.radiance, dtype=np.float16)
        self._texture = gl.texture(data.shape[1::-1], 3, data.tobytes(), dtype="f2", alignment=1)
        self._texture.build_mipmaps()
        self._texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        self._texture.repeat_y = False

    def uniforms(self, footprint_rad: float) -> dict[str, Any]:
        """Return the uniforms of ``shaders/environment_image.glsl``."""
        return {
            "u_environment_image": self._texture,
            "u_environment_turn_rad": self._turn_rad,
            "u_footprint_rad": footprint_rad,
        }

    def sky(self, cube: StaticCube) -> Sky:
        """Return the light that the picture was split into."""
        del cube  # the picture itself is more exact
        return self._sky


def project_to_sh(faces: npt.NDArray[np.floating]) -> Vector:
    """Project cube faces (6, n, n, 3) on the first nine spherical harmonics, (9, 3).

    Real orthonormal basis in the order of Ramamoorthi and Hanrahan 2001, eq. 3.
    """
    size = faces.shape[1]
    total = np.zeros((9, 3))
    for face in range(6):
        d = face_directions(size, face)
        # Solid angle of a texel: 4 / n^2 / (1 + s^2 + t^2)^1.5, and 1 / that root is the cosine.
        cosine = np.abs(d @ FACE_AXES[face][:, 2])
        weight = 4.0 / size**2 * cosine**3
        total += np.einsum(
            "ijk,ijc->kc", sh_basis(d) * weight[..., None], faces[face].astype(float)
        )
    return np.asarray(total)


def _park_maps(gl: moderngl.Context) -> dict[str, moderngl.Texture]:
    skyline = cached_arrays("park skyline", lambda: dict(park_skyline()))
    noise = cached_arrays("tiling noise", lambda: {"noise": tiling_noise()})["noise"]
    return {
        "u_noise": _texture(gl, noise, wraps_y=True),
        "u_skyline_albedo": _texture(gl, skyline["albedo"], wraps_y=False),
        "u_skyline_shape": _texture(gl, skyline["shape"], wraps_y=False),
    }


def _texture(
    gl: moderngl.Context, pixels: npt.NDArray[np.generic], *, wraps_y: bool
) -> moderngl.Texture:
    height, width, channels = pixels.shape
    texture = gl.texture((width, height), channels, np.ascontiguousarray(pixels).tobytes())
    texture.build_mipmaps()
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    texture.repeat_y = wraps_y
    return texture
