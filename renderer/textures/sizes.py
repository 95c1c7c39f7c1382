"""Common work on square maps: smaller sizes, normals from heights, compact storage.

Row 0 of every map is its lower edge (v = 0), as OpenGL wants it; linear values throughout.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

Field = npt.NDArray[np.float32]
_STEPS: Final = 65535.0


def smoothstep(low: float, high: float, x: Field) -> Field:
    """Return the cubic step from 0 at ``low`` to 1 at ``high`` (which may be the smaller)."""
    t = np.clip((x - np.float32(low)) / np.float32(high - low), 0.0, 1.0)
    step: Field = t * t * (np.float32(3.0) - np.float32(2.0) * t)
    return step


def check_size(size_px: int, largest_px: int) -> None:
    """Raise ValueError unless ``size_px`` is a power of two from 1 to ``largest_px``."""
    if size_px < 1 or size_px > largest_px or size_px & (size_px - 1):
        raise ValueError(
            f"size_px: {size_px} is no map size; choose a power of two from 1 to {largest_px}"
        )


def shrink(field: Field, size_px: int) -> Field:
    """Return a smaller map (size_px, size_px, ...) whose texels are means: a box filter."""
    factor = field.shape[0] // size_px
    if factor == 1:
        return field
    tail = field.shape[2:]
    blocks = field.reshape(size_px, factor, size_px, factor, *tail)
    return np.asarray(blocks.mean(axis=(1, 3), dtype=np.float32))


def normals_from_height(height_mm: Field, texel_mm: float) -> Field:
    """Return unit tangent-space normals (n, n, 3), x to the right, y up, z out of the surface."""
    d_row, d_column = np.gradient(height_mm, np.float32(texel_mm))
    length = np.sqrt(d_row * d_row + d_column * d_column + np.float32(1.0))
    return np.stack([-d_column / length, -d_row / length, 1.0 / length], axis=-1).astype(np.float32)


def pack_albedo(albedo: Field) -> npt.NDArray[np.uint16]:
    """Store values in [0, 1] as 16 bits of their square root: fine steps in the dark."""
    root = np.sqrt(np.clip(albedo, 0.0, 1.0))
    return np.asarray(np.rint(root * np.float32(_STEPS)), np.uint16)


def unpack_albedo(packed: npt.NDArray[np.generic]) -> Field:
    """Return what ``pack_albedo`` stored, as float32."""
    root = packed.astype(np.float32) * np.float32(1.0 / _STEPS)
    return root * root


def pack_range(field: Field, largest: float) -> npt.NDArray[np.uint16]:
    """Store values in [0, largest] in even 16-bit steps."""
    share = np.clip(field / np.float32(largest), 0.0, 1.0)
    return np.asarray(np.rint(share * np.float32(_STEPS)), np.uint16)


def unpack_range(packed: npt.NDArray[np.generic], largest: float) -> Field:
    """Return what ``pack_range`` stored, as float32."""
    return packed.astype(np.float32) * np.float32(largest / _STEPS)
