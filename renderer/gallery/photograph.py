"""The strip of ``ocularist iris``: an iris taken out of a photograph and drawn again.

The photograph is a rendered eye, so that what is taken out can be compared with what went in.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import numpy as np
from PIL import Image

from renderer.camera import LIMBUS_Z_MM, camera_radius_mm
from renderer.colour import linear_to_srgb
from renderer.frame.picture import Pixels
from renderer.gallery.shots import Captioned, Shot, Take, left_only
from renderer.gallery.strips import Strip
from renderer.iris.maps import iris_maps
from renderer.textures.noise import Field
from renderer.unrefraction.photograph import read_photograph
from renderer.unrefraction.recovery import Recovery, recover_iris
from renderer.unrefraction.writing import write_iris

SEED: Final = 5
COLOUR: Final = "hazel"
PUPIL_MM: Final = 3.4
AZIMUTH_DEG: Final = 10.0
ELSEWHERE_DEG: Final = -25.0
SQUARE: Final = (0.1, 0.235, 0.4, 0.768)  # of a macroscopic picture of 16:9
LINES: Final = 2000  # an iris of 470 pixels: enough for fibres


def _tiles(take: Take) -> list[Captioned]:
    own = left_only(pupil_mm=PUPIL_MM, iris_seed=SEED, iris_colour=COLOUR)
    shot = Shot("the photograph: an eye of ours", own, SQUARE, AZIMUTH_DEG, lines=LINES)
    photograph = take(shot)
    with TemporaryDirectory() as folder:
        recovery = _recovered(photograph[1], Path(folder) / "photograph.png")
        path = Path(folder) / "iris.npz"
        sha256 = write_iris(recovery, path)
        pupil_mm = min(max(2.0 * recovery.pose.pupil_mm, 1.5), 8.0)
        taken = left_only(iris_file=str(path), iris_sha256=sha256, pupil_mm=pupil_mm)
        true = iris_maps(SEED, COLOUR, size_px=1024).albedo
        return [
            photograph,
            ("its iris without cornea and light", _shown(recovery.albedo)),
            ("the iris that it was drawn with", _shown(true)),
            take(Shot("drawn with the iris taken out", taken, SQUARE, AZIMUTH_DEG, lines=LINES)),
            take(Shot("the same from elsewhere", taken, SQUARE, ELSEWHERE_DEG, lines=LINES)),
            take(Shot("elsewhere, as it should be", own, SQUARE, ELSEWHERE_DEG, lines=LINES)),
        ]


def _recovered(pixels: Pixels, path: Path) -> Recovery:
    Image.fromarray(pixels).save(path)
    distance_mm = camera_radius_mm("macroscopic") - LIMBUS_Z_MM
    return recover_iris(read_photograph(path), distance_mm=distance_mm)


def _shown(albedo: Field) -> Pixels:
    """Return a map as a picture, first row on top."""
    step = len(albedo) // 512
    return np.asarray(np.rint(255 * linear_to_srgb(albedo[::-step, ::step])), np.uint8)


PHOTOGRAPH: Final = Strip(
    "photograph", "An iris taken out of a photograph", _tiles, columns=3, tile_px=512
)
