"""How the crowd moves: everybody's turns at a time, from what each does. Pure numpy.

Whatever they do (``renderer.crowd.actions``), all of them are computed together.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from renderer.crowd.actions import ACTIONS, MOVING, STAYING, STRIDING, Action, Turn
from renderer.crowd.arms import HangingArms, WavingArms
from renderer.crowd.gait import idling, striding, waving
from renderer.crowd.skeletons import Skeletons
from renderer.crowd.turns import STILL, Floats, Hinges

_TURNS: Final = 2  # of a joint, one after the other
_CHEST_LEAN_DEG: Final = 1.2  # aside, with a waving arm
_LEANING: Final = Hinges([0.0, 0.0, 1.0])
_UPPER_ARMS: Final = ("upperarm_l", "upperarm_r")
_LOWER_ARMS: Final = ("lowerarm_l", "lowerarm_r")
_TORSO: Final = ("pelvis", "spine_01", "spine_03", "clavicle_r")
_RAISED: Final = ("spine_03", "upperarm_r", "lowerarm_r", "hand_r")
_NO_TURN: Final = Turn((1.0, 0.0, 0.0), {})


class Motion:
    """Figures and what each does: ``turns(time_s)``."""

    def __init__(
        self,
        skeletons: Skeletons,
        actions: Sequence[str],
        *,
        strides_s: Floats,
        seeds: Sequence[int],
        bows_deg: Floats,
    ) -> None:
        """``actions`` are of ACTIONS, ``strides_s`` (f,) how long walkers' strides last.

        ``seeds`` tell apart those who stand about; ``bows_deg`` (f,) is how far heads are bowed.
        """
        chosen = [ACTIONS[action] for action in actions]
        is_striding = np.array([action.is_striding for action in chosen])
        self._striding, self._idling = np.flatnonzero(is_striding), np.flatnonzero(~is_striding)
        self._waving = np.flatnonzero([action.is_waving for action in chosen])
        self._strides_s = strides_s[self._striding]
        self._seeds = tuple(seeds[row] for row in self._idling.tolist())
        joints = list(dict.fromkeys(bone for action in chosen for bone in action.turns))
        self._hinges = Hinges(_axes(chosen, joints))
        staying = np.stack([np.ones_like(bows_deg), bows_deg, *_level_legs_deg(skeletons)], axis=1)
        self._still_deg = np.einsum("nfs,fs->nf", _degrees(chosen, joints, STAYING), staying)
        self._moving_deg = _degrees(chosen, joints, MOVING)
        self._arms = HangingArms(skeletons, np.array([action.elbow_deg for action in chosen]))
        self._waving_arms = WavingArms(skeletons.pick(self._waving))
        self._at_rest = np.tile(STILL, (len(skeletons.names), len(chosen), 1, 1))
        self._joints, self._upper, self._lower, self._torso, self._raised = (
            np.array([skeletons.index(bone) for bone in bones])
            for bones in (joints, _UPPER_ARMS, _LOWER_ARMS, _TORSO, _RAISED)
        )

    def turns(self, time_s: float) -> Floats:
        """Return the turns (b, f, 3, 3) of everybody's bones at a time."""
        moved_deg = np.einsum("nfs,fs->nf", self._moving_deg, self._signals(time_s))
        degrees = self._still_deg + moved_deg
        angles = np.radians(degrees[:-2]).reshape(_TURNS, len(self._joints), -1)
        first, second = self._hinges.turns(angles)
        turns = self._at_rest.copy()
        turns[self._joints] = first @ second
        turns[self._upper], turns[self._lower] = self._arms.turns(degrees[-2:])
        if self._waving.size:
            self._raise_arms(turns, waving(time_s))
        return turns

    def _signals(self, time_s: float) -> Floats:
        """Return MOVING (f, s) at a time: 0 where an action does not know them."""
        signals = np.zeros((len(self._striding) + len(self._idling), len(MOVING)))
        if self._striding.size:
            signals[self._striding, : len(STRIDING)] = striding(time_s, self._strides_s)
        if self._idling.size:
            signals[self._idling, len(STRIDING) :] = idling(time_s, self._seeds)
        return signals

    def _raise_arms(self, turns: Floats, beat: float) -> None:
        """Have the right arms of those who wave do so, and their chests lean with them."""
        pelvis, spine, chest, collar = turns[self._torso[:, None], self._waving]
        shoulders = pelvis @ spine @ chest @ collar
        # The chest leans after the arm, which it carries along.
        leaning = chest @ _LEANING.turns(np.radians(_CHEST_LEAN_DEG * beat))
        arm = self._waving_arms.turns(beat, shoulders)
        turns[self._raised[:, None], self._waving] = [leaning, *arm]


def _turn(action: Action, bone: str, place: int) -> Turn:
    turns = action.turns.get(bone, ())
    return turns[place] if place < len(turns) else _NO_TURN


def _axes(actions: Sequence[Action], joints: Sequence[str]) -> Floats:
    """Return what joints turn about, first and second, (2, j, f, 3)."""
    return np.array(
        [
            [[_turn(action, bone, place).axis for action in actions] for bone in joints]
            for place in range(_TURNS)
        ]
    )


def _degrees(actions: Sequence[Action], joints: Sequence[str], signals: Sequence[str]) -> Floats:
    """Return degrees per signal: of first and second turns, then of arms, (2 j + 2, f, s)."""
    rows = [
        [_turn(action, bone, place).degrees for action in actions]
        for place in range(_TURNS)
        for bone in joints
    ]
    rows += [[action.swing[side] for action in actions] for side in range(2)]
    return np.array([[[own.get(name, 0.0) for name in signals] for own in row] for row in rows])


def _level_legs_deg(skeletons: Skeletons) -> list[Floats]:
    """Return what brings legs from their rest stance under the hip, left and right, (f,) each."""
    found = []
    for side in "lr":
        along = skeletons.head(f"foot_{side}") - skeletons.head(f"thigh_{side}")
        found.append(-0.72 * np.degrees(np.arctan2(along[:, 0], -along[:, 1])))
    return found
