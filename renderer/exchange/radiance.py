"""Radiance pictures (.hdr): Ward's RGBE, read as linear radiance. Pure numpy.

Ward 1991, "Real pixels"; the file's layout as Radiance's own manual describes it.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

Bytes = npt.NDArray[np.uint8]

_FORMAT: Final = "32-bit_rle_rgbe"
_RESOLUTION: Final = re.compile(rb"-Y (\d{1,6}) \+X (\d{1,6})\n")


def read_radiance(path: Path) -> npt.NDArray[np.float32]:
    """Read a picture as (height, width, 3) float32, first row on top.

    Raises OSError for a file that cannot be read, ValueError for one that is not such a picture.
    """
    data = path.read_bytes()
    if not data.startswith(b"#?"):
        raise ValueError(f"{path}: not a Radiance file, whatever its name says")
    head, end, body = data.partition(b"\n\n")
    lines = head.decode("latin-1").splitlines()
    values = [line.partition("=")[::2] for line in lines if "=" in line]
    kind = dict(values).get("FORMAT", _FORMAT)
    size = _RESOLUTION.match(body)
    if not end or kind != _FORMAT or not size:
        raise ValueError(
            f"{path}: a Radiance file of another kind; needed are FORMAT={_FORMAT} and rows from "
            "the top (-Y height +X width)"
        )
    height, width = int(size[1]), int(size[2])
    if not height or not width:
        raise ValueError(f"{path}: a picture without pixels")
    try:
        rgbe = _rows(np.frombuffer(body, np.uint8, offset=size.end()), height, width)
    except (IndexError, ValueError) as error:
        raise ValueError(f"{path}: a damaged Radiance file; get it anew") from error
    exposure = np.prod([float(value) for name, value in values if name == "EXPOSURE"] or [1.0])
    scale = np.where(rgbe[..., 3:] > 0, np.ldexp(1.0, rgbe[..., 3:].astype(int) - 136), 0.0)
    # Half a step more, as Radiance's colr_color adds: the encoder cuts off.
    shift = 0.5 * (rgbe[..., 3:] > 0)
    return np.asarray((rgbe[..., :3] + shift) * scale / exposure, dtype=np.float32)


def _rows(data: Bytes, height: int, width: int) -> Bytes:
    """Return (height, width, 4) bytes of red, green, blue and exponent."""
    rgbe = np.zeros((height, width, 4), np.uint8)
    at = 0
    for row in rgbe:
        start = data[at : at + 4]
        if start[0] == 2 and start[1] == 2 and int(start[2]) * 256 + int(start[3]) == width:
            at = _packed_row(data, at + 4, row)
        else:
            at = _plain_row(data, at, row)
    return rgbe


def _packed_row(data: Bytes, at: int, row: Bytes) -> int:
    """Fill a row from runs, one component after the other; return where the next row starts."""
    width = len(row)
    for component in range(4):
        x = 0
        while x < width:
            count = int(data[at])
            if count > 128:
                count -= 128
                row[x : x + count, component] = data[at + 1]
                at += 2
            else:
                if count == 0:
                    raise ValueError("a run of no pixels")
                row[x : x + count, component] = data[at + 1 : at + 1 + count]
                at += 1 + count
            x += count
        if x != width:
            raise ValueError("a run beyond its row")
    return at


def _plain_row(data: Bytes, at: int, row: Bytes) -> int:
    """Fill a row from whole pixels; 1 1 1 n repeats the last one, counts in bytes from low."""
    x, shift = 0, 0
    while x < len(row):
        pixel = data[at : at + 4]
        at += 4
        if tuple(pixel[:3]) == (1, 1, 1) and x > 0:
            count = int(pixel[3]) << shift
            row[x : x + count] = row[x - 1]
            x, shift = x + count, shift + 8
        else:
            row[x] = pixel
            x, shift = x + 1, 0
    return at
