"""The space of the lids' patches: around one eye, temple at +x, in mm. Pure numpy."""

from __future__ import annotations

import numpy as np

from renderer.body.makehuman import Floats
from renderer.eye.place import eye_centre_mm


def to_world(points: Floats, eye: int) -> Floats:
    """Carry patch space (temple at +x) of the viewer's left (0) or right (1) eye to world."""
    return np.asarray(points * [1.0 if eye else -1.0, 1.0, 1.0] + eye_centre_mm(eye))


def to_patch(points: Floats, eye: int) -> Floats:
    """Carry world space to patch space."""
    return np.asarray((points - eye_centre_mm(eye)) * [1.0 if eye else -1.0, 1.0, 1.0])
