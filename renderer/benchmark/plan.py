"""Which parts are measured, in which order, and how far a benchmark has come."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from renderer.benchmark.aims import aim_steps
from renderer.benchmark.clock import QUERY, WALL
from renderer.benchmark.crowd import crowd_steps
from renderer.benchmark.cubes import cube_steps
from renderer.benchmark.effects import effect_steps
from renderer.benchmark.lods import lod_steps
from renderer.benchmark.result import PARTS, Bench
from renderer.benchmark.samples import sample_steps
from renderer.benchmark.stand import Stand, Step, total_weight
from renderer.benchmark.startup import memory_steps, startup_steps
from renderer.benchmark.work import work_steps
from renderer.studio import Studio

ROUNDS: Final = 9
QUICK_ROUNDS: Final = 3
SIZE: Final = (1920, 1080)
QUICK_SIZE: Final = (640, 360)


# Seconds a unit of weight: whatever the size, and for each million pixels. Two cores with llvmpipe.
WEIGHT_S: Final = {WALL: (0.10, 0.11), QUERY: (0.10, 0.002)}
CORES: Final = 2


@dataclass(frozen=True)
class Progress:
    """Before a step: its title, the share of the work that is done, and the seconds left.

    ``left_s`` is guessed from the size and the kind of GL before there is anything to reckon from.
    """

    title: str
    share: float
    left_s: float


def steps_of(parts: Sequence[str], *, is_quick: bool) -> list[Step]:
    """Return the steps of some parts in the order of PARTS.

    In a hurry each part measures its ends only, in fewer rounds.
    """
    rounds = QUICK_ROUNDS if is_quick else ROUNDS
    each: dict[str, list[Step]] = {
        "lods": lod_steps(rounds, is_quick=is_quick),
        "effects": effect_steps(rounds, is_quick=is_quick),
        "samples": sample_steps(rounds, is_quick=is_quick),
        "cubes": cube_steps(rounds, is_quick=is_quick),
        "crowd": crowd_steps(rounds, is_quick=is_quick),
        "aims": aim_steps(rounds, is_quick=is_quick),
        "work": work_steps(is_quick=is_quick),
        "startup": startup_steps(is_quick=is_quick),
        "memory": memory_steps(is_quick=is_quick),
    }
    return [step for part in PARTS if part in parts for step in each[part]]


def run_bench(
    parts: Sequence[str] = PARTS,
    *,
    is_quick: bool = False,
    size: tuple[int, int] | None = None,
    progress: Callable[[Progress], None] = lambda _progress: None,
) -> Bench:
    """Measure some parts on this machine; ``progress`` is told before each step."""
    started = time.monotonic()
    steps = steps_of(parts, is_quick=is_quick)
    rounds = QUICK_ROUNDS if is_quick else ROUNDS
    studio = Studio()
    try:
        stand = Stand(studio, size or (QUICK_SIZE if is_quick else SIZE), rounds=rounds)
        bench = Bench(about=stand.about(is_quick=is_quick, seconds=0.0))
        for number, step in enumerate(steps):
            share = total_weight(steps[:number]) / total_weight(steps)
            spent = time.monotonic() - started
            left_s = spent / share * (1 - share) if share else guess_s(stand, steps)
            progress(Progress(f"{step.part}: {step.title}", share, left_s))
            step.measure(stand, bench)
        seconds = time.monotonic() - started
        return Bench(
            about=stand.about(is_quick=is_quick, seconds=seconds),
            rows=bench.rows,
            work=bench.work,
            startup=bench.startup,
            memory=bench.memory,
        )
    finally:
        studio.close()


def guess_s(stand: Stand, steps: Sequence[Step]) -> float:
    """Return about how many seconds some steps are going to take, from what they took elsewhere.

    Setting up is the same for every size; frames follow the pixels, and on software GL the cores.
    """
    set_up_s, frame_s = WEIGHT_S[stand.clock]
    megapixels = stand.size[0] * stand.size[1] / 1e6
    cores = CORES / (os.cpu_count() or 1) if stand.clock == WALL else 1.0
    return total_weight(steps) * (set_up_s + frame_s * megapixels * cores)
