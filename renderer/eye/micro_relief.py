"""The fine relief of the wet white of the eye, as slopes on a tile. Pure numpy.

Tears cover the conjunctiva but follow its folds and bumps: where one tilts enough, the sun glints.
The tile holds the slope along both axes and the mean square slope, so that its mips keep the
roughness that they average away (Olano and Baker 2010, "LEAN mapping", for two equal axes).
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.textures.noise import Field

TILE_MM: Final = 8.0
TILE_PX: Final = 512
SLOPE_RANGE: Final = 0.5  # slopes from -0.5 to 0.5, mean squares to its square
RMS_SLOPE: Final = 0.15  # 8.5 degrees: folds of the bulbar conjunctiva, our estimate

# Waves of tears and tissue: length in mm, share of the slope, 1 where crests are folded sharp.
_WAVES: Final = ((1.6, 0.45, 0.0), (0.55, 0.60, 1.0), (0.22, 0.45, 0.0), (0.09, 0.18, 0.0))


def micro_relief_tile(seed: int = 7) -> npt.NDArray[np.float32]:
    """Return the tile (TILE_PX, TILE_PX, 4), packed to 0..1.

    Channels: slope along u and along v, 0.5 flat; mean square slope over SLOPE_RANGE squared; a
    smooth field of no unit that varies over 2 mm, of deviation 0.2 about 0.5.
    """
    rng = np.random.Generator(np.random.PCG64([seed, 0x7EA5]))
    slope_u = np.zeros((TILE_PX, TILE_PX))
    slope_v = np.zeros_like(slope_u)
    for length_mm, share, is_folded in _WAVES:
        field = _band(rng, length_mm)
        height = 1.0 - np.abs(field) if is_folded else field
        v, u = np.gradient(np.pad(height, 1, mode="wrap"))
        u, v = u[1:-1, 1:-1], v[1:-1, 1:-1]
        scale = share / np.sqrt(np.mean(u * u + v * v))
        slope_u, slope_v = slope_u + scale * u, slope_v + scale * v
    # Some patches lie smooth, others are rough: slopes have longer tails than a normal law.
    patches = np.exp(0.65 * _band(rng, 2.2))
    slope_u, slope_v = slope_u * patches, slope_v * patches
    scale = RMS_SLOPE / np.sqrt(np.mean(slope_u**2 + slope_v**2))
    packed = [0.5 + 0.5 * scale * slope / SLOPE_RANGE for slope in (slope_u, slope_v)]
    square = scale**2 * (slope_u**2 + slope_v**2) / SLOPE_RANGE**2
    smooth = 0.5 + 0.2 * _band(rng, 2.0)
    tile = np.clip(np.stack([*packed, square, smooth], axis=-1), 0.0, 1.0)
    return np.asarray(tile, np.float32)


def _band(rng: np.random.Generator, length_mm: float) -> Field:
    """Return noise of unit deviation whose waves are about ``length_mm`` long; it tiles."""
    spectrum = np.fft.rfft2(rng.standard_normal((TILE_PX, TILE_PX)))
    waves = np.hypot(np.fft.fftfreq(TILE_PX)[:, None], np.fft.rfftfreq(TILE_PX)[None, :])
    octaves = np.log2(np.maximum(waves * TILE_PX, 0.5) * length_mm / TILE_MM)
    field = np.fft.irfft2(spectrum * np.exp(-((octaves / 0.45) ** 2)), s=(TILE_PX, TILE_PX))
    # Rounded: equal bytes wherever the transform's last bits differ.
    return np.asarray(np.round(field / field.std(), 6), np.float32)
