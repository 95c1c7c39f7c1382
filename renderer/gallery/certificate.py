"""The strip of ``ocularist certify``: its own figures, read from the folder it wrote."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from renderer.gallery.shots import Captioned, Take
from renderer.gallery.strips import Strip
from renderer.picture import Pixels


def certificate_strips(folder: Path) -> tuple[Strip, ...]:
    """Return the strip of a certificate's figures, nothing where the folder holds none."""
    figures = sorted(folder.glob("*.png"))
    if not figures:
        return ()

    def tiles(take: Take) -> list[Captioned]:
        del take  # the figures are there: no shot is taken
        return [(_caption(path), _read(path)) for path in figures]

    title = "Against a path tracer: ocularist certify"
    return (Strip("certificate", title, tiles, columns=2, tile_px=900),)


def _caption(path: Path) -> str:
    return path.stem.replace("-", " ").replace("_", " ")


def _read(path: Path) -> Pixels:
    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB"))
