"""Subsurface: the thesis's left sum with 2 to 200 samples beside our integrator, time and error.

Time: ultra frames of one eye with so many samples minus those without the effect. Error: the same
GLSL on a patch of the iris against 4000 small steps (``renderer.certification.layers``).
"""

from __future__ import annotations

from typing import Final

from renderer.benchmark.clock import difference
from renderer.benchmark.result import Bench
from renderer.benchmark.stand import Stand, Step
from renderer.certification.layers import STEPS, LayerError, integrator_errors
from renderer.detail import Detail

PART: Final = "samples"
SAMPLES: Final = (2, 10, 20, 50, 100, 200)
OURS: Final = ("high", "ultra")  # 6 and 12 nodes
POINTS: Final = 12  # along each side of the patch


def sample_steps(rounds: int, *, is_quick: bool) -> list[Step]:
    """Return the one step, whose frames must be taken in turn."""
    points = POINTS // 2 if is_quick else POINTS

    def measure(stand: Stand, bench: Bench) -> None:
        _measure(stand, bench, points=points)

    weight = (len(SAMPLES) + len(OURS) + 4) * (rounds + 2) + 5 * 9 + points**2 / 3
    return [Step(PART, "left sums and ours", weight, measure)]


def _measure(stand: Stand, bench: Bench, *, points: int) -> None:
    ultra = Detail.uniform("ultra")
    off = stand.spec(ultra.with_levels(subsurface="off"))
    sums = [stand.spec(ultra, subsurface_samples=count) for count in SAMPLES]
    ours = [stand.spec(ultra.with_levels(subsurface=level)) for level in OURS]
    without, *times = stand.time([stand.frames(spec) for spec in (off, *sums, *ours)])
    nodes = tuple(int(spec.left.setting("subsurface", "nodes")) for spec in ours)
    errors = integrator_errors(
        stand.studio.gl,
        iris_seed=off.iris_seed,
        iris_colour=off.iris_colour,
        points=points,
        wanted=[("left sum", n) for n in SAMPLES] + [("pieces", n) for n in nodes],
        steps=STEPS,
    )
    levels = [*["ultra"] * len(SAMPLES), *OURS]
    counts = [*SAMPLES, *[0] * len(OURS)]
    for spec, ms, error, level, samples in zip(
        (*sums, *ours), times, errors, levels, counts, strict=True
    ):
        bench.rows.append(
            stand.row(
                PART,
                spec,
                difference(ms, without),
                effect="subsurface",
                level=level,
                base="ultra",
                samples=samples,
                **_said(error),
            )
        )


def _said(error: LayerError) -> dict[str, float]:
    return {
        "fetches": error.fetches,
        "rms_percent": round(error.rms_percent, 3),
        "bias_percent": round(error.bias_percent, 3),
    }
