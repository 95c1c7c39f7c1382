"""The small study of the tests, and tiny videos in the place of its clips."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from imageio_ffmpeg import write_frames

from renderer.clip import ClipSpec
from renderer.manifest import ClipRecord, Manifest, write_manifest
from renderer.sources import code_version
from study.design.definition import StudyDefinition, parse_definition, read_definition

WIDTH, HEIGHT, FPS, FRAMES = 320, 180, 30, 15


def small_definition(**changes: Any) -> StudyDefinition:
    """The thesis's study with one practice clip, two trials, one tiny size, half a second each."""
    data = read_definition("thesis").model_dump(mode="json", exclude_unset=True)
    data |= {
        "key": "small",
        "translations": {},  # tests change words
        "sizes": [f"{WIDTH}x{HEIGHT}"],
        "clips": data["clips"][:2],
        "orbit": {"duration_s": FRAMES / FPS, "fps": FPS, "directions": ["rightward"]},
        # A loaded machine drops frames: whether a play counts is asked where a test is about it.
        "certificate": {"retries": 0},
    }
    return parse_definition(data | changes)


def write_video(path: Path, number: int) -> None:
    """Write an H.264 video that differs by a number: a moving bar on mid-grey."""
    encoder = write_frames(
        path,
        (WIDTH, HEIGHT),
        fps=FPS,
        codec="libx264",
        macro_block_size=1,
        output_params=["-map_metadata", "-1"],
    )
    encoder.send(None)
    for frame in range(FRAMES):
        picture = np.full((HEIGHT, WIDTH, 3), 128, np.uint8)
        picture[20 + 5 * number : 40 + 5 * number, frame * 20 : frame * 20 + 30] = 230
        encoder.send(picture.tobytes())
    encoder.close()


def fill_shelf(
    site_folder: Path, definition: StudyDefinition, make: Callable[[int], bytes]
) -> None:
    """Put a tiny video for every clip of a study on the shelf, with its manifest."""
    site_folder.mkdir(parents=True, exist_ok=True)
    manifest = Manifest()
    for number, wanted in enumerate(definition.wanted_specs()):
        manifest.add(_record(wanted.spec, site_folder, make(number)))
    write_manifest(manifest, site_folder)


def _record(spec: ClipSpec, folder: Path, video: bytes) -> ClipRecord:
    (folder / f"{spec.clip_id}.mp4").write_bytes(video)
    return ClipRecord(
        clip_id=spec.clip_id,
        spec=spec.to_dict(),
        file=f"{spec.clip_id}.mp4",
        file_sha256=hashlib.sha256(video).hexdigest(),
        file_bytes=len(video),
        raw_sha256="0" * 64,
        frame_count=FRAMES,
        width=WIDTH,
        height=HEIGHT,
        fps=FPS,
        iris_px=[[58.0, 58.5]] * FRAMES,
        visible_px=[[900, 910]] * FRAMES,
        psnr_db=[41.0, 42.0],
        ssim=[0.991, 0.992],
        frame_ms_median=12.0,
        render_s=1.5,
        gl_renderer="a test",
        gl_version="4.5",
        code_version=code_version(),
    )
