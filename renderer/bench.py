"""What a frame costs: the last row of the thesis's Table 5.1, for each LoD at each distance."""

from __future__ import annotations

import json
import os
import statistics
import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

from renderer.camera import iris_px
from renderer.clip import DISTANCES, ClipSpec
from renderer.detail import STANDARD_LODS, Detail
from renderer.manifest import write_atomically
from renderer.studio import Studio

AZIMUTHS_DEG: Final = (-50.0, -35.0, -20.0, -5.0, 5.0, 20.0, 35.0, 50.0, 0.0)
WARM_UP: Final = 2  # the first frames compile shaders


@dataclass(frozen=True, kw_only=True)
class Cost:
    """One row of ``bench.json``: the time of a finished frame."""

    renderer: str
    size: str
    distance: str
    iris_px: float
    eyes: int
    lod: str
    ms_median: float
    ms_mad: float
    n: int
    load: float


def run_bench(
    *,
    size: tuple[int, int] = (1920, 1080),
    distances: Iterable[str] = DISTANCES,
    lods: Iterable[str] = STANDARD_LODS,
    progress: Callable[[str], None] = lambda _what: None,
) -> list[Cost]:
    """Time whole frames with two eyes of one LoD, wall clock around a frame that was read back."""
    studio = Studio()
    try:
        costs = []
        for distance in distances:
            for lod in lods:
                progress(f"{distance} {lod}")
                detail = Detail.uniform(lod)
                spec = ClipSpec(
                    left=detail, right=detail, distance=distance, width=size[0], height=size[1]
                )
                costs.append(_time(studio, spec, lod=lod))
        return costs
    finally:
        studio.close()


def write_bench(costs: list[Cost], path: Path) -> None:
    """Write ``bench.json``, which ``ocularist analyse --bench`` reads."""
    write_atomically(path, json.dumps([asdict(cost) for cost in costs], indent=1).encode())


def _time(studio: Studio, spec: ClipSpec, *, lod: str) -> Cost:
    renderer = studio.renderer(spec)
    for number in range(WARM_UP):
        renderer.render(AZIMUTHS_DEG[number])
    times_ms = []
    for number, azimuth in enumerate(AZIMUTHS_DEG):
        studio.gl.finish()
        started = time.perf_counter()
        renderer.render(azimuth, time_s=number / spec.fps)
        times_ms.append((time.perf_counter() - started) * 1000)
    median = statistics.median(times_ms)
    return Cost(
        renderer=studio.gl_renderer,
        size=f"{spec.width}x{spec.height}",
        distance=spec.distance,
        iris_px=round(iris_px(spec, 0.0)[0], 2),
        eyes=2,
        lod=lod,
        ms_median=round(median, 2),
        ms_mad=round(statistics.median(abs(ms - median) for ms in times_ms), 2),
        n=len(times_ms),
        load=round(os.getloadavg()[0], 2),
    )
