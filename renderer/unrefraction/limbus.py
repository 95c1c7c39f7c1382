"""The limbus as a photograph shows it: how clear tissue turns white, and the dark ring around it.

The sclera overlaps the cornea in a soft edge. Where it thins out over the dark chamber angle, light
is lost: a ring that fades slowly into the iris and faster into the white, strongest in young eyes
(Peshek et al. 2011). Its middle lies 0.1 mm inside of the edge's, so that half of the light between
iris and white is reached further out than half of the tissue. Eyes are drawn with the same numbers
(shaders/tear_film.glsl); a test compares both. The edge wanders: where the sclera reaches further
in, it also thins out more slowly.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import LIMBUS_INSET_MM, LIMBUS_RADIUS_MM, LIMBUS_WIDTH_MM

Field = npt.NDArray[np.floating[Any]]

EDGE_MM: Final = LIMBUS_RADIUS_MM - LIMBUS_INSET_MM  # half of the tissue is clear
PANNUS: Final = 0.25  # how much wider edge and ring are above and below
RING_INSIDE_MM: Final = 0.1  # from the edge's middle to the ring's darkest line
RING: Final = np.array([0.50, 0.56, 0.64], np.float32)  # what it leaves there, ...
RING_ON_WHITE: Final = np.array([0.58, 0.65, 0.72], np.float32)  # ... and from here outwards:
ON_WHITE_MM: Final = 0.3
RING_REACH_MM: Final = (0.50, 0.36)  # inwards and outwards, of a bell exp(-x^2)

WANDER_MM: Final = 0.030  # standard deviation of the edge's way inwards and outwards
WANDER_WIDTH: Final = 0.15  # how much wider the edge is where it lies one deviation further in
WANDER_REACH_MM: Final = 0.65  # how far inwards and outwards the edge's way still tells of tissue
LEAST_WIDTH_MM: Final = 0.04

IRIS_OF_WHITE: Final = 0.1  # red and green, beside the limbus: 0.04 in dark brown, 0.18 in grey


@dataclass(frozen=True)
class Limbus:
    """The veil's shape: share of iris = 1 / (1 + exp((r - middle) / width)), r on the surface.

    ``ring`` is the dark ring's strength: 0 is none, 1 an average adult's. ``wander`` says in evenly
    spaced directions, from +x anticlockwise, how many deviations further in the edge lies.
    Distances and directions are those of ``Texels``: from the eye's axis, heights scaled by the
    limbus's own.
    """

    middle_mm: float = EDGE_MM
    width_mm: float = LIMBUS_WIDTH_MM
    ring: float = 1.0
    wander: tuple[float, ...] = ()

    def clear(self, surface_mm: Field, bearing: Field) -> Field:
        """Return the share of light that comes from the iris."""
        wander = self._wander_at(surface_mm, bearing)
        width = self.width_mm * (1.0 + _pannus(bearing) + WANDER_WIDTH * wander)
        off = surface_mm - self.middle_mm + WANDER_MM * wander
        far = np.clip(off / np.maximum(width, LEAST_WIDTH_MM), -30, 30)
        return np.asarray(1.0 / (1.0 + np.exp(far)), surface_mm.dtype)

    def dimmed(self, surface_mm: Field, bearing: Field) -> Field:
        """Return the share of light that the dark ring leaves, (..., 3)."""
        off = (
            surface_mm
            - self.middle_mm
            + WANDER_MM * self._wander_at(surface_mm, bearing)
            + RING_INSIDE_MM
        )
        reach = np.where(off < 0.0, *RING_REACH_MM) * (1.0 + _pannus(bearing))
        outwards = np.clip(off / ON_WHITE_MM, 0.0, 1.0)[..., None]
        darkest = (1.0 - outwards) * RING + outwards * RING_ON_WHITE
        bell = np.exp(-np.square(off / reach))[..., None]
        return np.asarray(1.0 - self.ring * (1.0 - darkest) * bell, surface_mm.dtype)

    def _wander_at(self, surface_mm: Field, bearing: Field) -> Field:
        if not self.wander:
            return np.zeros_like(bearing)
        at = np.arange(len(self.wander)) / len(self.wander) * 2 * np.pi
        far = (surface_mm - self.middle_mm) / WANDER_REACH_MM
        wander = np.interp(bearing, at, self.wander, period=2 * np.pi)
        return np.asarray(wander * np.exp(-np.square(far)), bearing.dtype)


def _pannus(bearing: Field) -> Field:
    return np.asarray(PANNUS * np.square(np.sin(bearing)))


def mean_edge_mm(limbus: Limbus) -> float:
    """Return the edge's mean distance from the axis in all directions that were seen."""
    return limbus.middle_mm - WANDER_MM * float(np.mean(limbus.wander or 0.0))


def half_way_mm(bearing: float) -> float:
    """Return where the average eye's light has climbed half of its step from iris to white."""
    return climbed_mm(bearing, 0.5)


def climbed_mm(bearing: float, share: float) -> float:
    """Return where the average eye's light has climbed a share of its step from iris to white.

    Both sides are taken where ``edges.edge_points`` takes them: 6 to 18 % of the radius away.
    """
    r = np.linspace(0.8, 1.2, 1601) * LIMBUS_RADIUS_MM
    across, limbus = np.full_like(r, bearing), Limbus()
    clear = limbus.clear(r, across)
    ring = limbus.dimmed(r, across) @ np.array([0.6, 0.4, 0.0])
    light = ring * (clear * IRIS_OF_WHITE + (1.0 - clear))
    off = r / LIMBUS_RADIUS_MM - 1.0
    inner, outer = (np.median(light[(s * off > 0.06) & (s * off < 0.18)]) for s in (-1, 1))
    outside = off > -RING_INSIDE_MM / LIMBUS_RADIUS_MM  # from here the light only grows
    level = inner + share * (outer - inner)
    return float(np.interp(level, light[outside], r[outside]))
