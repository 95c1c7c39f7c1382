"""Read a photograph: upright, in linear Rec. 709, with what it says of its own camera.

Any format that Pillow opens; 16 bits per channel through FFmpeg where Pillow keeps 8. An embedded
colour profile is applied by Pillow's colour management; without one the picture is taken as sRGB.
"""

from __future__ import annotations

import io
import subprocess
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt
from PIL import ExifTags, Image, ImageCms, ImageOps, UnidentifiedImageError
from PIL.TiffImagePlugin import TiffImageFile
from scipy import ndimage

from renderer.unrefraction.refusal import PhotographError

Picture = npt.NDArray[np.float32]
Encoded = npt.NDArray[np.uint8] | npt.NDArray[np.uint16]

LARGEST_MPX: Final = 89  # Pillow's own bound against decompression bombs
FULL_FRAME_MM: Final = 36.0  # long side of the frame that "35 mm equivalent" refers to
LUT: Final = 33  # grid of a colour profile's table


@dataclass(frozen=True)
class Photograph:
    """A photograph: ``pixels`` (height, width, 3) as encoded, and the camera's own words.

    ``focal_px`` is the focal length in pixels, None where the file does not say.
    """

    name: str
    pixels: Encoded
    focal_px: float | None
    is_monochrome: bool
    notes: list[str] = field(default_factory=list)

    def encoded(self) -> Picture:
        """Return the sRGB-encoded picture from 0 to 1."""
        return self.pixels.astype(np.float32) * np.float32(1.0 / np.iinfo(self.pixels.dtype).max)

    def linear(self, box: tuple[int, int, int, int] | None = None) -> Picture:
        """Return the picture, or its box (left, top, right, bottom), in linear Rec. 709."""
        left, top, right, bottom = box or (0, 0, self.pixels.shape[1], self.pixels.shape[0])
        part = self.pixels[top:bottom, left:right]
        values = np.arange(np.iinfo(part.dtype).max + 1) / np.iinfo(part.dtype).max
        return decode_srgb(values)[part]


def decode_srgb(encoded: npt.NDArray[np.float64]) -> Picture:
    """Return linear light for sRGB values (IEC 61966-2-1)."""
    curve = ((encoded + 0.055) / 1.055) ** 2.4
    return np.where(encoded <= 0.04045, encoded / 12.92, curve).astype(np.float32)


def read_photograph(path: Path, *, focal_mm: float | None = None) -> Photograph:
    """Read a photograph; ``focal_mm``, 35 mm equivalent, stands in for what the file says.

    Raises PhotographError for what is no picture, is cut off or too large, OSError where the file
    cannot be read at all.
    """
    data = path.read_bytes()
    notes: list[str] = []
    try:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            with Image.open(io.BytesIO(data)) as opened:
                if opened.width * opened.height > LARGEST_MPX * 1e6:
                    raise PhotographError(
                        f"{path}: has {opened.width} x {opened.height} pixels; at most "
                        f"{LARGEST_MPX} megapixels are accepted: crop it to the eye"
                    )
                opened.load()
                focal_px = _focal_px(opened, focal_mm)
                pixels = _decoded(opened, data, notes)
        notes += sorted({f"Pillow warns: {one.message}" for one in said})
    except UnidentifiedImageError:
        raise PhotographError(
            f"{path}: is no picture that Pillow can open; JPEG, PNG, TIFF and WebP are accepted"
        ) from None
    except Image.DecompressionBombError:
        raise PhotographError(
            f"{path}: has more pixels than the {LARGEST_MPX} million that are accepted: "
            "crop it to the eye"
        ) from None
    except (OSError, SyntaxError, ValueError) as error:
        if isinstance(error, PhotographError):
            raise
        raise PhotographError(
            f"{path}: is damaged or cut off ({error}); copy the photograph again"
        ) from None
    spread = pixels[::7, ::7].astype(np.int32)
    is_monochrome = bool(
        np.percentile(np.ptp(spread, axis=-1), 99) <= np.iinfo(pixels.dtype).max / 50
    )
    if is_monochrome:
        notes.append("black-and-white or infra-red: the iris will have no colour")
    return Photograph(path.name, pixels, focal_px, is_monochrome, notes)


def _focal_px(opened: Image.Image, focal_mm: float | None) -> float | None:
    """Return the focal length in pixels of the long side; a cropped file tells it wrongly."""
    if focal_mm is None:
        tags = opened.getexif().get_ifd(ExifTags.IFD.Exif)
        told = tags.get(ExifTags.Base.FocalLengthIn35mmFilm)
        focal_mm = float(told) if told else None
    return focal_mm / FULL_FRAME_MM * max(opened.size) if focal_mm else None


def _decoded(opened: Image.Image, data: bytes, notes: list[str]) -> Encoded:
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
    """Convert from an embedded profile to sRGB, through a table that the profile fills."""
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
