"""Frames to H.264: one stream that every browser plays, with its colours tagged.

BT.709 matrix and primaries, sRGB transfer, limited range: the tags that browsers agree on. No
audio track, no metadata: nothing in the file tells its condition. Every frame passes once; the rate
is bounded while it does, so no clip is encoded twice. docs/encoding.md says why what is set.
"""

from __future__ import annotations

import fcntl
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from renderer.encoding.ffmpeg import EncodingError, ffmpeg_command

Pixels = npt.NDArray[np.uint8]

QUALITY: Final = 26.0  # x264's constant rate factor outside of the boxes
BOX_STEPS: Final = 15.2  # finer quantiser steps inside the boxes; 6 steps halve the error
PRESET: Final = "medium"  # smaller by a sixth than "veryfast" at the same FLIP
THREADS: Final = 2  # fixed: x264's bytes depend on the number of threads
BUFFER_S: Final = 0.5  # the time over which ``max_rate`` holds
_STEPS: Final = 51  # addroi's offset is a share of H.264's range of quantisers
_PIPE_BYTES: Final = 1 << 20  # Linux's most: a frame in six pieces instead of a hundred

# The conversion to YCbCr is named as well as tagged: FFmpeg's default is BT.601, which browsers
# guess to be BT.709 above 576 lines. Without the flags it is quick and darkens by 0.1 of a step.
_EXACT: Final = "flags=bicubic+accurate_rnd+full_chroma_inp+full_chroma_int"
AS_STORED: Final = (
    f"scale=in_range=full:out_color_matrix=bt709:out_range=tv:{_EXACT},format=yuv420p,"
    "setparams=color_primaries=bt709:color_trc=iec61966-2-1:colorspace=bt709:range=tv"
)
# Nobody seeks in a clip: one key frame spares a fifth of a second's worth of them, and the pulse
# that each would show. Chroma gets 12 steps more than x264's habit: FLIP sees iris colour. What
# stays in view for long is worth more bits now (qcomp), looked for 2 s ahead.
_X264: Final = "keyint=300:chroma-qp-offset=-12:qcomp=0.5:rc-lookahead=60"
_OUTPUT: Final = [
    *("-c:v", "libx264", "-preset", PRESET, "-threads", str(THREADS), "-x264-params", _X264),
    *("-colorspace", "bt709", "-color_primaries", "bt709"),
    *("-color_trc", "iec61966-2-1", "-color_range", "tv"),
    *("-movflags", "+faststart", "-map_metadata", "-1"),
    *("-fflags", "+bitexact", "-flags:v", "+bitexact", "-an"),
    *("-bsf:v", "filter_units=remove_types=6"),  # x264's note of its own options
]
# H.264 High 4:4:4 Predictive in RGB, without loss: a third of FFV1's time, a quarter larger.
_MASTER: Final = [
    *("-c:v", "libx264rgb", "-qp", "0", "-preset", "ultrafast", "-threads", str(THREADS)),
    *("-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-an"),
]


class Box(NamedTuple):
    """A rectangle of the picture in pixels from its upper left corner."""

    x: int
    y: int
    width: int
    height: int


class Encoder:
    """Takes a clip's frames in order."""

    def __init__(self, pipe: IO[bytes], size: tuple[int, int]) -> None:
        self._pipe = pipe
        self._shape = (size[1], size[0], 3)

    def write(self, frame: Pixels) -> None:
        """Encode the next frame, (height, width, 3) uint8 sRGB."""
        if frame.shape != self._shape or frame.dtype != np.uint8:
            raise ValueError(f"a frame is {frame.shape} {frame.dtype}, not {self._shape} uint8")
        self._pipe.write(np.ascontiguousarray(frame).data)


@contextmanager
def open_encoder(
    path: Path,
    *,
    fps: int,
    size: tuple[int, int],
    boxes: Sequence[Box] = (),
    quality: float = QUALITY,
    box_steps: float = BOX_STEPS,
    max_rate: float | None = None,
    master: Path | None = None,
) -> Iterator[Encoder]:
    """Encode what is written into ``path``, and into ``master`` without loss.

    ``quality`` is x264's constant rate factor; ``boxes`` get quantisers ``box_steps`` finer than
    the rest. ``max_rate`` in bits per second coarsens what exceeds it over
    BUFFER_S. FFmpeg works beside the caller; leaving waits until the files are whole. Raises
    EncodingError when FFmpeg stops, on a full disk for instance.
    """
    width, height = size
    command = ffmpeg_command(
        *("-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"),
        *("-r", str(fps), "-i", "-"),
        *("-vf", _filters(boxes, box_steps), "-crf", f"{quality:.2f}", *_bound(max_rate)),
        *(*_OUTPUT, str(path)),
        *([] if master is None else [*_MASTER, str(master)]),
    )
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=said)
        assert process.stdin is not None
        if hasattr(fcntl, "F_SETPIPE_SZ"):
            fcntl.fcntl(process.stdin, fcntl.F_SETPIPE_SZ, _PIPE_BYTES)
        try:
            with process.stdin as pipe:
                yield Encoder(pipe, size)
        except BrokenPipeError:
            pass  # FFmpeg's own words say more, below
        except BaseException:
            process.kill()
            process.wait()
            raise
        if process.wait() != 0:
            said.seek(0)
            raise EncodingError(f"{path}: FFmpeg stopped: {said.read().decode().strip()}")


def _filters(boxes: Sequence[Box], box_steps: float) -> str:
    offset = -box_steps / _STEPS
    regions = [f"addroi=x={b.x}:y={b.y}:w={b.width}:h={b.height}:qoffset={offset}" for b in boxes]
    return ",".join([AS_STORED, *regions])


def _bound(max_rate: float | None) -> list[str]:
    if max_rate is None:
        return []
    return ["-maxrate", f"{max_rate:.0f}", "-bufsize", f"{max_rate * BUFFER_S:.0f}"]
