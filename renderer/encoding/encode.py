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
from renderer.encoding.regions import Stretch, filter_graph

Pixels = npt.NDArray[np.uint8]

QUALITY: Final = 24.0  # x264's constant rate factor unless another is asked for
PRESET: Final = "medium"  # smaller by a sixth than "veryfast" at the same FLIP
THREADS: Final = 2  # fixed: x264's bytes depend on the number of threads
_PIPE_BYTES: Final = 1 << 20  # Linux's most: a frame in six pieces instead of a hundred

# The conversion to YCbCr is named as well as tagged: FFmpeg's default is BT.601, which browsers
# guess to be BT.709 above 576 lines. Without the flags it is quick and darkens by 0.1 of a step.
# A player interpolates chroma linearly, which blurs it: this cubic (B -0.5, C 1.5, measured) halves
# it sharply, so that more is left of colour afterwards.
_EXACT: Final = "flags=accurate_rnd+full_chroma_inp+full_chroma_int"
_SHARP: Final = f"{_EXACT}+bicubic:param0=-0.5:param1=1.5"
AS_STORED: Final = (
    f"scale=in_range=full:out_color_matrix=bt709:out_range=tv:{_SHARP},format=yuv420p,"
    "setparams=color_primaries=bt709:color_trc=iec61966-2-1:colorspace=bt709:range=tv"
)
# Nobody seeks in a clip: one key frame spares a fifth of a second's worth of them, and the pulse
# that each would show. Chroma gets 12 steps more than x264's habit: FLIP sees iris colour. What
# stays in view for long is worth more bits now (qcomp), looked for 2 s ahead. psy-rd would trade
# error for grain.
_X264: Final = "keyint=300:chroma-qp-offset=-12:qcomp=0.5:rc-lookahead=60:psy-rd=0,0"
_OUTPUT: Final = [
    *("-c:v", "libx264", "-preset", PRESET, "-threads", str(THREADS)),
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


class Rate(NamedTuple):
    """The most bits per second, over so many seconds."""

    bits_per_s: float
    over_s: float


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
    stretches: Sequence[Stretch] = (),
    quality: float = QUALITY,
    matrices: str = "flat",
    rate: Rate | None = None,
    master: Path | None = None,
) -> Iterator[Encoder]:
    """Encode what is written into ``path``, and into ``master`` without loss.

    ``quality`` is x264's constant rate factor outside of the boxes of ``stretches``,
    ``matrices`` its quantisation matrices ("flat", "jvt"). What exceeds ``rate`` is made coarser.
    FFmpeg works beside the caller; leaving waits until the files are whole. Raises EncodingError
    when FFmpeg stops, on a full disk for instance.
    """
    width, height = size
    command = ffmpeg_command(
        *("-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"),
        *("-r", str(fps), "-i", "-"),
        *("-filter_complex", filter_graph(f"[0:v]{AS_STORED}", stretches, fps=fps, out="clip")),
        *("-map", "[clip]"),
        *("-crf", f"{quality:.2f}", *_bound(rate)),
        *("-x264-params", f"{_X264}:cqm={matrices}", *_OUTPUT, str(path)),
        *([] if master is None else ["-map", "0:v", *_MASTER, str(master)]),
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


def _bound(rate: Rate | None) -> list[str]:
    if rate is None:
        return []
    return [
        "-maxrate",
        f"{rate.bits_per_s:.0f}",
        "-bufsize",
        f"{rate.bits_per_s * rate.over_s:.0f}",
    ]
