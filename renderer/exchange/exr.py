"""OpenEXR files: linear radiance and data, with words about where they come from.

Knows pixels and attributes, not what they show.
"""

from __future__ import annotations

import io
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import OpenEXR

Pixels = npt.NDArray[np.float32]
Attribute = str | int | float

MAGIC: Final = b"\x76\x2f\x31\x01"
# ITU-R BT.709: x and y of red, green, blue and white (D65).
REC_709: Final = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)
HALF_MAX: Final = 65504.0
# Lam 1985 (Bradford): XYZ to the cone responses in which white points are matched.
_BRADFORD: Final = np.array(
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
)


def write_exr(
    path: Path,
    pixels: npt.NDArray[np.floating],
    *,
    channels: str | tuple[str, ...] = "RGB",
    half: bool = False,
    attributes: Mapping[str, Attribute] | None = None,
) -> None:
    """Write (height, width, channels) pixels, first row on top, with ZIP compression.

    ``channels`` names them, such as "RGB", "Z" or ("x_mm", "y_mm"). Colours are linear Rec. 709 and
    the header says so. ``half`` stores 16 bits a value, for which values are cut at 65504. The file
    appears whole or not at all.
    """
    names = list(channels)
    planes = np.asarray(pixels).reshape(*np.shape(pixels)[:2], -1)
    if planes.shape[2] != len(names):
        raise ValueError(f"{path}: {planes.shape[2]} channels of pixels for {len(names)} names")
    if half:
        planes = np.clip(planes, -HALF_MAX, HALF_MAX)
    kind = np.float16 if half else np.float32
    content = {name: np.ascontiguousarray(planes[..., k], kind) for k, name in enumerate(names)}
    header: dict[str, Any] = {
        "compression": OpenEXR.ZIP_COMPRESSION,
        "type": OpenEXR.scanlineimage,
        **(attributes or {}),
    }
    if {"R", "G", "B"} <= set(names):
        header["chromaticities"] = REC_709
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.{os.getpid()}.part.exr")
    try:
        with _silence():
            OpenEXR.File(header, content).write(str(part))
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def read_exr(path: Path) -> Pixels:
    """Read a picture's colours as linear Rec. 709, (height, width, 3) float32, first row on top.

    A picture of luminance alone becomes grey; other primaries are converted, their white adapted.
    Raises OSError for a file that cannot be read, ValueError for one that holds no such picture.
    """
    with path.open("rb") as file:
        if file.read(4) != MAGIC:
            raise ValueError(f"{path}: not an OpenEXR file, whatever its name says")
    try:
        with _silence(), OpenEXR.File(str(path), separate_channels=True) as file:
            planes = {name: channel.pixels for name, channel in file.channels().items()}
            header = dict(file.header())
    except (RuntimeError, ValueError) as error:
        raise ValueError(f"{path}: a damaged OpenEXR file; get it anew") from error
    colours = next((names for names in ("RGB", "rgb", "YYY") if set(names) <= set(planes)), None)
    if colours is None:
        raise ValueError(f"{path}: no colours; it has {', '.join(planes)}, needed are R, G and B")
    pixels = np.stack([planes[name] for name in colours], axis=-1).astype(np.float32)
    given = header.get("chromaticities")
    if given is None or np.allclose(given, REC_709, atol=2e-3):
        return pixels
    return np.asarray(pixels @ _to_rec_709(given).T.astype(np.float32))


def read_attributes(path: Path) -> dict[str, Any]:
    """Return a file's header: attributes by name."""
    with OpenEXR.File(str(path), header_only=True) as file:
        return dict(file.header())


def _to_rec_709(chromaticities: tuple[float, ...]) -> npt.NDArray[np.float64]:
    own, white = _to_xyz(chromaticities)
    ours, our_white = _to_xyz(REC_709)
    cones = np.diag((_BRADFORD @ our_white) / (_BRADFORD @ white))
    adapt = np.linalg.solve(_BRADFORD, cones @ _BRADFORD)
    return np.asarray(np.linalg.solve(ours, adapt @ own))


def _to_xyz(
    chromaticities: tuple[float, ...],
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Return the RGB-to-XYZ matrix of primaries and their white's XYZ (SMPTE RP 177)."""
    xy = np.asarray(chromaticities, dtype=np.float64).reshape(4, 2)
    columns = np.column_stack([xy[:, 0] / xy[:, 1], np.ones(4), (1 - xy.sum(axis=1)) / xy[:, 1]]).T
    white = columns[:, 3]
    return columns[:, :3] * np.linalg.solve(columns[:, :3], white), white


@contextmanager
def _silence() -> Iterator[None]:
    """Keep the library's own prints off the terminal: our errors say it in one line."""
    kept = os.dup(2), os.dup(1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        os.dup2(nowhere, 1)
        with redirect_stdout(io.StringIO()):
            yield
    finally:
        os.dup2(kept[0], 2)
        os.dup2(kept[1], 1)
        for handle in (*kept, nowhere):
            os.close(handle)
