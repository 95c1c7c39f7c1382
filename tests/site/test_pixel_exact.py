"""A clip is painted pixel for pixel where the screen's pixel ratio is a fraction."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from imageio_ffmpeg import write_frames
from PIL import Image
from playwright.sync_api import sync_playwright

WIDTH, HEIGHT = 320, 180


@pytest.fixture
def make_video(tmp_path: Path) -> Callable[[int], bytes]:
    """Lines one pixel wide, upright below and lying above: any resampling turns them grey."""
    path = tmp_path / "lines.mp4"
    encoder = write_frames(
        path, (WIDTH, HEIGHT), fps=30, macro_block_size=1, output_params=["-qp", "1"]
    )
    encoder.send(None)
    frame = np.full((HEIGHT, WIDTH, 3), 40, np.uint8)
    frame[HEIGHT // 2 :, 1::2] = 220
    frame[: HEIGHT // 2 : 2] = 220
    for _ in range(15):
        encoder.send(frame.tobytes())
    encoder.close()
    return lambda _number: path.read_bytes()


@pytest.mark.parametrize("database_kind", ["sqlite"])
def test_lines_one_pixel_wide_stay_sharp_at_a_ratio_of_one_and_a_half(
    site: Any, guest: Any
) -> None:
    guest.walk_to_trial()
    cookie: Any = {"name": "ocularist_participant", "url": site.url}
    cookie["value"] = guest.client.cookies["ocularist_participant"]
    with sync_playwright() as playwright:
        # Not the emulated ratio of a context: only a real one lays out in device pixels.
        browser = playwright.chromium.launch(
            executable_path="/usr/bin/chromium",
            args=["--no-sandbox", "--force-device-scale-factor=1.5", "--window-size=701,501"],
        )
        context = browser.new_context(no_viewport=True)
        context.add_cookies([cookie])
        page = context.new_page()
        page.goto(f"{site.url}/trial/1")
        page.locator(".stage[data-state=ready]").wait_for()
        # The first frame without its curtain, as if the clip stood still.
        page.evaluate("document.querySelector('.stage').dataset.state = 'playing'")
        page.evaluate("document.querySelector('.stage').scrollIntoView()")
        picture = np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("L")).astype(int)
        browser.close()
    bright, dark = picture > 200, picture < 60
    rows, columns = np.where(bright | dark)
    top, left = rows.min(), columns.min()
    assert (rows.max() - top + 1, columns.max() - left + 1) == (HEIGHT, WIDTH)
    clip = picture[top : top + HEIGHT, left : left + WIDTH]
    assert np.abs(np.diff(clip[HEIGHT // 2 + 8 : -8], axis=1)).min() > 150
    assert np.abs(np.diff(clip[8 : HEIGHT // 2 - 8], axis=0)).min() > 150
