"""Subsurface: the thesis's left sum with 2 to 200 samples beside our integrator, time and error.

Time: ultra frames of one eye with so many samples minus those without the effect. Error: the same
GLSL on a patch of the iris against 4000 small steps (``renderer.certification.layers``).
"""

from __future__ import annotations

from functools import partial
from typing import Final

from renderer.benchmark.clock import WARM_UP
from renderer.benchmark.result import Bench
from renderer.benchmark.spread import difference
from renderer.benchmark.stand import Stand, Step
from renderer.certification.layers import STEPS, LayerError, integrator_errors
from renderer.detail import Detail

PART: Final = "samples"
SAMPLES: Final = (2, 10, 20, 50, 100, 200)
QUICK_SAMPLES: Final = (10, 200)
OURS: Final = ("high", "ultra")  # 6 and 8 nodes
POINTS: Final = 12  # along each side of the patch


def sample_steps(rounds: int, *, is_quick: bool) -> list[Step]:
    """Return the one step, whose frames must be taken in turn; in a hurry some of them."""
    samples, ours = (QUICK_SAMPLES, OURS[-1:]) if is_quick else (SAMPLES, OURS)
    points = POINTS // 2 if is_quick else POINTS
    weight = (len(samples) + len(ours) + 1) * (1.2 * (rounds + WARM_UP) + 8) + points**2 / 3
    measure = partial(_measure, samples=samples, ours=ours, points=points)
    return [Step(PART, "left sums and ours", weight, measure)]


def _measure(
    stand: Stand, bench: Bench, *, samples: tuple[int, ...], ours: tuple[str, ...], points: int
) -> None:
    ultra = Detail.uniform("ultra")
    off = stand.spec(ultra.with_levels(subsurface="off"))
    sums = [stand.spec(ultra, subsurface_samples=count) for count in samples]
    pieces = [stand.spec(ultra.with_levels(subsurface=level)) for level in ours]
    without, *shots = stand.time([stand.frames(spec) for spec in (off, *sums, *pieces)])
    nodes = [int(spec.left.setting("subsurface", "nodes")) for spec in pieces]
    errors = integrator_errors(
        stand.studio.gl,
        iris_seed=off.iris_seed,
        iris_colour=off.iris_colour,
        points=points,
        wanted=[("left sum", n) for n in samples] + [("pieces", n) for n in nodes],
        steps=STEPS,
    )
    counts = [*samples, *[0] * len(ours)]
    for spec, own, error, count in zip((*sums, *pieces), shots, errors, counts, strict=True):
        bench.rows.append(
            stand.row(
                PART,
                spec,
                difference(own, without),
                effect="subsurface",
                level=spec.left.subsurface,
                base="ultra",
                samples=count,
                **_said(error),
            )
        )


def _said(error: LayerError) -> dict[str, float]:
    return {
        "fetches": error.fetches,
        "rms_percent": round(error.rms_percent, 3),
        "bias_percent": round(error.bias_percent, 3),
    }
