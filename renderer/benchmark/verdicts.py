"""What bounds a rate, which rates were aimed at, and whether they were reached. Pure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from renderer.benchmark.result import Bench, Cost

GPU, PROCESSOR, BOTH, READING, NEITHER = "GPU", "processor", "both", "read-backs", "neither"
ALIKE: Final = 1.1  # two times that differ by less bound a rate together
APART: Final = 1.25  # a row that takes so much longer than either is slow for another reason
SIZE: Final = (1920, 1080)  # of every aim


@dataclass(frozen=True)
class GpuAim:
    """A rate on a GPU, in frames/s, and about what the thesis had on a GTX 680 (section 5.1)."""

    title: str
    frames_per_s: float
    thesis_per_s: float


@dataclass(frozen=True)
class SoftwareAim:
    """The longest time of two eyes at macroscopic on CORES cores with software GL."""

    title: str
    most_ms: float
    part: str
    lod: str
    cube: str | None = None


# By the distance that a row of the part "aims" tells.
GPU_AIMS: Final = {
    "macroscopic": GpuAim("two ultra eyes, dynamic cube of 2048 px", 120.0, 50.0),
    "group": GpuAim("30 people, 60 eyes by size", 60.0, 15.0),
}
CORES: Final = 2
SOFTWARE_AIMS: Final = (
    SoftwareAim("two low eyes", 120.0, "lods", "low"),
    SoftwareAim("two ultra eyes, cubes auto", 280.0, "cubes", "ultra", "auto"),
    SoftwareAim("two ultra eyes, cubes of 2048 px", 400.0, "cubes", "ultra", "table"),
)


def frames_per_s(row: Cost) -> float | None:
    """Return a whole frame's rate: on a GPU of frames in a row, which may overlap; or None."""
    ms = row.ms_median if row.row_ms is None else row.row_ms
    return 1000.0 / ms if ms > 0.0 else None


def bound_by(row: Cost) -> str:
    """Say what a GPU's rate in a row is bound by: the longer of its time and the processor's.

    Where more than a tenth of a frame is waiting for what it reads back, the two do not overlap.
    Where a row takes much longer than either, other threads of the driver or other work bound it.
    Empty for a row that tells no rate in a row.
    """
    if row.row_ms is None or row.processor_ms is None:
        return ""
    if (row.wait_ms or 0.0) > (ALIKE - 1.0) * row.row_ms:
        return READING
    if row.row_ms > APART * max(row.ms_median, row.processor_ms):
        return NEITHER
    if row.ms_median > ALIKE * row.processor_ms:
        return GPU
    return PROCESSOR if row.processor_ms > ALIKE * row.ms_median else BOTH


def software_aims(bench: Bench) -> list[tuple[SoftwareAim, Cost]]:
    """Return the aims on software GL with their measurements, where size and cores are theirs."""
    if bench.about.size != "{}x{}".format(*SIZE) or bench.about.cores != CORES:
        return []
    return [
        (aim, row)
        for aim in SOFTWARE_AIMS
        for row in bench.of_part(aim.part)
        if (row.lod, row.cube, row.eyes) == (aim.lod, aim.cube, 2)
        if row.distance == "macroscopic" and row.row_ms is None
    ]
