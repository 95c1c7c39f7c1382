"""The maps of an eye as picture files, read back from the GPU: what is exported is what is drawn.

Colours become PNG in sRGB, data linear PNG or EXR. The first row is the top one: the maps' v points
up, so v = 0 is a picture's last row.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt
from PIL import Image

from renderer.exchange.exr import write_exr

Pixels = npt.NDArray[Any]


@dataclass(frozen=True)
class MapKind:
    """A map by its uniform's name: its file's name, what each channel is, what it lies on."""

    name: str
    channels: tuple[str, ...]
    encoding: str  # of a PNG: "sRGB" or "linear"; EXR is always linear
    on: str
    meaning: str


KINDS: Final = {
    "u_iris_albedo": MapKind(
        "iris_albedo", ("R", "G", "B"), "sRGB", "iris plane", "diffuse reflectance, Rec. 709"
    ),
    "u_iris_normal": MapKind(
        "iris_normal", ("x", "y", "z"), "linear", "iris plane", "unit normal, 0..1 for -1..1, y up"
    ),
    "u_thickness": MapKind(
        "iris_thickness",
        ("border_layer_mm", "front_stroma_mm", "back_stroma_mm", "pigment_epithelium_mm"),
        "linear",
        "iris plane",
        "thickness of the iris's four layers from the front, in mm",
    ),
    "u_caustic_map": MapKind(
        "caustic",
        ("direction_x", "direction_y", "irradiance"),
        "linear",
        "iris plane of this pupil, unmirrored",
        "sunlight on the iris: x and y of the unit direction it travels in eye space, and its "
        "irradiance relative to a surface that faces the sun",
    ),
    "u_chamber_map": MapKind(
        "chamber",
        ("R", "G", "B"),
        "linear",
        "iris plane of this pupil, unmirrored",
        "irradiance of the surroundings without the sun on the iris",
    ),
    "u_sclera_albedo": MapKind(
        "sclera_albedo", ("R", "G", "B"), "sRGB", "sclera's map", "diffuse reflectance, Rec. 709"
    ),
    "u_sclera_normal": MapKind(
        "sclera_normal",
        ("x", "y", "z"),
        "linear",
        "sclera's map",
        "unit normal, 0..1 for -1..1, x along u, y along v",
    ),
}


def write_maps(
    folder: Path, values: Mapping[str, Any], *, suffix: str, root: Path
) -> Iterator[dict[str, Any]]:
    """Write an eye's maps into a folder; yield what the index says of each.

    ``values`` are the eye's uniforms, ``suffix`` ends the names ("left"), the index's paths are
    relative to ``root``.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for uniform, kind in KINDS.items():
        texture = values.get(uniform)
        if not isinstance(texture, moderngl.Texture):
            continue
        pixels = read_texture(texture)[..., : len(kind.channels)]
        is_byte = pixels.dtype == np.uint8
        path = folder / f"{kind.name}_{suffix}.{'png' if is_byte else 'exr'}"
        if is_byte:
            Image.fromarray(np.ascontiguousarray(pixels[::-1])).save(path)
        else:
            write_exr(path, pixels[::-1], channels=kind.channels)
        yield {
            "file": path.relative_to(root).as_posix(),
            "size_px": list(texture.size),
            "channels": list(kind.channels),
            "encoding": kind.encoding if is_byte else "linear",
            "on": kind.on,
            "meaning": kind.meaning,
        }


def read_texture(texture: moderngl.Texture) -> Pixels:
    """Read a texture as (height, width, channels), row 0 first: uint8 or float32."""
    width, height = texture.size
    kind = {"f1": np.uint8, "f2": np.float16, "f4": np.float32}[texture.dtype]
    data = np.frombuffer(texture.read(alignment=1), kind)
    pixels = data.reshape(height, width, texture.components)
    return pixels if kind is np.uint8 else pixels.astype(np.float32)
