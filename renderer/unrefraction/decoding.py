"""Decode a picture file to pixels: upright, as deep as it was written, its colours in sRGB.

Any format that Pillow opens; 16 bits per channel through FFmpeg where Pillow keeps 8. An embedded
colour profile is applied by Pillow's colour management; without one the picture is taken as sRGB.
"""

from __future__ import annotations

import io
import subprocess
from typing import Final

import numpy as np
import numpy.typing as npt
from PIL import ExifTags, Image, ImageCms, ImageOps
from PIL.TiffImagePlugin import TiffImageFile
from scipy import ndimage

Encoded = npt.NDArray[np.uint8] | npt.NDArray[np.uint16]

LUT: Final = 33  # grid of a colour profile's table


def decoded(opened: Image.Image, data: bytes, notes: list[str]) -> Encoded:
    """Return the pixels (height, width, 3) of a file's ``data``; ``notes`` takes what was lost."""
    upright = ImageOps.exif_transpose(opened)
    profile = opened.info.get("icc_profile")
    is_deep = opened.mode.startswith("I;16") or _bits(data) == 16
    deep = _deep(data, opened) if is_deep else None
    if deep is None:
        pixels: Encoded = _flat(upright)
        if is_deep:
            notes.append("its 16 bits per channel were read as 8")
    else:
        pixels = _turned_like(deep, ImageOps.exif_transpose(_index_turner(opened)))
    if profile and not opened.mode.startswith(("L", "I", "1")):
        return _managed(pixels, profile, notes)
    return pixels


def _flat(upright: Image.Image) -> npt.NDArray[np.uint8]:
    """Return 8 bits per channel, over white where the picture is transparent."""
    if upright.mode in {"RGBA", "LA", "PA"} or "transparency" in upright.info:
        rgba = upright.convert("RGBA")
        ground = Image.new("RGBA", rgba.size, (255, 255, 255, 255))
        upright = Image.alpha_composite(ground, rgba)
    return np.asarray(upright.convert("RGB"))


def _bits(data: bytes) -> int:
    """Return the bits per channel of a PNG or TIFF, 8 for everything else."""
    if data.startswith(b"\x89PNG\r\n\x1a\n"):
        return data[24]
    with Image.open(io.BytesIO(data)) as opened:
        if isinstance(opened, TiffImageFile):
            bits = opened.tag_v2.get(258, (8,))
            return int(max(bits) if isinstance(bits, tuple) else bits)
    return 8


def _deep(data: bytes, opened: Image.Image) -> npt.NDArray[np.uint16] | None:
    """Decode 16 bits per channel with FFmpeg (Pillow keeps 8 of colour); None where it cannot."""
    import imageio_ffmpeg

    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-noautorotate"]
    command += ["-f", "png_pipe" if opened.format == "PNG" else "tiff_pipe", "-i", "-"]
    command += ["-frames:v", "1", "-f", "rawvideo", "-pix_fmt", "rgb48le", "-"]
    done = subprocess.run(command, input=data, capture_output=True, check=False)
    expected = opened.width * opened.height * 6
    if len(done.stdout) != expected:
        return None
    return np.frombuffer(done.stdout, "<u2").reshape(opened.height, opened.width, 3)


def _index_turner(opened: Image.Image) -> Image.Image:
    """Return a 2 x 3 picture with the original's orientation, to see how its rows turn."""
    small = Image.fromarray(np.arange(6, dtype=np.uint8).reshape(2, 3))
    exif = Image.Exif()
    exif[ExifTags.Base.Orientation] = opened.getexif().get(ExifTags.Base.Orientation, 1)
    buffer = io.BytesIO()
    small.save(buffer, "PNG", exif=exif)
    return Image.open(buffer)


def _turned_like(pixels: npt.NDArray[np.uint16], turned: Image.Image) -> npt.NDArray[np.uint16]:
    """Turn and mirror pixels as the little picture was."""
    wanted = np.asarray(turned).tolist()
    plain = np.arange(6, dtype=np.uint8).reshape(2, 3)
    for flip in (False, True):
        for turns in range(4):
            trial = np.rot90(plain[:, ::-1] if flip else plain, turns)
            if trial.tolist() == wanted:
                return np.ascontiguousarray(np.rot90(pixels[:, ::-1] if flip else pixels, turns))
    return pixels


def _managed(pixels: Encoded, profile: bytes, notes: list[str]) -> Encoded:
    """Convert from an embedded profile to sRGB."""
    try:
        source = ImageCms.ImageCmsProfile(io.BytesIO(profile))
        transform = ImageCms.buildTransform(
            source,
            ImageCms.createProfile("sRGB"),
            "RGB",
            "RGB",
            renderingIntent=ImageCms.Intent.RELATIVE_COLORIMETRIC,
        )
    except (ImageCms.PyCMSError, OSError):
        notes.append("its colour profile cannot be applied: taken as sRGB")
        return pixels
    if pixels.dtype == np.uint8:
        changed = ImageCms.applyTransform(Image.fromarray(pixels), transform)
        return np.asarray(changed)
    return _through_table(pixels, transform)


def _through_table(pixels: Encoded, transform: ImageCms.ImageCmsTransform) -> Encoded:
    """Convert 16 bits per channel, which Pillow's transforms do not take."""
    grid = np.rint(np.linspace(0, 255, LUT)).astype(np.uint8)
    table = np.stack(np.meshgrid(grid, grid, grid, indexing="ij"), axis=-1).reshape(LUT, -1, 3)
    filled = ImageCms.applyTransform(Image.fromarray(table), transform)
    cube = np.asarray(filled).reshape(LUT, LUT, LUT, 3).astype(np.float32) * 257.0
    top = np.float32((LUT - 1) / 65535.0)
    changed16 = np.empty_like(pixels)
    for row in range(0, pixels.shape[0], 256):  # in strips, so that memory stays bounded
        at = np.moveaxis(pixels[row : row + 256].astype(np.float32) * top, -1, 0)
        for channel in range(3):
            part = ndimage.map_coordinates(cube[..., channel], at, order=1, mode="nearest")
            changed16[row : row + 256, :, channel] = np.rint(part)
    return changed16
