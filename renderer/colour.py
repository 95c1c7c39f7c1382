"""Colours as numbers: sRGB's curve both ways, luminance. Pure numpy; linear is Rec. 709."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float32]


def decode_srgb(encoded: npt.NDArray[np.float64]) -> Array:
    """Decode sRGB values from 0 to 1 to linear ones (IEC 61966-2-1)."""
    curve = ((encoded + 0.055) / 1.055) ** 2.4
    return np.where(encoded <= 0.04045, encoded / 12.92, curve).astype(np.float32)


def srgb_to_linear(values: npt.ArrayLike) -> Array:
    """Decode sRGB values from 0 to 255 to linear 0 to 1 (IEC 61966-2-1)."""
    return decode_srgb(np.asarray(values, np.float64) / 255.0)


def linear_to_srgb(values: npt.ArrayLike) -> Array:
    """Encode linear 0 to 1 as sRGB 0 to 1 (IEC 61966-2-1), clipped."""
    v = np.clip(np.asarray(values, np.float32), 0.0, 1.0)
    return np.where(v <= 0.0031308, v * 12.92, 1.055 * v ** (1 / 2.4) - 0.055).astype(np.float32)


def luminance(rgb: Array) -> Array:
    """Return Rec. 709 luminance of linear colours (..., 3)."""
    y: Array = (
        np.float32(0.2126) * rgb[..., 0]
        + np.float32(0.7152) * rgb[..., 1]
        + np.float32(0.0722) * rgb[..., 2]
    )
    return y
