"""The encoder: every frame, true colours, tags, nothing that tells the condition."""

from __future__ import annotations

import subprocess
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest

from renderer.encoding.decode import as_stored, decode
from renderer.encoding.encode import open_encoder
from renderer.encoding.ffmpeg import EncodingError

COLOURS = [(200, 120, 60), (128, 128, 128), (40, 60, 90), (235, 225, 215)]


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("encode") / "patches.mp4"
    with open_encoder(path, fps=30, size=(96, 54)) as encoder:
        for number in range(7):
            frame = np.zeros((54, 96, 3), np.uint8)
            for column, colour in enumerate(np.roll(COLOURS, number, axis=0)):
                frame[:, column * 24 : (column + 1) * 24] = colour
            encoder.write(frame)
    return path


def test_flat_patches_come_back_within_three_steps(clip: Path) -> None:
    decoded = decode(clip, range(7), size=(96, 54))
    assert sorted(decoded) == list(range(7))
    for number, frame in decoded.items():
        assert frame.shape == (54, 96, 3)
        for column, colour in enumerate(np.roll(COLOURS, number, axis=0)):
            patch = frame[20:30, column * 24 + 8 : column * 24 + 16].reshape(-1, 3).mean(axis=0)
            assert np.abs(patch - colour).max() <= 3, (number, column)


def test_the_stream_is_tagged_silent_and_without_metadata(clip: Path) -> None:
    ffmpeg = imageio_ffmpeg.get_ffmpeg_exe()
    told = subprocess.run(
        [ffmpeg, "-hide_banner", "-i", str(clip)], capture_output=True, text=True, check=False
    ).stderr
    assert "yuv420p(tv, bt709/bt709/iec61966-2-1" in told
    assert "Audio" not in told
    assert b"x264 - core" not in clip.read_bytes()


def test_the_same_frames_give_the_same_file(clip: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.mp4"
    with open_encoder(again, fps=30, size=(96, 54)) as encoder:
        for number in range(7):
            frame = np.zeros((54, 96, 3), np.uint8)
            for column, colour in enumerate(np.roll(COLOURS, number, axis=0)):
                frame[:, column * 24 : (column + 1) * 24] = colour
            encoder.write(frame)
    assert again.read_bytes() == clip.read_bytes()


def test_a_frame_that_is_not_there_is_an_error_with_the_files_name(clip: Path) -> None:
    with pytest.raises(ValueError, match=r"patches\.mp4: holds 1 of the 2 frames asked for"):
        decode(clip, [6, 7], size=(96, 54))


def test_an_encoder_that_stops_says_which_file_and_why(tmp_path: Path) -> None:
    lost = tmp_path / "nowhere" / "clip.mp4"
    with (
        pytest.raises(EncodingError, match=r"clip\.mp4: FFmpeg stopped: .*No such file"),
        open_encoder(lost, fps=30, size=(1920, 1080)) as encoder,
    ):
        encoder.write(np.zeros((1080, 1920, 3), np.uint8))


def test_a_frame_of_another_size_is_refused(tmp_path: Path) -> None:
    with (
        pytest.raises(ValueError, match=r"a frame is \(64, 64, 3\) uint8, not \(54, 96, 3\) uint8"),
        open_encoder(tmp_path / "clip.mp4", fps=30, size=(96, 54)) as encoder,
    ):
        encoder.write(np.zeros((64, 64, 3), np.uint8))


def test_the_form_alone_keeps_grey_and_halves_the_resolution_of_colour() -> None:
    grey = np.repeat(np.arange(30, 220, dtype=np.uint8)[None, :, None], 20, axis=0).repeat(
        3, axis=2
    )
    assert np.abs(as_stored(grey).astype(int) - grey).max() <= 1
    stripes = np.zeros((20, 40, 3), np.uint8)
    stripes[:, ::2, 0] = 200  # red, black, red: a colour that only every second column has
    assert np.abs(as_stored(stripes).astype(int) - stripes).mean() > 15
