"""Put maps on the GPU: sRGB colour, packed normals, half floats. The edge between numpy and GL."""

from __future__ import annotations

from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.colour import linear_to_srgb

Map = npt.NDArray[Any]

SRGB8_ALPHA8: Final = 0x8C43


def with_alpha(colour: Map, alpha: Map | None = None) -> Map:
    """Return three channels (n, n, 3) with a fourth: ``alpha`` (n, n), or ones."""
    fourth = np.ones_like(colour[..., :1]) if alpha is None else alpha[..., None]
    return np.concatenate([colour, fourth], axis=-1)


def srgb_texture(gl: moderngl.Context, colour: Map) -> moderngl.Texture:
    """Upload linear colour (n, n, 4) as sRGB with a linear alpha."""
    encoded = np.concatenate([linear_to_srgb(colour[..., :3]), colour[..., 3:]], axis=-1)
    pixels = np.rint(np.clip(encoded, 0, 1) * 255).astype(np.uint8)
    size = pixels.shape[1::-1]
    return clamped(gl.texture(size, 4, pixels.tobytes(), internal_format=SRGB8_ALPHA8), mips=True)


def packed_texture(gl: moderngl.Context, normal: Map) -> moderngl.Texture:
    """Upload unit normals (n, n, 3) packed to 0..1."""
    pixels = np.rint(with_alpha(0.5 + 0.5 * normal) * 255).astype(np.uint8)
    return clamped(gl.texture(pixels.shape[1::-1], 4, pixels.tobytes()), mips=True)


def grey_texture(gl: moderngl.Context, grey: Map, *, mips: bool = True) -> moderngl.Texture:
    """Upload one channel (n, n) from 0 to 1 in 8 bits."""
    pixels = np.rint(np.clip(grey, 0, 1) * 255).astype(np.uint8)
    texture = gl.texture(pixels.shape[::-1], 1, pixels.tobytes(), alignment=1)
    return clamped(texture, mips=mips)


def float_texture(gl: moderngl.Context, values: Map) -> moderngl.Texture:
    """Upload (n, n, 4) as half floats."""
    data = np.ascontiguousarray(values, dtype=np.float16).tobytes()
    return clamped(gl.texture(values.shape[1::-1], 4, data, dtype="f2"), mips=True)


def tiling_texture(gl: moderngl.Context, tile: Map) -> moderngl.Texture:
    """Upload a tile (n, n, 4) from 0 to 1 in 8 bits that repeats without a seam.

    One mip is read at a time: its neighbours differ too little to pay for both.
    """
    pixels = np.rint(np.clip(tile, 0, 1) * 255).astype(np.uint8)
    texture = clamped(gl.texture(tile.shape[1::-1], 4, pixels.tobytes()), mips=True)
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = True
    return texture


def clamped(texture: moderngl.Texture, *, mips: bool = False) -> moderngl.Texture:
    """Filter a texture bilinearly and hold its edges; ``mips`` are read by explicit level."""
    texture.repeat_x = texture.repeat_y = False
    if mips:
        texture.build_mipmaps()
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    else:
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    return texture
