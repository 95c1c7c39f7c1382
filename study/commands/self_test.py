"""The clip of known colours by which browsers are tested, made where it is missing."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from renderer.encoding.encode import open_encoder
from study.design.patches import (
    CLIP_FPS,
    CLIP_FRAMES,
    COLUMNS,
    PATCH_PX,
    PATCHES,
    self_test_name,
)


def make_self_test(folder: Path) -> Path:
    """Return the self-test's clip in a media folder, encoded as all clips are.

    It appears whole or not at all, whoever makes it beside us.
    """
    path = folder / self_test_name()
    if path.exists():
        return path
    folder.mkdir(parents=True, exist_ok=True)
    squares = np.array(PATCHES, np.uint8).reshape(-1, COLUMNS, 3)
    frame = squares.repeat(PATCH_PX, axis=0).repeat(PATCH_PX, axis=1)
    made = folder / f".{os.getpid()}-{path.name}"
    size = (frame.shape[1], frame.shape[0])
    try:
        # Flat squares cost next to nothing: no bit is spared, so that an error is the browser's.
        with open_encoder(made, fps=CLIP_FPS, size=size, quality=4.0) as encoder:
            for _ in range(CLIP_FRAMES):
                encoder.write(frame)
        made.replace(path)
    finally:
        made.unlink(missing_ok=True)
    return path
