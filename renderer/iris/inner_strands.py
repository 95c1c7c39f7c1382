"""The strands of the pupillary zone and of the collarette as tubes."""

from __future__ import annotations

import numpy as np

from renderer.iris.angles import over_angle
from renderer.iris.layout import IrisLayout
from renderer.iris.runs import lay_runs, polar_tubes, taper
from renderer.textures.noise import noise_1d
from renderer.textures.tubes import Tubes


def pupillary_tubes(layout: IrisLayout, seed: int, *, step_mm: float) -> Tubes:
    """Return the fine straight strands between ruff and collarette."""
    rng = np.random.Generator(np.random.PCG64([seed, 0x9A]))
    count, key = 3000, seed * 16 + 9
    base = rng.uniform(0, 2 * np.pi, count).astype(np.float32)
    inner, outer = over_angle(layout.pupil_mm, base), over_angle(layout.collarette_mm, base)
    whole = rng.random(count) < 0.55
    free = inner + rng.uniform(0.0, 0.7, count) * (outer - inner)
    start = np.where(whole, inner + rng.uniform(0.0, 0.10, count), free)
    stop = np.where(
        whole, outer - rng.uniform(-0.05, 0.25, count), start + rng.exponential(0.5, count)
    )
    stop = np.minimum(stop, outer + 0.03)
    start = np.minimum(start, stop - 0.1)
    runs = lay_runs(start.astype(np.float32), stop.astype(np.float32), step=step_mm)
    run, radius = runs.run, runs.at
    span = np.clip((radius - inner[run]) / (outer - inner)[run], 0.0, 1.0)
    offset = 0.022 * span * noise_1d(run // 5, radius / np.float32(0.40), key + 11)
    offset += 0.007 * noise_1d(run, radius / np.float32(0.16), key + 22)
    lean = rng.normal(0.0, 0.045, count).astype(np.float32)
    ends = taper(runs, reach=0.16)
    crest = rng.uniform(0.20, 0.56, count).astype(np.float32)[run]
    crest += 0.05 * noise_1d(run, radius / np.float32(0.3), key + 33)
    return polar_tubes(
        radius,
        np.asarray(base[run] + offset / radius + lean[run] * span),
        runs,
        half_width_mm=rng.uniform(0.005, 0.014, count)[run] * (0.25 + 0.75 * ends),
        crest=crest * (0.5 + 0.5 * ends),
        tone=rng.uniform(0.15, 0.78, count).astype(np.float32)[run],
    )


def collarette_tubes(layout: IrisLayout, seed: int, *, step_mm: float) -> Tubes:
    """Return the collarette: broken cords that follow the zigzag and weave about it."""
    rng = np.random.Generator(np.random.PCG64([seed, 0xC0]))
    count, key = 150, seed * 16 + 10
    span = np.clip(rng.exponential(0.13, count), 0.06, 0.6)
    first = rng.uniform(0, 2 * np.pi, count)
    # These runs go along the angle; the ring's radius of about 3.4 mm turns it into lengths.
    runs = lay_runs(first.astype(np.float32), (first + span).astype(np.float32), step=step_mm / 3.6)
    run, angle = runs.run, runs.at
    shift = rng.normal(0.0, 0.055, count).astype(np.float32)[run]
    shift += 0.045 * noise_1d(run // 3, angle / np.float32(0.10), key + 11)
    shift += 0.020 * noise_1d(run, angle / np.float32(0.04), key + 12)
    # Cords cross the ring aslant, so that it reads as a zigzag and not as a braid.
    shift += rng.normal(0.0, 0.07, count).astype(np.float32)[run] * (2.0 * runs.along - 1.0)
    follows = rng.uniform(0.6, 1.0, count).astype(np.float32)[run]
    ring = over_angle(layout.collarette_mm, angle)
    radius = ring + (layout.collarette_mm.mean() - ring) * (1.0 - follows) * 0.7 + shift
    ends = taper(runs, reach=0.22, scale=3.4)
    crest = rng.uniform(0.30, 0.74, count).astype(np.float32)[run]
    crest += 0.10 * noise_1d(run, angle / np.float32(0.06), key + 22)
    return polar_tubes(
        radius,
        angle,
        runs,
        half_width_mm=rng.uniform(0.010, 0.036, count)[run] * (0.2 + 0.8 * ends),
        crest=crest * (0.3 + 0.7 * ends),
        tone=rng.uniform(0.36, 0.78, count).astype(np.float32)[run],
    )
