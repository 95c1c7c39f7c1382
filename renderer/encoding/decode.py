"""What a player shows of a clip, and what is left of a picture in the form that a clip has."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.encoding.encode import AS_STORED
from renderer.encoding.ffmpeg import run_ffmpeg

Pixels = npt.NDArray[np.uint8]

# Chroma is interpolated linearly, as a GPU does it.
_AS_SHOWN: Final = "scale=flags=bilinear+accurate_rnd+full_chroma_int"
_RGB: Final = ("-f", "rawvideo", "-pix_fmt", "rgb24")


def decode(path: Path, numbers: Sequence[int], *, size: tuple[int, int]) -> dict[int, Pixels]:
    """Return some frames of a clip or a master by number, as a player shows them.

    Raises ValueError naming the file when it does not hold these frames.
    """
    wanted = sorted(set(numbers))
    picked = "+".join(f"eq(n\\,{number})" for number in wanted)
    raw = run_ffmpeg(
        *("-i", str(path), "-vf", f"select={picked},{_AS_SHOWN}"),
        *("-fps_mode", "passthrough", *_RGB, "-"),
    )
    width, height = size
    frames = np.frombuffer(raw, np.uint8).reshape(-1, height, width, 3)
    if len(frames) != len(wanted):
        raise ValueError(f"{path}: holds {len(frames)} of the {len(wanted)} frames asked for")
    return dict(zip(wanted, frames, strict=True))


def as_stored(picture: Pixels) -> Pixels:
    """Return a picture (height, width, 3) after 8 bits of 4:2:0 alone, without any compression."""
    height, width = picture.shape[:2]
    raw = run_ffmpeg(
        *(*_RGB, "-s", f"{width}x{height}", "-i", "-"),
        *("-vf", f"{AS_STORED},{_AS_SHOWN}", *_RGB, "-"),
        given=np.ascontiguousarray(picture).tobytes(),
    )
    return np.frombuffer(raw, np.uint8).reshape(picture.shape)
