"""Subsurface texture mapping of the iris: single scattering through four layers. Pure numpy.

The reference for ``shaders/subsurface.glsl``. Three integrators of the same integral: the thesis's
left-endpoint sum (section 4.5, after Francois et al. 2006), the midpoint rule with many steps as
the truth, and ours: layer interfaces piecewise linear between a few nodes, each piece integrated in
closed form.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Thickness = Callable[[Array], Array]

LAYERS: Final = 4  # anterior border layer, front and back stroma, pigment epithelium
MAX_DEPTH_MM: Final = 0.6  # no iris is thicker than its collarette
MIN_LIGHT_COSINE: Final = 0.35  # lower light is taken to come in like this
DEPTH_MARGIN: Final = 1.15  # the column at the entry point is this much short of its neighbours'


@dataclass(frozen=True)
class Tissue:
    """Coefficients in mm^-1 per layer and channel, (4, 3), and the phase anisotropy g, (4,)."""

    sigma_s: Array
    sigma_t: Array
    anisotropy: Array


@dataclass(frozen=True)
class Path:
    """A view ray in the tissue and the light that it meets.

    ``thickness`` gives the four layers' thickness in mm, (n, 4), below the ray's points at (n,) mm
    along it; the cosines are those of the view ray and the light to the iris's axis, positive;
    ``phase_cosine`` is the cosine between the light's and the returning ray's direction of travel.
    """

    thickness: Thickness
    view_cosine: float
    light_cosine: float
    phase_cosine: float

    @property
    def length_mm(self) -> float:
        """Length of the march: through the column at the entry point with a margin."""
        column = float(self.thickness(np.zeros(1)).sum())
        return min(MAX_DEPTH_MM, DEPTH_MARGIN * column) / self.view_cosine


def henyey_greenstein(cosine: float, anisotropy: Array) -> Array:
    """Return the phase function in 1/sr (Henyey and Greenstein 1941); cosine 1 is forward."""
    g = anisotropy
    return np.asarray((1 - g * g) / (4 * math.pi * (1 + g * g - 2 * g * cosine) ** 1.5))


def left_sum(path: Path, tissue: Tissue, *, samples: int) -> Array:
    """Return radiance per irradiance on the iris, (3,) in 1/sr: the thesis's own sum."""
    step = path.length_mm / samples
    return _riemann(
        path, tissue, at=np.arange(samples, dtype=np.float64) * step, step=step, half=0.0
    )


def midpoint_sum(path: Path, tissue: Tissue, *, samples: int) -> Array:
    """Return the same by the midpoint rule: with thousands of samples, the truth."""
    step = path.length_mm / samples
    return _riemann(
        path, tissue, at=(np.arange(samples, dtype=np.float64) + 0.5) * step, step=step, half=0.5
    )


def _riemann(path: Path, tissue: Tissue, *, at: Array, step: float, half: float) -> Array:
    thickness = path.thickness(at)
    depth = at * path.view_cosine
    interfaces = np.cumsum(thickness, axis=1)
    layer = np.sum(depth[:, None] >= interfaces, axis=1)
    inside = layer < LAYERS
    layer = np.minimum(layer, LAYERS - 1)
    extinction = np.where(inside[:, None], tissue.sigma_t[layer], 0.0) * step
    to_viewer = np.cumsum(extinction, axis=0) - (1.0 - half) * extinction
    from_light = _crossed(thickness, depth) @ tissue.sigma_t / path.light_cosine
    phase = henyey_greenstein(path.phase_cosine, tissue.anisotropy)[layer]
    scattered = np.where(inside[:, None], tissue.sigma_s[layer] * phase[:, None], 0.0)
    strength = scattered * np.exp(-to_viewer - from_light) * step
    return np.asarray(strength.sum(axis=0) / path.light_cosine)


def _crossed(thickness: Array, depth: Array) -> Array:
    """Return how much of each layer lies above points at ``depth``, (n, 4) in mm."""
    tops = np.cumsum(thickness, axis=-1) - thickness
    return np.clip(depth[..., None] - tops, 0.0, thickness)


def piecewise_linear(path: Path, tissue: Tissue, *, nodes: int) -> Array:
    """Return the same from ``nodes`` intervals with linear interfaces, exact in each piece."""
    at = np.linspace(0.0, path.length_mm, nodes + 1)
    thickness, depth = path.thickness(at), at * path.view_cosine
    phase = henyey_greenstein(path.phase_cosine, tissue.anisotropy)
    radiance, to_viewer = np.zeros(3), np.zeros(3)
    for i in range(nodes):
        ends = (thickness[i], thickness[i + 1], depth[i], depth[i + 1])
        pieces = _pieces(ends)
        for a, b in pairwise(pieces):
            length = (b - a) * (at[i + 1] - at[i])
            middle, z = _between(ends, 0.5 * (a + b))
            layer = int(np.sum(z >= np.cumsum(middle)))
            if layer >= LAYERS:
                continue
            start = to_viewer + _light_depth(ends, a, tissue, path.light_cosine)
            to_viewer = to_viewer + tissue.sigma_t[layer] * length
            end = to_viewer + _light_depth(ends, b, tissue, path.light_cosine)
            mean = _mean_transmittance(start, end)
            radiance = radiance + tissue.sigma_s[layer] * phase[layer] * length * mean
    return np.asarray(radiance / path.light_cosine)


Ends = tuple[Array, Array, float, float]


def _pieces(ends: Ends) -> Array:
    """Return 0, the fractions at which the ray crosses an interface, and 1."""
    first, last = np.cumsum(ends[0]) - ends[2], np.cumsum(ends[1]) - ends[3]
    crosses = first * last < 0.0
    fractions = first[crosses] / (first[crosses] - last[crosses])
    return np.concatenate([[0.0], np.sort(fractions), [1.0]])


def _between(ends: Ends, share: float) -> tuple[Array, float]:
    return (
        (1 - share) * ends[0] + share * ends[1],
        float((1 - share) * ends[2] + share * ends[3]),
    )


def _light_depth(ends: Ends, share: float, tissue: Tissue, light_cosine: float) -> Array:
    thickness, depth = _between(ends, share)
    return np.asarray(_crossed(thickness, np.asarray(depth)) @ tissue.sigma_t / light_cosine)


def _mean_transmittance(start: Array, end: Array) -> Array:
    """Return the mean of exp(-tau) for tau running linearly from ``start`` to ``end``."""
    step = end - start
    small = np.abs(step) < 1e-6
    safe = np.where(small, 1.0, step)
    return np.where(small, np.exp(-start), (np.exp(-start) - np.exp(-end)) / safe)


def subsurface_gain(
    mean_thickness_mm: Array, tissue: Tissue, *, light_eye: tuple[float, float] = (0.0, 0.0)
) -> Array:
    """Return the factor (3,) that makes a flat mean column scatter as a white Lambertian would.

    Seen along the axis, lit by light that travels along (x, y, -z) in the tissue, ``light_eye`` its
    x and y. The coefficients of iris tissue are estimates, the iris map's colour is what
    photographs show: so the colour says how bright tissue is on average, and the layers how it
    varies with thickness and view. Without the light's direction slanting light, whose single
    scattering leaves from shallower depths, would brighten the whole iris by up to 0.3.
    """
    cosine = math.sqrt(max(1.0 - light_eye[0] ** 2 - light_eye[1] ** 2, 0.0))
    path = Path(
        lambda at: np.tile(mean_thickness_mm, (len(at), 1)),
        view_cosine=1.0,
        light_cosine=max(cosine, MIN_LIGHT_COSINE),
        phase_cosine=-cosine,
    )
    single = math.pi * piecewise_linear(path, tissue, nodes=4)
    return np.asarray(1.0 / np.maximum(single, 1e-9))
