"""FFmpeg as a program: started, asked, and its faults told."""

from __future__ import annotations

import subprocess

import imageio_ffmpeg


class EncodingError(RuntimeError):
    """FFmpeg stopped; the message has the file and what FFmpeg said."""


def ffmpeg_command(*arguments: str) -> list[str]:
    """Return a command line of FFmpeg that says nothing but errors."""
    return [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", *arguments]


def run_ffmpeg(*arguments: str, given: bytes = b"") -> bytes:
    """Run FFmpeg with ``given`` as its standard input; return what it writes to its output."""
    done = subprocess.run(ffmpeg_command(*arguments), input=given, capture_output=True, check=False)
    if done.returncode != 0:
        raise EncodingError(f"FFmpeg stopped: {done.stderr.decode().strip()}")
    return done.stdout
