"""Refuse a photograph whose light or sharpness shows too little of the iris."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.iris.maps import PUPIL_RADIUS_MM
from renderer.unrefraction.photograph import Photograph
from renderer.unrefraction.refusal import PhotographError
from renderer.unrefraction.texels import Texels

Field = npt.NDArray[np.float32]
Mask = npt.NDArray[np.bool_]

UNVEILED_MM: Final = 5.0  # from the axis, on the maps: no limbus veils this from any side
LEAST_SEEN: Final = 0.45
LEAST_DETAIL: Final = 0.04
CLIPPED: Final = 0.97
MOST_CLIPPED: Final = 0.12
LEAST_WHITE: Final = 0.03


def check_light(
    photograph: Photograph, seen: Mask, texels: Texels, clipped: float, white: Field
) -> None:
    """Refuse what is burnt out, too dark or hidden; ``white`` (3,) is the sclera's colour."""
    tissue = (texels.radius_mm > PUPIL_RADIUS_MM) & (texels.radius_mm < UNVEILED_MM)
    share = float(seen[tissue].mean())
    if clipped > MOST_CLIPPED or float(white.min()) > 0.995:
        raise PhotographError(
            f"{photograph.name}: over-exposed, {clipped:.0%} of the iris and its brightest white "
            f"{float(white.min()):.0%} bright; expose so that the white of the eye keeps its shades"
        )
    if float(white.max()) < LEAST_WHITE:
        raise PhotographError(
            f"{photograph.name}: under-exposed, the white of the eye has {float(white.max()):.1%} "
            f"of full brightness; at least {LEAST_WHITE:.0%} is needed"
        )
    if share < LEAST_SEEN:
        raise PhotographError(
            f"{photograph.name}: {share:.0%} of the iris is seen, lids, lashes and reflections "
            f"hide the rest; at least {LEAST_SEEN:.0%} is needed"
        )


def detail_of(look: Field, seen: Mask, texels: Texels) -> float:
    """Return how much the iris's brightness varies at the size of its fibres, 0.05 to 0.3 mm."""
    light = np.log(np.maximum(look.mean(axis=-1), 2e-3))[::2, ::2]
    band = ndimage.gaussian_filter(light, 2.5) - ndimage.gaussian_filter(light, 10.0)
    ring = (seen & (texels.radius_mm > 2.5) & (texels.radius_mm < 4.8))[::2, ::2]
    return float(band[ring].std()) if ring.any() else 0.0


def check_detail(photograph: Photograph, detail: float) -> None:
    """Refuse a blurred photograph."""
    if detail < LEAST_DETAIL:
        raise PhotographError(
            f"{photograph.name}: blurred, the iris's fibres vary by {detail:.1%} where sharp "
            f"photographs show 10 % and more; at least {LEAST_DETAIL:.0%} is needed"
        )
