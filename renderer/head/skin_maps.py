"""The skin's pictures on the GPU: relief of the face, relief of the lids, colour; baked once.

Sizes differ, so that nothing repeats where another does. One level of each serves a whole view.
"""

from __future__ import annotations

from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.cache import cached_array
from renderer.head.buffers import TilePyramid
from renderer.head.face_mesh import FaceMesh
from renderer.head.lid_layout import ACROSS_MM, MAP_PX
from renderer.head.lid_relief import SLOPE_RANGE, lid_map
from renderer.head.skin import TILE_MM
from renderer.textures.micro_relief import (
    FACE_NETS,
    Field,
    Tile,
    openness,
    periodic_noise,
    relief,
    slopes,
)

Bytes = npt.NDArray[np.uint8]

RELIEF: Final = Tile(TILE_MM, 1024)  # 32 texels a mm: a pixel each when the iris fills 350
COLOUR: Final = Tile(103.0, 512)  # no multiple of TILE_MM
PORES: Final = 1150  # visible ones, of some 5000 follicles


class SkinMaps:
    """All the pictures that ``skin.frag`` reads."""

    def __init__(self, gl: moderngl.Context, face: FaceMesh) -> None:
        """Bake or fetch the pictures; the lids' follow ``face``, whose lids look straight ahead."""
        self._relief = TilePyramid(gl, cached_array("relief of the face", relief_tile))
        self._colour = TilePyramid(gl, cached_array("colour of the face", colour_tile))
        lids = cached_array("relief of the lids", lambda: lids_map(face))
        self._lids = TilePyramid(gl, lids)

    def uniforms(self, pixels_per_mm: float) -> dict[str, Any]:
        """Return the shader's textures and numbers for a view of this density."""
        relief, lids, colour = (
            density / pixels_per_mm
            for density in (1 / RELIEF.texel_mm, MAP_PX[0] / ACROSS_MM, 1 / COLOUR.texel_mm)
        )
        span = (2 * SLOPE_RANGE) ** 2
        return {
            "u_relief": self._relief.at(relief),
            "u_lids": self._lids.at(lids),
            "u_colour": self._colour.at(colour),
            "u_colour_scale": TILE_MM / COLOUR.edge_mm,
            "u_slope_range": SLOPE_RANGE,
            "u_lost_variance": (
                span * self._relief.lost_variance(relief),
                span * self._lids.lost_variance(lids),
            ),
        }


def lids_map(face: FaceMesh) -> Bytes:
    """Return the map of both eyes' lids, see ``lid_relief``."""
    edges = (_edge(face, 0), _edge(face, 1))
    upper = (face.lids[0].is_upper, face.lids[1].is_upper)
    return lid_map(face.patches, edges_mm=edges, upper=upper)


def _edge(face: FaceMesh, eye: int) -> npt.NDArray[np.float64]:
    lid = face.lids[eye]
    return np.asarray(lid.across_mm[:, lid.rim_row])


def relief_tile(seed: int = 11) -> Bytes:
    """Return the face's relief (1024, 1024, 4) uint8, periodic.

    Red and green: slopes (0.5 flat, plus and minus SLOPE_RANGE); blue: how open to light; alpha:
    fine mottle of the pigment (0.5 average).
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    height = relief(rng, RELIEF, nets=FACE_NETS, pores=PORES)
    slope_x, slope_y = slopes(height, RELIEF)
    mottle = 0.5 * periodic_noise(rng, RELIEF, 0.07) + 0.9 * periodic_noise(rng, RELIEF, 0.2)
    return _bytes(
        0.5 + slope_x * (0.5 / SLOPE_RANGE),
        0.5 + slope_y * (0.5 / SLOPE_RANGE),
        openness(height, RELIEF, reach_mm=0.28, depth_mm=0.085),
        0.5 + 0.13 * mottle,
    )


def colour_tile(seed: int = 12) -> Bytes:
    """Return the face's colours (512, 512, 4) uint8, periodic, each 0.5 on average.

    Red: blood, in blotches of 2 to 8 mm; green: melanin, mottled, with freckles; blue: oil; alpha:
    how pronounced the relief is.
    """
    rng = np.random.Generator(np.random.PCG64(seed))

    def mixed(*shares: tuple[float, float]) -> Field:
        return np.asarray(sum(share * periodic_noise(rng, COLOUR, size) for share, size in shares))

    blood = mixed((0.45, 3.2), (0.6, 1.1), (0.5, 0.45))
    melanin = mixed((0.5, 2.0), (0.4, 0.6), (0.3, 0.3))
    return _bytes(
        0.5 + 0.085 * blood,
        0.5 + 0.10 * melanin + 0.40 * _freckles(rng),
        0.5 + 0.16 * mixed((0.7, 1.6), (0.6, 0.5)),
        0.5 + 0.15 * mixed((0.8, 2.2), (0.6, 0.7)),
    )


def _freckles(rng: np.random.Generator, count: int = 420) -> Field:
    """Return spots of 0.3 to 0.9 mm radius, faint ones the most."""
    field = np.zeros((COLOUR.edge_px, COLOUR.edge_px))
    reach = np.arange(-9, 10)
    for x, y, size, dark in rng.uniform((0, 0, 0, 0), (COLOUR.edge_px,) * 2 + (1, 1), (count, 4)):
        radius = (0.28 + 0.55 * size * size) / COLOUR.texel_mm
        dx, dy = reach[None, :] + int(x) - x, reach[:, None] + int(y) - y
        rows, columns = (int(y) + reach) % COLOUR.edge_px, (int(x) + reach) % COLOUR.edge_px
        field[np.ix_(rows, columns)] += dark**2 * np.exp(-(((dx**2 + dy**2) / radius**2) ** 1.5))
    return np.asarray(np.minimum(field, 1.0) - field.mean())


def _bytes(*layers: Field) -> Bytes:
    """Pack layers of 0 to 1 into the channels of a picture."""
    packed = [np.clip(np.rint(layer * 255), 0, 255).astype(np.uint8) for layer in layers]
    return np.stack(packed, axis=-1)
