"""Write what was taken from a photograph: the iris's file, its maps as pictures, what was found."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from PIL import Image

from renderer.atomic_file import write_atomically
from renderer.colour import linear_to_srgb
from renderer.iris.file import packed
from renderer.iris.maps import HEIGHT_RANGE_MM, MAP_EDGE_MM
from renderer.textures.sizes import normals_from_height
from renderer.unrefraction.recovery import Recovery

Bytes = npt.NDArray[np.uint8]

IRIS_FILE: Final = "iris.npz"
# What 255 means in thickness.png: border layer, front and back stroma, pigment epithelium.
THICKNESS_SCALE_MM: Final = (0.06, 0.40, 0.50, 0.06)


def write_iris(recovery: Recovery, path: Path) -> str:
    """Write the file that clips are drawn with; return its SHA-256."""
    data = packed(recovery.arrays)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, data)
    return hashlib.sha256(data).hexdigest()


def write_textures(recovery: Recovery, folder: Path) -> list[str]:
    """Write the maps as PNG files, first row on top, for other programs; return their names."""
    texel_mm = 2 * MAP_EDGE_MM / len(recovery.height_mm)
    normal = normals_from_height(recovery.height_mm, texel_mm)
    height = np.rint(np.clip(recovery.height_mm / HEIGHT_RANGE_MM, 0, 1) * 65535)
    pictures: dict[str, npt.NDArray[Any]] = {
        "albedo.png": _bytes(linear_to_srgb(recovery.albedo)),
        "normal.png": _bytes(0.5 + 0.5 * normal),
        "height.png": height.astype(np.uint16),
        "cavity.png": _bytes(recovery.cavity),
        "thickness.png": _bytes(recovery.arrays["thickness"] / np.array(THICKNESS_SCALE_MM)),
        "mask.png": _bytes(recovery.seen.astype(np.float32)),
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, pixels in pictures.items():
        Image.fromarray(np.ascontiguousarray(pixels[::-1])).save(folder / name)
    return list(pictures)


def write_found(recovery: Recovery, path: Path, *, sha256: str) -> None:
    """Write what was found in the photograph, and what the maps' numbers mean, as JSON."""
    notes = {
        "iris_sha256": sha256,
        "maps": {
            "edge_mm": 2 * MAP_EDGE_MM,
            "pupil_radius_mm": 2.0,
            "height_png_65535_mm": HEIGHT_RANGE_MM,
            "thickness_png_255_mm": list(THICKNESS_SCALE_MM),
            "thickness": "a guess from brightness and hue, not a measurement",
            "mask": "white where the photograph showed the iris; the rest is invented",
        },
    }
    text = json.dumps(recovery.found | notes, indent=2) + "\n"
    write_atomically(path, text.encode())


def _bytes(values: npt.NDArray[Any]) -> Bytes:
    return np.asarray(np.rint(np.clip(values, 0.0, 1.0) * 255.0), np.uint8)
