"""Where the rings around the fissure run: their directions, their ends, nearness to the canthi.

Pure numpy, patch space (see ``lid_pose``), frontal plane.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.head.lid_rims import LATERAL_MM, MEDIAL_MM, smooth_step

OUTLINE_MM: Final = (25.5, 22.5, 17.5, 19.5)  # patch ends: temple, nose, up, down of (0, 0)


def blur_ring(values: Floats, *, samples: float) -> Floats:
    """Smooth (around, k) along the ring by a Gaussian of ``samples`` standard deviation."""
    frequency = np.fft.rfftfreq(len(values))[:, None]
    gain = np.exp(-2 * (np.pi * frequency * samples) ** 2)
    return np.asarray(np.fft.irfft(np.fft.rfft(values, axis=0) * gain, n=len(values), axis=0))


def outward_from(xy: Floats) -> Floats:
    """Return the frontal directions (n, 2) in which the rings grow from the fissure."""
    direction = blur_ring(_outline(xy) - xy, samples=5.0)
    return np.asarray(direction / np.linalg.norm(direction, axis=1, keepdims=True))


def _outline(xy: Floats) -> Floats:
    """Return where each ring position ends: an egg around the eye."""
    temple, nose, up, down = OUTLINE_MM
    centre = np.array([-1.5, -0.4])
    direction = (xy - centre) / np.array([14.5, 5.5])
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    x = np.where(direction[:, 0] > 0, temple, nose) * direction[:, 0]
    y = np.where(direction[:, 1] > 0, up, down) * direction[:, 1]
    return np.column_stack([x, y])


def canthus_nearness(xy: Floats) -> Floats:
    """Return 1 at the canthi falling to 0 some 5 mm from them."""
    nearest = np.minimum(
        np.linalg.norm(xy - np.array(LATERAL_MM), axis=1) / 4.0,
        np.linalg.norm(xy - np.array(MEDIAL_MM), axis=1) / 7.5,
    )
    return 1.0 - smooth_step(nearest)


def end_distance(edge: Floats, outward: Floats) -> Floats:
    """Return how far in mm straight lines from the rim run to the outline."""
    reach = np.linspace(1.0, 36.0, 1401)
    line = edge[:, None, :2] + outward[:, None, :] * reach[None, :, None]
    temple, nose, up, down = OUTLINE_MM
    x = line[..., 0] / np.where(line[..., 0] > 0, temple, nose)
    y = line[..., 1] / np.where(line[..., 1] > 0, up, down)
    return np.asarray(reach[np.argmax(x * x + y * y >= 1.0, axis=1)])
