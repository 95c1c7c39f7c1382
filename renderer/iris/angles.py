"""Closed curves over the angle around the pupil: reading them, noise along them, differences."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.textures.noise import Field, noise_1d

Array = npt.NDArray[np.float32]

ANGLES: Final = 2048  # samples of a curve, the first at angle 0


def over_angle(curve: Array, angle: Field) -> Field:
    """Read a closed curve of samples over the angle (radians) with linear interpolation."""
    turns = np.mod(angle * np.float32(1.0 / (2.0 * np.pi)), np.float32(1.0))
    position = turns * np.float32(curve.size)
    low = position.astype(np.int64)
    fraction = (position - low).astype(np.float32)
    closed = np.concatenate([curve, curve[:1], curve[:1]])
    value: Field = closed[low] * (np.float32(1.0) - fraction) + closed[low + 1] * fraction
    return value


def closed_noise(cells: int, seed: int, line: int = 0) -> Array:
    """Return smooth noise over the closed angle with ``cells`` lattice cells, unit deviation."""
    x = (np.arange(ANGLES) / ANGLES * cells).astype(np.float32)
    lines = np.full(x.size, line)
    # The lattice is made periodic by cross-fading the last two cells into the first two.
    near, far = noise_1d(lines, x, seed), noise_1d(lines, x - np.float32(cells), seed)
    fade = np.clip((x - (cells - 2.0)) / 2.0, 0.0, 1.0).astype(np.float32)
    blend = near * (1.0 - fade) + far * fade
    return np.asarray(blend / np.sqrt(fade**2 + (1.0 - fade) ** 2), np.float32)


def angle_between(a: Field, b: Field) -> Field:
    """Return the signed difference a - b wrapped into -pi to pi."""
    two_pi = np.float32(2.0 * np.pi)
    return np.asarray(np.mod(a - b + np.float32(np.pi), two_pi) - np.float32(np.pi))
