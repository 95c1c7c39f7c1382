"""The limbus: dark and soft, wandering over millimetres, never scalloped."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from renderer.detail import Detail

OFF = Detail.uniform("off")
SIZE_PX = 320
HALF_MM = 7.0
ANGLES = np.linspace(0.0, 2.0 * math.pi, 360, endpoint=False)


def profile(bench: Any, level: str) -> np.ndarray:
    """Return the green of radii 4 to 6.9 mm (59,) at each angle (360,), seen along the gaze."""
    eyes = bench.eyes(OFF.with_levels(sclera=level, tessellation="ultra"))
    green = bench.picture(eyes, size=(SIZE_PX, SIZE_PX))[..., 1]
    radii = np.linspace(4.0, 6.9, 59)
    column = (radii[:, None] * np.cos(ANGLES) / HALF_MM + 1) * SIZE_PX / 2 - 0.5
    row = (radii[:, None] * np.sin(ANGLES) / HALF_MM + 1) * SIZE_PX / 2 - 0.5
    x, y = np.floor(column).astype(int), np.floor(row).astype(int)
    u, v = column - x, row - y
    lower = (1 - u) * green[y, x] + u * green[y, x + 1]
    upper = (1 - u) * green[y + 1, x] + u * green[y + 1, x + 1]
    return np.asarray((1 - v) * lower + v * upper)


@pytest.fixture
def edge_mm(bench: Any) -> np.ndarray:
    """The radius at each angle where the white has risen half-way, without its oval."""
    lines = profile(bench, "ultra")
    half = 0.5 * (lines.min(axis=0) + lines[-1])
    radii = np.linspace(4.0, 6.9, 59)
    edge = np.array(
        [
            np.interp(level, line[dark:], radii[dark:])
            for line, level, dark in zip(lines.T, half, lines.argmin(axis=0), strict=True)
        ]
    )
    waves = np.fft.rfft(edge)
    waves[[0, 2, 4]] = 0.0
    return np.asarray(np.fft.irfft(waves, n=len(edge)))


def test_the_edge_wanders_a_little(edge_mm: np.ndarray) -> None:
    assert 0.01 < edge_mm.std() < 0.08


def test_the_edge_is_not_scalloped(edge_mm: np.ndarray) -> None:
    """Teeth shorter than a millimetre: more than 37 to the round."""
    waves = np.fft.rfft(edge_mm)
    waves[:37] = 0.0
    assert np.fft.irfft(waves, n=len(edge_mm)).std() < 0.008


def test_the_ring_is_dark_and_fades_into_the_iris(bench: Any) -> None:
    plain, ringed = (profile(bench, level).mean(axis=1) for level in ("medium", "ultra"))
    share = ringed / plain
    assert share.min() < 0.75
    assert share[0] > 0.95  # 4 mm: the iris's own light
    assert share[-1] > 0.9
    assert np.abs(np.diff(share)).max() < 0.06  # per 0.05 mm: soft on both sides


def test_calibration_sees_no_ring(bench: Any) -> None:
    """The iris's mean within 4.9 mm of the axis changes by less than the presets allow."""
    radii = np.linspace(4.0, 6.9, 59)
    inside = radii < 4.9
    plain, ringed = (profile(bench, level)[inside].mean() for level in ("medium", "ultra"))
    assert ringed == pytest.approx(plain, rel=0.1)
