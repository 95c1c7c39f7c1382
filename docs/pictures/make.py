"""Draw the pictures of README.md anew: python docs/pictures/make.py

lods.jpg: the viewer's left eye at the four LoDs, macroscopic, seen from 12 degrees to the right.
distances.jpg: ultra beside low at the four distances.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from renderer.clip import DISTANCES, ClipSpec
from renderer.detail import STANDARD_LODS, Detail
from renderer.studio import Studio

HERE = Path(__file__).parent
AZIMUTH_DEG = 12.0
CAPTION_PX = 40


def main() -> None:
    """Render, label and write both pictures."""
    studio = Studio()
    eyes = []
    for lod in STANDARD_LODS:
        detail = Detail.uniform(lod)
        spec = ClipSpec(left=detail, right=detail, width=1280, height=720)
        pixels = studio.renderer(spec).render(AZIMUTH_DEG, time_s=2.0).pixels
        eyes.append((lod, pixels[130:560, 20:620]))
    write(eyes, columns=2, name="lods.jpg")
    views = []
    for distance in DISTANCES:
        spec = ClipSpec(
            left=Detail.uniform("ultra"), right=Detail.uniform("low"), distance=distance
        )
        pixels = studio.renderer(spec).render(AZIMUTH_DEG, time_s=2.0).pixels
        half = Image.fromarray(pixels).resize((800, 450), Image.Resampling.LANCZOS)
        views.append((f"{distance}: ultra (left), low (right)", np.asarray(half)))
    write(views, columns=2, name="distances.jpg")
    studio.close()


def write(tiles: list[tuple[str, np.ndarray]], *, columns: int, name: str) -> None:
    """Write captioned tiles of equal size as one picture."""
    height, width = tiles[0][1].shape[:2]
    rows = -(-len(tiles) // columns)
    sheet = Image.new("RGB", (columns * width, rows * (height + CAPTION_PX)), "white")
    font = ImageFont.load_default(size=22)
    for number, (caption, pixels) in enumerate(tiles):
        x, y = number % columns * width, number // columns * (height + CAPTION_PX)
        sheet.paste(Image.fromarray(pixels), (x, y))
        place = (x + width / 2, y + height + CAPTION_PX / 2)
        ImageDraw.Draw(sheet).text(place, caption, fill="black", font=font, anchor="mm")
    sheet.save(HERE / name, quality=88, optimize=True)


if __name__ == "__main__":
    main()
