"""Light of the surroundings on the iris, seen from within the anterior chamber. Pure numpy.

From a point of the iris, rays are followed back through the cornea into the open: the radiance that
comes down a ray is n^2 (1 - F) times the radiance outside (Nicodemus). Lids that stand in the way
show their own skin. What the cornea keeps inside lights the iris again. The result is smooth, so a
small map per clip and eye holds it. ``chamber_rays`` follows the rays.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import CORNEA_IOR
from renderer.eye.chamber_rays import chamber_window, hemisphere
from renderer.eye.lids import LidRims, lid_openness

Array = npt.NDArray[np.float64]
Radiance = Callable[[Array], Array]  # of unit directions (n, 3) in world space, (n, 3)

LID_REFLECTANCE: Final = (0.38, 0.24, 0.18)  # skin, linear Rec. 709
BOUNCES: Final = 3  # of light between iris and cornea; a fourth adds less than 0.1 %


def chamber_irradiance(
    surroundings: Radiance,
    eye_to_world: Array,
    *,
    rims: LidRims | None,
    albedo: Array | None = None,
    size_px: int = 32,
) -> npt.NDArray[np.float32]:
    """Return the surroundings' irradiance on the iris plane, (size_px, size_px, 3) float32.

    ``eye_to_world`` is the eye's rotation (3, 3). The square is that of the caustic map. Without
    ``rims`` nothing shades the cornea. ``albedo`` (size_px, size_px, 3) is what the iris sends back
    to the cornea, which returns some of it; None is a black iris.
    """
    window = chamber_window(size_px)
    radiance = np.maximum(surroundings(window.outside @ eye_to_world.T), 0.0)
    if rims is not None:
        openness = lid_openness(window.exit_mm, window.outside, rims)[:, None]
        radiance = openness * radiance + (1.0 - openness) * _skin_radiance(surroundings)
    scale = CORNEA_IOR**2 * math.pi
    direct = scale * np.stack(
        [
            np.bincount(window.point, window.transmitted * channel, minlength=size_px**2)
            for channel in radiance.T
        ],
        axis=-1,
    )
    total = direct
    if albedo is not None:
        for _ in range(BOUNCES):
            total = direct + window.mirror @ (albedo.reshape(-1, 3) * total)
    return total.reshape(size_px, size_px, 3).astype(np.float32)


def _skin_radiance(surroundings: Radiance) -> Array:
    """Return what a lid leaves of the mean ambient light; half of its sky is hidden."""
    front = hemisphere(16, 32)
    # Cosine-weighted directions of one half stand for it evenly after dividing by the cosine.
    weight = 1.0 / np.concatenate([front[:, 2], front[:, 2]])
    around = surroundings(np.concatenate([front, -front]))
    mean_radiance = np.average(around, axis=0, weights=weight)
    return np.asarray(0.5 * np.asarray(LID_REFLECTANCE) * mean_radiance)
