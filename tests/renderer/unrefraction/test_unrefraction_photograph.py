"""Reading photographs: orientation, depth, colour profiles, the camera's words, and refusals."""

from __future__ import annotations

import io
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import ExifTags, Image, ImageCms

from renderer.colour import decode_srgb
from renderer.unrefraction.photograph import read_photograph
from renderer.unrefraction.refusal import PhotographError


def picture(height: int = 40, width: int = 60) -> np.ndarray:
    """Smooth colours that differ at every corner."""
    y, x = np.mgrid[0 : 1 : height * 1j, 0 : 1 : width * 1j]
    return np.rint(np.stack([x, y, 0.5 * (1 - x)], axis=-1) * 255).astype(np.uint8)


def png16(pixels: np.ndarray) -> bytes:
    """Return a PNG of 16 bits per channel: Pillow writes none in colour."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        check = struct.pack(">I", zlib.crc32(kind + data))
        return struct.pack(">I", len(data)) + kind + data + check

    height, width = pixels.shape[:2]
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in pixels)
    header = struct.pack(">IIBBBBB", width, height, 16, 2, 0, 0, 0)
    body = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + body


def test_a_turned_photograph_stands_upright_and_tells_its_focal_length(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[ExifTags.Base.Orientation] = 6  # turn clockwise to see it
    exif.get_ifd(ExifTags.IFD.Exif)[ExifTags.Base.FocalLengthIn35mmFilm] = 90
    Image.fromarray(picture()).save(tmp_path / "a.png", exif=exif)
    read = read_photograph(tmp_path / "a.png")
    np.testing.assert_array_equal(read.pixels, np.rot90(picture(), -1))
    assert read.focal_px == pytest.approx(90 / 36 * 60)
    told = read_photograph(tmp_path / "a.png", focal_mm=180.0)
    assert told.focal_px == pytest.approx(180 / 36 * 60)


def test_sixteen_bits_are_kept(tmp_path: Path) -> None:
    deep = picture().astype(np.uint16) * 257 + np.arange(60, dtype=np.uint16)[None, :, None]
    (tmp_path / "a.png").write_bytes(png16(deep))
    read = read_photograph(tmp_path / "a.png")
    np.testing.assert_array_equal(read.pixels, deep)
    linear = read.linear((10, 5, 20, 15))
    np.testing.assert_allclose(linear, decode_srgb(deep[5:15, 10:20] / 65535.0), atol=1e-6)


def test_an_embedded_profile_is_applied(tmp_path: Path) -> None:
    plain = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    Image.fromarray(picture()).save(tmp_path / "a.png", icc_profile=plain)
    same = read_photograph(tmp_path / "a.png")
    assert np.abs(same.pixels.astype(int) - picture()).max() <= 2
    Image.fromarray(picture()).save(tmp_path / "b.png", icc_profile=b"nonsense")
    broken = read_photograph(tmp_path / "b.png")
    np.testing.assert_array_equal(broken.pixels, picture())
    assert broken.notes == ["its colour profile cannot be applied: taken as sRGB"]


def test_transparent_grey_and_palette_pictures_are_read(tmp_path: Path) -> None:
    grey = Image.fromarray(picture()).convert("L")
    grey.save(tmp_path / "grey.jpg", quality=95)
    read = read_photograph(tmp_path / "grey.jpg")
    assert read.is_monochrome
    assert read.notes == ["black-and-white or infra-red: the iris will have no colour"]
    clear = Image.fromarray(picture()).convert("RGBA")
    clear.putalpha(0)
    clear.save(tmp_path / "clear.png")
    assert (read_photograph(tmp_path / "clear.png").pixels == 255).all()
    Image.fromarray(picture()).convert("P").save(tmp_path / "p.png")
    assert read_photograph(tmp_path / "p.png").pixels.shape == (40, 60, 3)


def test_what_pillow_warns_of_is_passed_on(tmp_path: Path) -> None:
    cut_off = b"Exif\0\0MM\0*\0\0\0\x08\0\x05"  # promises five entries and has none
    Image.fromarray(picture()).save(tmp_path / "a.jpg", exif=cut_off)
    notes = read_photograph(tmp_path / "a.jpg").notes
    assert len(notes) == 1
    assert notes[0].startswith("Pillow warns: Corrupt EXIF data")


def test_what_is_no_photograph_is_refused_in_words(tmp_path: Path) -> None:
    buffer = io.BytesIO()
    Image.fromarray(picture(400, 600)).save(buffer, "JPEG")
    whole = buffer.getvalue()
    for name, data, words in (
        ("cut.jpg", whole[: len(whole) // 2], r"cut\.jpg: is damaged or cut off"),
        ("text.jpg", b"hello", r"text\.jpg: is no picture .*; JPEG, PNG, TIFF and WebP"),
        ("none.jpg", b"", r"none\.jpg: is no picture"),
        ("bomb.png", _bomb(), r"bomb\.png: has .* 89 m.* are accepted: crop it to the eye"),
    ):
        (tmp_path / name).write_bytes(data)
        with pytest.raises(PhotographError, match=words):
            read_photograph(tmp_path / name)
    with pytest.raises(FileNotFoundError):
        read_photograph(tmp_path / "absent.jpg")


def _bomb() -> bytes:
    """A header that promises 900 million pixels."""
    small = png16(np.zeros((1, 1, 3), np.uint16))
    header = struct.pack(">IIBBBBB", 30000, 30000, 8, 2, 0, 0, 0)
    checked = b"IHDR" + header
    return small[:12] + checked + struct.pack(">I", zlib.crc32(checked)) + small[33:]
