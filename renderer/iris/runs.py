"""Runs of strands in polar coordinates and the forces that bend them all: flow, cusps, crypts.

A run goes from one radius to another; every array over points is flat, one run after the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from renderer.iris.angles import angle_between, over_angle
from renderer.iris.layout import IRIS_RADIUS_MM, Array, IrisLayout
from renderer.textures.noise import Field, polar_noise, sample_polar
from renderer.textures.tubes import Tubes


@dataclass(frozen=True)
class Runs:
    """Points of runs: the run's number, the coordinate it runs along, and 0 to 1 from end to end.

    ``length`` is that of each point's run.
    """

    run: npt.NDArray[np.int64]
    at: Field
    along: Field
    length: Field


def lay_runs(start: Array, stop: Array, *, step: float) -> Runs:
    """Return points every ``step`` or closer from ``start`` to ``stop`` of each run."""
    points = np.maximum(np.ceil((stop - start) / step).astype(np.int64), 4)
    run = np.repeat(np.arange(points.size), points)
    first = np.repeat(np.cumsum(points) - points, points)
    along = ((np.arange(run.size) - first) / np.repeat(points - 1, points)).astype(np.float32)
    span = (stop - start).astype(np.float32)
    at = (start[run] + span[run] * along).astype(np.float32)
    return Runs(run=run, at=at, along=along, length=span[run])


def taper(runs: Runs, *, reach: float, scale: float = 1.0) -> Field:
    """Return 0 at a run's ends and 1 farther than ``reach`` from them; lengths times ``scale``."""
    end = np.minimum(runs.along, np.float32(1.0) - runs.along) * runs.length * np.float32(scale)
    return np.asarray(np.clip(end / np.float32(reach), 0.0, 1.0) ** np.float32(0.6))


def polar_tubes(
    radius: Field, angle: Field, runs: Runs, *, half_width_mm: Field, crest: Field, tone: Field
) -> Tubes:
    """Return tubes along points in polar coordinates, each falling steeply at its edges."""
    return Tubes(
        x_mm=np.asarray(radius * np.cos(angle), np.float32),
        y_mm=np.asarray(radius * np.sin(angle), np.float32),
        half_width_mm=np.asarray(half_width_mm, np.float32),
        crest=np.asarray(crest, np.float32),
        drop=np.full(runs.run.size, 0.72, np.float32),
        tone=np.asarray(tone, np.float32),
        tube=runs.run,
    )


def bend_with_flow(layout: IrisLayout, angle: Field, radius: Field, seed: int) -> Field:
    """Bend all strands together: a swirling field, and bundling at the collarette's cusps."""
    radius01 = (radius - 2.0) / np.float32(IRIS_RADIUS_MM - 2.0)
    turns = angle / np.float32(2.0 * np.pi)
    broad = polar_noise(64, 1024, cells=(3.0, 11), seed=seed * 16 + 7)
    close = polar_noise(128, 2048, cells=(6.0, 64), seed=seed * 16 + 8)
    open_up = np.clip((radius01 - 0.25) / 0.4, 0.0, 1.0)
    drift = 0.050 * sample_polar(broad, radius01, turns)
    drift += 0.020 * sample_polar(close, radius01, turns)
    angle = angle + drift * open_up / radius * np.float32(2.5)
    ordered = np.sort(layout.cusp_angle)
    right = np.searchsorted(ordered, np.mod(angle, 2.0 * np.pi)) % ordered.size
    to_right = angle_between(ordered[right], angle)
    to_left = angle_between(ordered[right - 1], angle)
    nearest = np.where(np.abs(to_right) < np.abs(to_left), to_right, to_left)
    ring = over_angle(layout.collarette_mm, angle)
    pull = 0.36 * np.exp(-(((radius - ring - 0.08) / 0.40) ** 2))
    return np.asarray(angle + nearest * pull, np.float32)


def push_aside(
    layout: IrisLayout, angle: Field, radius: Field, obeys: float
) -> tuple[Field, Field]:
    """Bend paths around the crypts; return the new angle and how deep inside a crypt a point is."""
    inside = np.zeros_like(angle)
    crypts = layout.crypts
    for i in np.argsort(crypts.half_width_mm):
        t = (radius - crypts.radius_mm[i]) / crypts.half_length_mm[i]
        near = np.flatnonzero(np.abs(t) < 1.25)
        offset = angle_between(angle[near], crypts.angle[i]) * radius[near]
        width = crypts.half_width_mm[i]
        close = np.abs(offset) < 6.0 * width
        near, offset = near[close], offset[close]
        lens = width * np.maximum(1.0 - (t[near] / 1.25) ** 2, 0.0)
        pushed = np.sign(offset) * np.sqrt(offset * offset + (obeys * lens) ** 2)
        # The push dies out within a few widths, so that only neighbours crowd at the rim.
        pushed = offset + (pushed - offset) * np.exp(-((offset / (2.5 * width)) ** 2))
        depth = crypts.depth[i] * np.clip((lens - np.abs(pushed)) / (0.35 * width) + 0.3, 0, 1)
        inside[near] = np.maximum(inside[near], depth * np.clip(lens / (0.3 * width), 0, 1))
        angle[near] += ((pushed - offset) / radius[near]).astype(np.float32)
    return angle, inside
