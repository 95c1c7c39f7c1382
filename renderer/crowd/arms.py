"""Arms of the crowd: hanging from the shoulders, or the right one raised to wave. Pure numpy.

Body frame: +x the character's left, +y up, +z forwards.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from renderer.crowd.skeletons import Skeletons
from renderer.crowd.turns import Floats, Hinges, Pointers, applied, applied_back, unit

# Sideways of a step down: upper arm and forearm, of the left and the right.
_OUT: Final = np.array([[[0.17], [-0.17]], [[0.02], [-0.02]]])
_SHARE: Final = 1.0 / np.sqrt(1.0 + _OUT**2)
# From little to index finger of the right hand, in the base mesh's rest pose.
_THUMB_SIDE: Final = np.array([0.393, 0.419, 0.818])
_LEANING: Final = Hinges([0.0, 0.0, 1.0])


class HangingArms:
    """Both arms of figures as they hang and swing; ``elbows_deg`` (f,) are bent so far."""

    def __init__(self, skeletons: Skeletons, elbows_deg: Floats) -> None:
        self._elbows_deg = elbows_deg
        self._out = np.repeat(_SHARE * _OUT, len(elbows_deg), axis=2)
        self._upper, self._lower = (
            Pointers(np.stack([skeletons.along(f"{part}_{side}") for side in "lr"]))
            for part in ("upperarm", "lowerarm")
        )

    def turns(self, swing_deg: Floats) -> tuple[Floats, Floats]:
        """Return the turns of upper arms and forearms, (2, f, 3, 3) each, left and right.

        ``swing_deg`` (2, f) is how far they are swung forwards.
        """
        bent = swing_deg + self._elbows_deg + 0.6 * np.maximum(swing_deg, 0.0)
        angle = np.radians([swing_deg, bent])
        down, ahead = -_SHARE * np.cos(angle), _SHARE * np.sin(angle)
        upper_along, lower_along = np.stack([self._out, down, ahead], axis=-1)
        upper = self._upper.towards(upper_along)
        return upper, self._lower.towards(applied_back(upper, lower_along))


class WavingArms:
    """The right arms of figures as they wave."""

    def __init__(self, skeletons: Skeletons) -> None:
        self._upper = Pointers(skeletons.along("upperarm_r"))
        self._lower = Pointers(skeletons.along("lowerarm_r"))
        along = unit(skeletons.along("lowerarm_r"))
        self._forearm = Hinges(along)
        thumb = unit(_THUMB_SIDE - (along @ _THUMB_SIDE)[:, None] * along)
        self._thumb_and_palm = np.stack([thumb, np.cross(along, thumb)], axis=1)

    def turns(self, beat: float, shoulders: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the turns (f, 3, 3) of upper arm, forearm and hand.

        ``beat`` is where the forearm is, -1 to 1, ``shoulders`` (f, 3, 3) what turns with the body
        and the collar bone.
        """
        lean = math.radians(28.0 * beat - 4.0)
        along = [
            [-0.80, -0.42 + 0.05 * beat, 0.42],
            [-math.sin(lean), math.cos(lean), 0.22],
        ]
        in_shoulder = unit(np.array(along)) @ shoulders
        upper = self._upper.towards(in_shoulder[:, 0])
        lower = self._lower.towards(applied_back(upper, in_shoulder[:, 1]))
        forearms = shoulders @ upper @ lower
        # Palm forwards, the right thumb points to the character's left.
        left = forearms[:, 0]
        palm = self._forearm.turns_of(*unit(applied(self._thumb_and_palm, left)).T)
        lag = _LEANING.turns(np.radians(-10.0 * beat))
        return upper, lower, palm @ forearms.swapaxes(1, 2) @ lag @ forearms
