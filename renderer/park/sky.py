"""A clear day's sky and sun as numbers: Preetham's daylight, the air's transmittance. Pure numpy.

Luminance is scaled so that a white Lambertian surface facing the sun leaves with radiance 1: the
exposure follows the sun's elevation like a photographer's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

TURBIDITY: Final = 3.0  # a clear, slightly hazy day
# Thin haze lifts a real sky above Preetham's clear one; it also softens the light as a portrait
# photographer would wish.
SKY_GAIN: Final = 1.4
# Light that haze scatters by a few degrees, which Preetham's sky is too flat to hold: two lobes
# exp(-angle / width), each with its share of the disc's irradiance. A few per cent of the beam come
# from around the disc on a hazy day; the shares and widths are chosen by eye within that.
AUREOLE: Final = ((0.020, 1.2), (0.030, 5.0))  # share, width in degrees
LOWEST_SUN_DEG: Final = 4.0  # for the sun's colour: below, its light is too red for a portrait
# Preetham, Shirley and Smits 1999, appendix A.2: slope and offset in T, rows A to E, columns
# Y, x, y.
_PEREZ_SLOPE: Final = np.array(
    [
        [0.1787, -0.0193, -0.0167],
        [-0.3554, -0.0665, -0.0950],
        [-0.0227, -0.0004, -0.0079],
        [0.1206, -0.0641, -0.0441],
        [-0.0670, -0.0033, -0.0109],
    ]
)
_PEREZ_OFFSET: Final = np.array(
    [
        [-1.4630, -0.2592, -0.2608],
        [0.4275, 0.0008, 0.0092],
        [5.3251, 0.2125, 0.2102],
        [-2.5771, -0.8989, -1.6537],
        [0.3703, 0.0452, 0.0529],
    ]
)
# Ibid.: zenith chromaticity; rows T^2, T, 1; columns theta^3 .. 1.
_ZENITH_X: Final = np.array(
    [
        [0.00166, -0.00375, 0.00209, 0.0],
        [-0.02903, 0.06377, -0.03202, 0.00394],
        [0.11693, -0.21196, 0.06052, 0.25886],
    ]
)
_ZENITH_Y: Final = np.array(
    [
        [0.00275, -0.00610, 0.00317, 0.0],
        [-0.04214, 0.08970, -0.04153, 0.00516],
        [0.15346, -0.26756, 0.06670, 0.26688],
    ]
)
# IEC 61966-2-1: CIE XYZ to linear Rec. 709.
XYZ_TO_RGB: Final = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)
LUMINANCE: Final = np.array([0.2126, 0.7152, 0.0722])  # Rec. 709 weights
_WAVELENGTHS_UM: Final = np.array([0.610, 0.550, 0.465])  # centres of the three channels


@dataclass(frozen=True)
class ClearSky:
    """The sky without clouds at one position of the sun.

    ``perez`` (5, 3) and ``zenith`` (3,) describe Y, x, y; ``scale`` brings Y to scene radiance;
    ``sun_irradiance`` (3,) falls on a surface facing the sun, ``sky_irradiance`` (3,) on
    level ground.
    """

    sun_direction: Array
    perez: Array
    zenith: Array
    scale: float
    sun_irradiance: Array
    sky_irradiance: Array

    def radiance(self, directions: Array) -> Array:
        """Return linear Rec. 709 radiance (n, 3) towards unit ``directions`` (n, 3)."""
        cos_theta = np.clip(directions[:, 1], 0.01, 1.0)[:, None]
        cos_gamma = np.clip(directions @ self.sun_direction, -1.0, 1.0)[:, None]
        Yxy = self.zenith * _perez(self.perez, cos_theta, cos_gamma)
        return rgb_from_yxy(Yxy) * self.scale + aureole(np.arccos(cos_gamma)) * self.sun_irradiance

    def uniforms(self) -> dict[str, Any]:
        """Return the sky's uniforms of ``shaders/environment.glsl`` by name."""
        return {
            "u_environment_sun": self.sun_direction,
            "u_environment_sun_irradiance": self.sun_irradiance,
            "u_environment_sky_irradiance": self.sky_irradiance,
            "u_perez": self.perez,
            "u_aureole": aureole_lobes(),
            "u_zenith": np.append(self.zenith[:1] * self.scale, self.zenith[1:]),
        }


def clear_sky(azimuth_deg: float, elevation_deg: float) -> ClearSky:
    """Return the sky for a sun position; azimuth 0 lies before the face, positive to the right."""
    azimuth, elevation = math.radians(azimuth_deg), math.radians(elevation_deg)
    sun = np.array(
        [
            math.sin(azimuth) * math.cos(elevation),
            math.sin(elevation),
            math.cos(azimuth) * math.cos(elevation),
        ]
    )
    perez = _PEREZ_SLOPE * TURBIDITY + _PEREZ_OFFSET
    zenith = (
        _zenith(math.pi / 2 - elevation)
        / _perez(perez, np.ones((1, 1)), np.array([[sun[1]]])).ravel()
    )
    colour = _sun_colour(elevation)
    on_sun, on_ground = _irradiances(ClearSky(sun, perez, zenith, 1.0, np.zeros(3), np.zeros(3)))
    # Clear-day daylight: the sun gives about 100 klx, so 1 kcd/m2 is 1/38 of the white reference.
    scale = SKY_GAIN / 38.0
    sun_luminance = max(math.pi - float(on_sun @ LUMINANCE) * scale, 0.3 * math.pi)
    disc = 1.0 / (1.0 + sum(share for share, _ in AUREOLE))  # what the haze leaves of the beam
    irradiance = disc * colour * sun_luminance / float(colour @ LUMINANCE)
    beside = (1.0 / disc - 1.0) * max(float(sun[1]), 0.0) * irradiance
    return ClearSky(sun, perez, zenith, scale, irradiance, on_ground * scale + beside)


def aureole_lobes() -> Array:
    """Return the aureole's lobes (2, 2): radiance at the sun per irradiance of it, width in rad."""
    width = np.radians([degrees for _, degrees in AUREOLE])
    # The integral of exp(-a / w) over small angles is 2 pi w^2.
    return np.stack([[s for s, _ in AUREOLE] / (2 * math.pi * width**2), width], axis=1)


def aureole(angle: Array) -> Array:
    """Return the haze's radiance at angles in rad from the sun, per irradiance of the sun."""
    return np.asarray(sum(peak * np.exp(-angle / width) for peak, width in aureole_lobes()))


def rgb_from_yxy(Yxy: Array) -> Array:
    """Convert luminance and chromaticity (n, 3) to linear Rec. 709, negative values cut."""
    Y, x, y = Yxy[:, 0], Yxy[:, 1], Yxy[:, 2]
    XYZ = np.stack([x / y * Y, Y, (1 - x - y) / y * Y], axis=1)
    return np.asarray(np.maximum(XYZ @ XYZ_TO_RGB.T, 0.0))


def _perez(perez: Array, cos_theta: Array, cos_gamma: Array) -> Array:
    # Perez et al. 1993, as in Preetham et al. 1999, eq. 3.
    A, B, C, D, E = perez
    gamma = np.arccos(cos_gamma)
    gradation = 1 + A * np.exp(B / cos_theta)
    return np.asarray(gradation * (1 + C * np.exp(D * gamma) + E * cos_gamma**2))


def _zenith(sun_theta: float) -> Array:
    """Return the zenith's luminance in kcd/m2 and chromaticity for a sun angle from the zenith."""
    T = TURBIDITY
    chi = (4 / 9 - T / 120) * (math.pi - 2 * sun_theta)
    Y = (4.0453 * T - 4.9710) * math.tan(chi) - 0.2155 * T + 2.4192
    powers = np.array([sun_theta**3, sun_theta**2, sun_theta, 1.0])
    turbidity = np.array([T * T, T, 1.0])
    return np.array([Y, turbidity @ _ZENITH_X @ powers, turbidity @ _ZENITH_Y @ powers])


def _sun_colour(elevation: float) -> Array:
    """Return the transmittance of the air for the sun's three channels."""
    degrees = max(math.degrees(elevation), LOWEST_SUN_DEG)
    # Kasten and Young 1989: relative air mass.
    mass = 1 / (math.sin(math.radians(degrees)) + 0.50572 * (degrees + 6.07995) ** -1.6364)
    rayleigh = 0.008735 * _WAVELENGTHS_UM**-4.08
    aerosol = (0.04608 * TURBIDITY - 0.04586) * _WAVELENGTHS_UM**-1.3
    return np.asarray(np.exp(-mass * (rayleigh + aerosol)))


def _irradiances(sky: ClearSky) -> tuple[Array, Array]:
    """Integrate the clear sky on a surface facing the sun and on level ground."""
    y = (np.arange(48) + 0.5) / 48
    phi = (np.arange(96) + 0.5) / 96 * 2 * math.pi
    grid_y, grid_phi = np.meshgrid(y, phi, indexing="ij")
    ring = np.sqrt(1 - grid_y**2)
    directions = np.stack([ring * np.sin(grid_phi), grid_y, ring * np.cos(grid_phi)], -1)
    directions = directions.reshape(-1, 3)
    radiance = sky.radiance(directions) * (2 * math.pi / len(directions))
    facing = np.maximum(directions @ sky.sun_direction, 0.0)
    return facing @ radiance, directions[:, 1] @ radiance
