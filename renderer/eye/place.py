"""Where the two eyes stand in the world. Pure numpy.

World space is in millimetres, right-handed: x to the viewer's right, y up, z from the face towards
the viewer; the origin lies midway between the centres of the two globes.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

INTEROCULAR_MM: Final = 62.0


def eye_centre_mm(eye: int) -> npt.NDArray[np.float64]:
    """Return the centre of the viewer's left (0) or right (1) eye in world space."""
    return np.array([(-0.5 + eye) * INTEROCULAR_MM, 0.0, 0.0])
