"""Tiles to one picture: rows of tiles, a title above, a caption under each. Pure Pillow."""

from __future__ import annotations

from io import BytesIO
from typing import Final

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from renderer.frame.picture import Pixels
from renderer.gallery.shots import Captioned, fitted

TITLE_PX: Final = 44
CAPTION_PX: Final = 30
GAP_PX: Final = 6
PAPER: Final = (250, 250, 250)
INK: Final = (25, 25, 25)
JPEG_QUALITY: Final = 85


def draw_strip(title: str, tiles: list[Captioned], *, columns: int, tile_px: int) -> Pixels:
    """Return a picture of captioned tiles in rows, each at most ``tile_px`` wide.

    Tiles may differ in size: every cell is as large as the largest tile.
    """
    if not tiles:
        raise ValueError(f'"{title}": a strip needs at least one tile')
    shrunk = [(label, fitted(pixels, tile_px)) for label, pixels in tiles]
    columns = min(columns, len(shrunk))
    rows = -(-len(shrunk) // columns)
    cell_width = max(pixels.shape[1] for _, pixels in shrunk)
    cell_height = max(pixels.shape[0] for _, pixels in shrunk)
    step = (cell_width + GAP_PX, cell_height + CAPTION_PX + GAP_PX)
    size = (columns * step[0] + GAP_PX, rows * step[1] + TITLE_PX + GAP_PX)
    sheet = Image.new("RGB", size, PAPER)
    pen = ImageDraw.Draw(sheet)
    _write(pen, title, (size[0] / 2, TITLE_PX / 2), width=size[0], size_px=26)
    for number, (label, pixels) in enumerate(shrunk):
        x = GAP_PX + number % columns * step[0]
        y = TITLE_PX + number // columns * step[1]
        sheet.paste(
            Image.fromarray(pixels),
            (x + (cell_width - pixels.shape[1]) // 2, y + (cell_height - pixels.shape[0]) // 2),
        )
        middle = (x + cell_width / 2, y + cell_height + CAPTION_PX / 2)
        _write(pen, label, middle, width=cell_width, size_px=20)
    return np.asarray(sheet)


def encode(pixels: Pixels, kind: str) -> bytes:
    """Return a picture as a file's bytes: ``jpg`` small, ``png`` exact."""
    buffer = BytesIO()
    picture = Image.fromarray(pixels)
    if kind == "jpg":
        picture.save(buffer, "JPEG", quality=JPEG_QUALITY, optimize=True, progressive=True)
    else:
        picture.save(buffer, "PNG")
    return buffer.getvalue()


def _write(
    pen: ImageDraw.ImageDraw, text: str, middle: tuple[float, float], *, width: int, size_px: int
) -> None:
    """Write a line around a point, in a smaller type where it would not fit."""
    for size in range(size_px, 8, -1):
        font = ImageFont.load_default(size=size)
        if pen.textlength(text, font=font) <= width:
            break
    pen.text(middle, text, fill=INK, font=font, anchor="mm")
