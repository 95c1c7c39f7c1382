"""Frames to H.264: one stream that every browser plays, with its colours tagged.

BT.709 matrix and primaries, sRGB transfer, limited range: the tags that browsers agree on. No
audio track, no metadata: nothing in the file tells its condition. Beside it a lossless RGB master,
from which a clip can be encoded again without rendering. docs/encoding.md says why what is set.
"""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Final, NamedTuple

import imageio_ffmpeg
import numpy as np
import numpy.typing as npt

Pixels = npt.NDArray[np.uint8]

QUALITY: Final = 26.5  # x264's constant rate factor outside of the boxes; inside BOX_STEPS finer
BOX_STEPS: Final = 15.3  # finer quantiser steps inside the boxes; 6 steps halve the error
PRESET: Final = "medium"  # smaller by a sixth than "veryfast" at the same FLIP
THREADS: Final = 2  # fixed: x264's bytes depend on the number of threads
_STEPS: Final = 51  # addroi's offset is a share of H.264's range of quantisers

# The conversion to YCbCr is named as well as tagged: FFmpeg's default is BT.601, which browsers
# guess to be BT.709 above 576 lines. Without the flags it is quick and darkens by 0.1 of a step.
_EXACT: Final = "flags=bicubic+accurate_rnd+full_chroma_inp+full_chroma_int"
_AS_SHOWN: Final = "flags=bilinear+accurate_rnd+full_chroma_int"
_COLOUR: Final = (
    f"scale=in_range=full:out_color_matrix=bt709:out_range=tv:{_EXACT},format=yuv420p,"
    "setparams=color_primaries=bt709:color_trc=iec61966-2-1:colorspace=bt709:range=tv"
)
# Nobody seeks in a clip: one key frame spares a fifth of a second's worth of them, and the pulse
# that each would show. Chroma gets 6 steps more than x264's habit: FLIP sees iris colour.
_X264: Final = "keyint=300:chroma-qp-offset=-6"
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


class EncodingError(RuntimeError):
    """FFmpeg stopped; the message has the file and what FFmpeg said."""


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
    master: Path | None = None,
) -> Iterator[Encoder]:
    """Encode what is written into ``path``, and into ``master`` without loss.

    ``boxes`` get finer quantisers. FFmpeg works beside the caller; leaving waits until the files
    are whole. Raises EncodingError when FFmpeg stops, on a full disk for instance.
    """
    width, height = size
    command = [
        *(imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-y"),
        *("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(fps)),
        *("-i", "-", *clip_arguments(path, boxes=boxes, quality=quality)),
        *([] if master is None else [*_MASTER, str(master)]),
    ]
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=said)
        assert process.stdin is not None
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


def encode_again(master: Path, path: Path, *, boxes: Sequence[Box], quality: float) -> None:
    """Encode a master's frames into ``path`` at another quality."""
    run_ffmpeg("-y", "-i", str(master), *clip_arguments(path, boxes=boxes, quality=quality))


def clip_arguments(path: Path, *, boxes: Sequence[Box], quality: float) -> list[str]:
    """Return what FFmpeg is told to make a clip of its input."""
    offset = -BOX_STEPS / _STEPS
    regions = [f"addroi=x={b.x}:y={b.y}:w={b.width}:h={b.height}:qoffset={offset}" for b in boxes]
    filters = ",".join([_COLOUR, *regions])
    return ["-vf", filters, "-crf", f"{quality:.2f}", *_OUTPUT, str(path)]


def decode(path: Path, numbers: Sequence[int], *, size: tuple[int, int]) -> dict[int, Pixels]:
    """Return some frames of a clip or a master by number, as a player shows them.

    Chroma is interpolated linearly, as a GPU does it. Raises ValueError naming the file when it
    does not hold these frames.
    """
    wanted = sorted(set(numbers))
    picked = "+".join(f"eq(n\\,{number})" for number in wanted)
    raw = run_ffmpeg(
        *("-i", str(path), "-vf", f"select={picked},scale={_AS_SHOWN}"),
        *("-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"),
    )
    width, height = size
    frames = np.frombuffer(raw, np.uint8).reshape(-1, height, width, 3)
    if len(frames) != len(wanted):
        raise ValueError(f"{path}: holds {len(frames)} of the {len(wanted)} frames asked for")
    return dict(zip(wanted, frames, strict=True))


def run_ffmpeg(*arguments: str) -> bytes:
    """Run FFmpeg and return what it writes to its standard output."""
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", *arguments]
    done = subprocess.run(command, capture_output=True, stdin=subprocess.DEVNULL, check=False)
    if done.returncode != 0:
        raise EncodingError(f"FFmpeg stopped: {done.stderr.decode().strip()}")
    return done.stdout
