"""Frames to H.264: one stream that every browser plays, with its colours tagged.

BT.709 matrix and primaries, sRGB transfer, limited range: the tags that browsers agree on. No
audio track, no metadata: nothing in the file tells its condition.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import imageio.v2 as imageio
import imageio_ffmpeg
import numpy as np
import numpy.typing as npt

Pixels = npt.NDArray[np.uint8]

QUALITY: Final = 14  # x264's constant rate factor: visually lossless at these sizes
PRESET: Final = "veryfast"  # the two cores also render
THREADS: Final = 2  # fixed: x264's bytes depend on the number of threads

# The conversion to YCbCr is named as well as tagged: FFmpeg's default is BT.601, which browsers
# guess to be BT.709 above 576 lines.
_COLOUR: Final = (
    "scale=in_range=full:out_color_matrix=bt709:out_range=tv,format=yuv420p,"
    "setparams=color_primaries=bt709:color_trc=iec61966-2-1:colorspace=bt709:range=tv"
)
_OUTPUT: Final = [
    *("-vf", _COLOUR, "-preset", PRESET, "-crf", str(QUALITY), "-threads", str(THREADS)),
    *("-colorspace", "bt709", "-color_primaries", "bt709"),
    *("-color_trc", "iec61966-2-1", "-color_range", "tv"),
    *("-g", "30", "-movflags", "+faststart", "-map_metadata", "-1"),
    *("-fflags", "+bitexact", "-flags:v", "+bitexact", "-an"),
    *("-bsf:v", "filter_units=remove_types=6"),  # x264's note of its own options
]


@contextmanager
def open_encoder(path: Path, *, fps: int) -> Iterator[Any]:
    """Open a writer; its ``append_data`` takes (height, width, 3) uint8 sRGB frames."""
    writer = imageio.get_writer(
        path,
        format="FFMPEG",
        mode="I",
        fps=fps,
        codec="libx264",
        pixelformat="yuv420p",
        macro_block_size=1,  # the default of 16 turns 1080 lines into 1088
        ffmpeg_log_level="error",
        output_params=_OUTPUT,
    )
    try:
        yield writer
    finally:
        writer.close()


def decode(path: Path, numbers: Sequence[int], *, size: tuple[int, int]) -> dict[int, Pixels]:
    """Return some frames of a clip by number, as a player shows them.

    Raises ValueError naming the file when it does not hold these frames.
    """
    wanted = sorted(set(numbers))
    picked = "+".join(f"eq(n\\,{number})" for number in wanted)
    raw = _run_ffmpeg(
        *("-i", str(path), "-vf", f"select={picked},scale=in_color_matrix=bt709:in_range=tv"),
        *("-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"),
    )
    width, height = size
    frames = np.frombuffer(raw, np.uint8).reshape(-1, height, width, 3)
    if len(frames) != len(wanted):
        raise ValueError(f"{path}: holds {len(frames)} of the {len(wanted)} frames asked for")
    return dict(zip(wanted, frames, strict=True))


def _run_ffmpeg(*arguments: str) -> bytes:
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", *arguments]
    return subprocess.run(command, check=True, capture_output=True, stdin=subprocess.DEVNULL).stdout
