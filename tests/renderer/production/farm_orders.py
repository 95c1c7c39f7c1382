"""Orders filled without GL, importable by spawned processes: the sclera's seed says what happens.

The folder in OCULARIST_TEST_FOLDER collects a line per order, ``seed pid``.
"""

from __future__ import annotations

import os
import signal
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from renderer.clip import ClipSpec
from renderer.production.making import make_clip

ONCE, ALWAYS, FAULTY, DAMAGED = 90, 91, 92, 93  # killed once, killed always, an error, cut once


@dataclass(frozen=True)
class Picture:
    pixels: np.ndarray
    visible_px: tuple[int, int]


class Gradients:
    """A source whose frames follow from the clip's seed."""

    gl_renderer = "pattern"
    gl_version = "1"

    def frames(self, spec: ClipSpec, numbers: Sequence[int] | None = None) -> Iterator[Picture]:
        y, x = np.mgrid[: spec.height, : spec.width]
        for number in range(spec.frame_count) if numbers is None else numbers:
            if spec.iris_seed in (ONCE, ALWAYS) and number == 1 and is_its_turn(spec):
                os.kill(os.getpid(), signal.SIGKILL)
            level = np.stack([x + number, y + spec.iris_seed, x + y], axis=-1) % 200
            yield Picture(level.astype(np.uint8), (1, 1))


def ordered() -> list[int]:
    """Return the seeds of the orders so far."""
    log = Path(os.environ["OCULARIST_TEST_FOLDER"]) / "orders.txt"
    return [int(line) for line in log.read_text().splitlines()] if log.exists() else []


def is_its_turn(spec: ClipSpec) -> bool:
    return spec.iris_seed in (ALWAYS, FAULTY) or ordered().count(spec.iris_seed) == 1


def fill(
    spec: Mapping[str, Any],
    version: str,
    *,
    contents: Mapping[str, bytes],
    with_flip: bool = False,
) -> dict[str, Any]:
    """Stand in for ``renderer.production.orders.fill_order``."""
    del version, contents, with_flip
    clip = ClipSpec.from_dict(dict(spec))
    with (Path(os.environ["OCULARIST_TEST_FOLDER"]) / "orders.txt").open("a") as log:
        log.write(f"{clip.iris_seed}\n")
    if clip.iris_seed == FAULTY:
        raise ValueError("the iris is on holiday")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "clip.mp4"
        record = make_clip(clip, path, source=Gradients(), with_flip=False)
        data = path.read_bytes()
    if clip.iris_seed == DAMAGED and is_its_turn(clip):
        data = data[:-1]
    return {"record": asdict(record), "data": data}
