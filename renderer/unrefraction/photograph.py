"""Read a photograph: upright, in linear Rec. 709, with what it says of its own camera."""

from __future__ import annotations

import io
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt
from PIL import ExifTags, Image, UnidentifiedImageError

from renderer.colour import decode_srgb
from renderer.unrefraction.decoding import Encoded, decoded
from renderer.unrefraction.refusal import PhotographError

Picture = npt.NDArray[np.float32]

LARGEST_MPX: Final = 89  # Pillow's own bound against decompression bombs
FULL_FRAME_MM: Final = 36.0  # long side of the frame that "35 mm equivalent" refers to


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
                pixels = decoded(opened, data, notes)
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
