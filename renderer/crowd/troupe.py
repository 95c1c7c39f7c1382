"""Figures posed together: everybody's bones at a time, feet on the ground. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from renderer.crowd.figure import BONES
from renderer.crowd.figures import Figure
from renderer.crowd.motion import Motion
from renderer.crowd.skeletons import Skeletons
from renderer.crowd.stage import GROUND_MM
from renderer.crowd.turns import Floats, Hinges

_UPRIGHT: Final = Hinges([0.0, 1.0, 0.0])
_FEET: Final = [BONES.index("foot_l"), BONES.index("foot_r")]
_SOLE_MM: Final = 22.0  # below the end of the foot's bone
_HEEL_MM: Final = -35.0  # along +z from where that bone begins
_TOE_MM: Final = 25.0  # and from where it ends


class Troupe:
    """Figures that are posed together: ``bones(time_s)``."""

    def __init__(self, figures: Sequence[Figure]) -> None:
        self.figures = tuple(figures)
        if not figures:
            return
        members = [figure.member for figure in figures]
        self._skeletons = Skeletons.of([figure.body.rig for figure in figures])
        self._motion = Motion(
            self._skeletons,
            [member.action for member in members],
            strides_s=np.array([figure.stride for figure in figures]),
            seeds=[figure.seed for figure in figures],
            bows_deg=np.array([member.nod_deg for member in members]),
        )
        headings = np.radians([member.heading_deg for member in members])
        sizes = np.array([figure.scale for figure in figures])
        self._bodies = sizes[:, None, None] * _UPRIGHT.turns(headings)
        self._soles_mm = _soles_mm(self._skeletons)
        self._places_mm = np.array([member.place_mm(0.0) for member in members])
        self._walkers = [row for row, member in enumerate(members) if member.action == "walk"]

    def bones(self, time_s: float) -> Floats:
        """Return everybody's world transforms (f, b, 4, 4) at a time, in mm."""
        found = np.zeros((len(self.figures), len(BONES), 4, 4))
        if not self.figures:
            return found
        turned, shifts = self._skeletons.carried(self._motion.turns(time_s), self._bodies)
        found[..., :3, :3] = turned.swapaxes(0, 1)
        found[..., :3, 3] = shifts.swapaxes(0, 1) + self._shifts_mm(turned, shifts, time_s)[:, None]
        found[..., 3, 3] = 1.0
        return found

    def _shifts_mm(self, turned: Floats, shifts: Floats, time_s: float) -> Floats:
        """Return what brings bodies to their places, (f, 3): the lower foot meets the ground."""
        heights = np.einsum("sfk,psfk->psf", turned[_FEET, :, 1], self._soles_mm)
        lowest = (heights + shifts[_FEET, :, 1]).min(axis=(0, 1))
        places = self._places_mm.copy()
        for row in self._walkers:
            places[row] = self.figures[row].member.place_mm(time_s)
        return np.column_stack([places[:, 0], GROUND_MM - lowest, places[:, 1]])


def _soles_mm(skeletons: Skeletons) -> Floats:
    """Return heel and toe of both feet at rest, (2 points, 2 feet, f, 3)."""
    heels, toes = skeletons.heads_mm[_FEET], skeletons.tails_mm[_FEET]
    soles = np.stack([heels + [0.0, 0.0, _HEEL_MM], toes + [0.0, 0.0, _TOE_MM]])
    soles[..., 1] = toes[0, :, 1] - _SOLE_MM  # one height for both feet
    return soles
