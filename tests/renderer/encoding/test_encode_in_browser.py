"""What a browser shows of an encoded clip: its colours, and that our own decoding is like it."""

from __future__ import annotations

import base64
import itertools
from pathlib import Path

import numpy as np
from playwright.sync_api import sync_playwright

from renderer.encoding.decode import decode
from renderer.encoding.encode import open_encoder
from renderer.encoding.regions import Box, Stretch

# The corners and thirds of the RGB cube, then iris, sclera, skin and sky.
COLOURS = [*itertools.product((0, 85, 170, 255), repeat=3)]
COLOURS += [(78, 108, 140), (90, 60, 32), (214, 202, 192), (196, 142, 116), (150, 40, 40)]
COLOURS += [(1, 1, 1), (254, 254, 254), (128, 128, 128)]
SIDE = 32  # pixels of a patch
COLUMNS, ROWS = 12, 6
SIZE = (COLUMNS * SIDE, ROWS * SIDE)

FIRST_FRAME = """async (address) => {
  const video = document.createElement("video");
  video.muted = true;
  const shown = new Promise((done, fail) => {
    video.requestVideoFrameCallback(done);
    video.onerror = () => fail(video.error.message);
  });
  video.src = address;
  await video.play();
  await shown;
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [video.videoWidth, video.videoHeight];
  const context = canvas.getContext("2d", { colorSpace: "srgb" });
  context.drawImage(video, 0, 0);
  return Array.from(context.getImageData(0, 0, canvas.width, canvas.height).data);
}"""


def patches() -> np.ndarray:
    cells = np.array(COLOURS, np.uint8).reshape(ROWS, COLUMNS, 3)
    return cells.repeat(SIDE, axis=0).repeat(SIDE, axis=1)


def shown_by_chromium(path: Path, *, size: tuple[int, int], gpu: bool) -> np.ndarray:
    """Return the first frame as the browser paints it, (height, width, 3).

    ``gpu`` paints as it does on a GPU, which SwiftShader stands in for.
    """
    how = ["--disable-gpu"]
    if gpu:
        how = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
    address = "data:video/mp4;base64," + base64.b64encode(path.read_bytes()).decode()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path="/usr/bin/chromium",
            args=["--no-sandbox", "--disable-dev-shm-usage", *how],
        )
        data = browser.new_page().evaluate(FIRST_FRAME, address)
        browser.close()
    return np.array(data, np.uint8).reshape(size[1], size[0], 4)[..., :3]


def cells(picture: np.ndarray) -> np.ndarray:
    """Return the mean colour of each patch's middle; its border shares chroma with the next."""
    patch = picture.reshape(ROWS, SIDE, COLUMNS, SIDE, 3)[:, 8:24, :, 8:24]
    return np.asarray(patch.mean(axis=(1, 3))).reshape(-1, 3)


def test_flat_patches_come_back_within_three_steps(tmp_path: Path) -> None:
    path, frame = tmp_path / "patches.mp4", patches()
    box = Box(0, 0, SIZE[0] // 2, SIZE[1], 15.0)  # finer on the left, as inside of an eye
    with open_encoder(path, fps=30, size=SIZE, stretches=[Stretch(0, [box])]) as encoder:
        for _ in range(15):
            encoder.write(frame)
    wanted = np.array(COLOURS, float)
    assert np.abs(cells(decode(path, [0], size=SIZE)[0]) - wanted).max() <= 2
    error = np.abs(cells(shown_by_chromium(path, size=SIZE, gpu=False)) - wanted)
    assert error[:, :2].max() <= 3
    # Without a GPU, Chromium's factor from Cb to blue is cut off at 2 (BT.709 has 2.11): blue that
    # lies far from its luma is 5 % nearer to it, however the clip was encoded.
    blueness = np.abs(wanted[:, 2] - wanted @ [0.2126, 0.7152, 0.0722])
    assert (blueness < 40).sum() >= 24
    assert error[blueness < 40, 2].max() <= 3
    assert (error[:, 2] - 0.06 * blueness).max() <= 2


def test_our_own_decoding_interpolates_colour_as_a_gpu_does(tmp_path: Path) -> None:
    path, (width, height) = tmp_path / "dots.mp4", (128, 64)
    frame = np.full((height, width, 3), 128, np.uint8)
    frame[8:24, 8:24] = (150, 120, 120)
    frame[8:24, 41:43] = (120, 120, 150)  # beside what a sample of colour covers
    frame[40:42, 20:22] = (170, 110, 120)
    frame[33:60, 64:] = np.arange(100, 164, dtype=np.uint8)[:, None]
    with open_encoder(path, fps=30, size=(width, height), quality=1.0) as encoder:
        for _ in range(15):
            encoder.write(frame)
    ours = decode(path, [0], size=(width, height))[0].astype(int)
    shown = shown_by_chromium(path, size=(width, height), gpu=True)
    assert np.abs(shown - ours).max() <= 2
    repeated = shown_by_chromium(path, size=(width, height), gpu=False)
    assert np.abs(repeated - ours).max() >= 6  # what it does without one
