"""The strip of ``ocularist certify``: its own figures, read from the folder it wrote."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image

from renderer.frame.picture import Pixels
from renderer.gallery.shots import Captioned, Take
from renderer.gallery.strips import Strip

FIGURES: Final = "certification.json"


def certificate_strips(folder: Path) -> tuple[Strip, ...]:
    """Return the strip of a certificate's figures, nothing where the folder holds none."""
    if not (folder / FIGURES).is_file():
        return ()
    told = json.loads((folder / FIGURES).read_text(encoding="utf-8"))
    pictures = [folder / f"{picture['case']['name']}.png" for picture in told["pictures"]]

    def tiles(take: Take) -> list[Captioned]:
        del take  # the figures are there: no shot is taken
        return [(path.stem.replace("-", " "), _read(path)) for path in pictures]

    return (Strip("certificate", _title(told["aims"]), tiles, columns=1, tile_px=1300),)


def _title(aims: list[dict[str, object]]) -> str:
    met = sum(bool(aim["is_met"]) for aim in aims)
    first = f"{aims[0]['words']}: {aims[0]['reached_percent']:.1f} %"
    return f"Beside a path tracer: {met} of {len(aims)} aims met; {first}"


def _read(path: Path) -> Pixels:
    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB"))
