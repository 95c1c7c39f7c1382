"""The thesis's caustics: a pattern as an artist paints it. Pure numpy, and no optics in it.

Section 4.6: a map that "defines patterns which light caustics make in general terms" is summed with
the iris's colour, by the angles of view and light. Ours is a net of strokes, three texels wide at
any size as a brush on that canvas would leave them, densest on the side that faces +x. The shader
turns that side away from the light. At 256 texels the strokes are coarser than the iris's own
strands: what the thesis's viewers found unrealistic.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.eye.anatomy import IRIS_MAP_RADIUS_MM
from renderer.eye.caustics import MAP_EDGE_MM
from renderer.textures.noise import Field, noise_grid
from renderer.textures.sizes import smoothstep

BRUSH_PX: Final = 3.0
_NETS: Final = ((19.0, 0.75), (33.0, 0.45))  # cells over the map, strength of each net
_BLOOM_MM: Final = 0.16  # light beside each stroke
_SEED: Final = 46  # the pattern is one painting: it belongs to no iris


def painted_caustic(size_px: int) -> Field:
    """Return the pattern (size_px, size_px), grey from 0 to 1 in 8-bit steps, row 0 below."""
    line = ((np.arange(size_px) + 0.5) / size_px * 2 - 1) * MAP_EDGE_MM
    x, y = np.meshgrid(line.astype(np.float32), line.astype(np.float32))
    strokes = np.zeros_like(x)
    for number, (cells, strength) in enumerate(_NETS):
        field = noise_grid(size_px, size_px, cells=(cells, cells), seed=_SEED + number)
        strokes += strength * _net(field, 2 * MAP_EDGE_MM / size_px)
    radius = np.hypot(x, y)
    crescent = smoothstep(-0.15, 1.0, x / IRIS_MAP_RADIUS_MM) * smoothstep(1.2, 4.2, radius)
    glow = 0.12 * crescent
    inside = smoothstep(IRIS_MAP_RADIUS_MM, IRIS_MAP_RADIUS_MM - 0.4, radius)
    grey = np.clip((crescent * strokes + glow) * inside, 0.0, 1.0)
    return np.asarray(np.rint(grey * 255.0) / 255.0, np.float32)


def _net(field: Field, texel_mm: float) -> Field:
    """Draw a stroke of the brush's width, and its bloom, where a smooth field is zero."""
    rise_y, rise_x = np.gradient(field)
    across_px = np.abs(field) / np.maximum(np.hypot(rise_x, rise_y), 1e-4)
    stroke = np.exp(-((across_px / (0.5 * BRUSH_PX)) ** 2))
    return np.asarray(0.75 * stroke + 0.35 * np.exp(-across_px * texel_mm / _BLOOM_MM))
