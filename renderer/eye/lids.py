"""The rims of the eyelids as curves: what shades the globe and bounds what the cornea reflects.

Pure numpy. Eye space: millimetres, origin at the globe's centre, +z the gaze, +x the viewer's
right, +y up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Curve = npt.NDArray[np.float64]


@dataclass(frozen=True)
class LidRims:
    """Inner edges of upper and lower lid in eye space, (n, 3) in mm, ordered by ascending x."""

    upper_mm: Curve
    lower_mm: Curve
