"""The light of a scene as all shaders see it: sun, ambient light, shadow map.

One record, one set of uniform names (``shaders/light.glsl``), so that the eye, the skin and the
crowd stand in the same light. Radiometric values are linear Rec. 709, scaled so that a white
Lambertian surface facing the sun leaves with a radiance of about 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.gl.uniforms import constant
from renderer.park.cube_lookup import look_up
from renderer.spherical_harmonics import ambient_uniforms, sh_basis

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Sky:
    """What an environment gives at a sun position, without any GL.

    ``sun_direction`` is a unit vector towards the sun in world space; ``sun_irradiance`` (3,) what
    falls on a surface that faces it; ``ambient_sh`` (9, 3) the spherical-harmonic coefficients of
    the surroundings' radiance without the sun (real, orthonormal, Ramamoorthi and Hanrahan 2001).
    ``faces`` (6, n, n, 3) are the same surroundings as a small cube map, which the cornea gathers
    light from; without them the harmonics stand in.
    """

    sun_direction: Vector
    sun_irradiance: Vector
    ambient_sh: Vector
    faces: Vector | None = None

    @cached_property
    def ambient(self) -> dict[str, Any]:
        """What ``light.glsl`` reads of ``ambient_sh``."""
        return ambient_uniforms(self.ambient_sh)

    def radiance(self, directions: Vector) -> Vector:
        """Return the surroundings' radiance without the sun towards unit directions (n, 3)."""
        if self.faces is not None:
            return look_up(self.faces, directions)
        return np.maximum(sh_basis(directions) @ self.ambient_sh, 0.0)


@dataclass(frozen=True)
class Light:
    """The sky's numbers with the head's sun shadow map (depth, compared in the shader)."""

    sky: Sky
    shadow_map: moderngl.Texture
    world_to_shadow: npt.NDArray[np.float32]

    def uniforms(self) -> dict[str, Any]:
        """Return every uniform and texture of ``shaders/light.glsl`` by name."""
        return self._uniforms

    @cached_property
    def _uniforms(self) -> dict[str, Any]:
        ambient = {name: constant(values) for name, values in self.sky.ambient.items()}
        return {
            "u_sun_direction": constant(self.sky.sun_direction),
            "u_sun_irradiance": constant(self.sky.sun_irradiance),
            **ambient,
            "u_sun_shadow": self.shadow_map,
            "u_world_to_shadow": constant(self.world_to_shadow),
        }
