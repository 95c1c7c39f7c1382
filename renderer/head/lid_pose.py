"""How the lids of one eye stand: which way the eye looks and how far they are shut. Pure numpy.

Patch space is head space around one eye with the temple at +x, whichever eye it is: millimetres,
origin at the globe's centre, +z straight ahead, +y up. It does not turn with the gaze.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.clip import ClipSpec
from renderer.eye.anatomy import APEX_MM

# Share of the cornea's way up and down that each lid goes along with: from 9.7 mm straight ahead
# the fissure narrows to about 6.5 mm at 40 degrees of downgaze.
UPPER_FOLLOWS: Final = 0.75
LOWER_FOLLOWS: Final = 0.4
SIDEWAYS_FOLLOWS: Final = 0.12  # the bulge of the cornea draws the lids' highest points along
LOWER_RISES_MM: Final = 0.9  # of the lower lid while the eye shuts ...
LOWER_GOES_NASAL_MM: Final = 1.4  # ... most of its way goes towards the nose


@dataclass(frozen=True)
class LidPose:
    """One eye's gaze in patch space, positive towards the temple and up, and its blink, 0 to 1."""

    turn_deg: float = 0.0
    pitch_deg: float = 0.0
    blink: float = 0.0

    @property
    def gaze(self) -> Floats:
        """Unit vector (3,) of the gaze in patch space."""
        turn, pitch = math.radians(self.turn_deg), math.radians(self.pitch_deg)
        return np.array(
            [math.sin(turn) * math.cos(pitch), math.sin(pitch), math.cos(turn) * math.cos(pitch)]
        )

    @property
    def corneal_shift_mm(self) -> tuple[float, float]:
        """How far the cornea's apex has moved in the frontal plane."""
        return APEX_MM * float(self.gaze[0]), APEX_MM * float(self.gaze[1])

    def turned_to_eye(self, points: Floats) -> Floats:
        """Carry patch space (..., 3) into the frame that turns with the gaze, x to the temple."""
        forward = self.gaze
        turn = math.radians(self.turn_deg)
        right = np.array([math.cos(turn), 0.0, -math.sin(turn)])
        return np.asarray(points @ np.column_stack([right, np.cross(forward, right), forward]))


STRAIGHT: Final = LidPose()


def lid_poses(spec: ClipSpec) -> tuple[LidPose, LidPose]:
    """Return how the lids of the viewer's left and right eye stand in a clip."""
    yaw_left, pitch_left = spec.gaze_deg(0)
    yaw_right, pitch_right = spec.gaze_deg(1)
    return (
        LidPose(-yaw_left, pitch_left, spec.blink),
        LidPose(yaw_right, pitch_right, spec.blink),
    )
