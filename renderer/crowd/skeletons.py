"""Skeletons of many figures carried at once: the same bones, one row per figure. Pure numpy.

Rotations are in world axes about a bone's head, relative to its parent (``renderer.body.rig``), but
for the thighs': they hang down from a pelvis that sways, so theirs are relative to the body.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.rig import Rig
from renderer.crowd.turns import Floats, applied

Numbers = npt.NDArray[np.int64]

_FROM_BODY: Final = ("thigh_l", "thigh_r")


@dataclass(frozen=True)
class Skeletons:
    """Figures' joints: ``heads_mm``, ``tails_mm`` (b, f, 3); bones as in ``renderer.body.rig``."""

    names: tuple[str, ...]
    parents: tuple[int, ...]
    heads_mm: Floats
    tails_mm: Floats

    @classmethod
    def of(cls, rigs: Sequence[Rig]) -> Skeletons:
        """Stack rigs; raises ValueError unless all have the same bones."""
        names = {rig.names for rig in rigs}
        if len(names) != 1:
            raise ValueError(f"{len(names)} kinds of skeletons; figures posed together share one")
        return cls(
            rigs[0].names,
            tuple(int(parent) for parent in rigs[0].parents),
            np.stack([rig.heads_mm for rig in rigs], axis=1),
            np.stack([rig.tails_mm for rig in rigs], axis=1),
        )

    def pick(self, rows: Numbers) -> Skeletons:
        """Return some of the figures."""
        return replace(self, heads_mm=self.heads_mm[:, rows], tails_mm=self.tails_mm[:, rows])

    def index(self, bone: str) -> int:
        """Return a bone's number."""
        return self.names.index(bone)

    def head(self, bone: str) -> Floats:
        """Return where a bone begins at rest, (f, 3)."""
        return np.asarray(self.heads_mm[self.index(bone)])

    def along(self, bone: str) -> Floats:
        """Return the way from a bone's joint to its first child's, or to its end, (f, 3)."""
        number = self.index(bone)
        children = [row for row, parent in enumerate(self.parents) if parent == number]
        end = self.heads_mm[children[0]] if children else self.tails_mm[number]
        return np.asarray(end - self.heads_mm[number])

    def carried(self, turns: Floats, bodies: Floats) -> tuple[Floats, Floats]:
        """Carry bones by their turns (b, f, 3, 3), in bodies that are turned and scaled (f, 3, 3).

        Returns the bones' rotations times scale (b, f, 3, 3) and their shifts (b, f, 3) from rest
        to the pose, where the root stays in the origin.
        """
        first, *others = self._levels
        frames = np.empty_like(turns)
        frames[first[0]] = bodies @ turns[first[0]]
        for bones, bases in others:
            frames[bones] = frames[bases] @ turns[bones]
        # A bone's head goes where its parent carries it.
        steps = applied(frames[self._joined_to] - frames, self.heads_mm)
        return frames, (self._ancestry @ steps.reshape(len(steps), -1)).reshape(steps.shape)

    @functools.cached_property
    def _levels(self) -> list[tuple[Numbers, Numbers]]:
        """Bones that are turned together, and those that their turns are relative to."""
        depths: list[int] = []
        for name, parent in zip(self.names, self.parents, strict=True):
            depths.append(0 if parent < 0 or name in _FROM_BODY else depths[parent] + 1)
        levels = [np.flatnonzero(np.equal(depths, depth)) for depth in range(max(depths) + 1)]
        return [(bones, np.array(self.parents)[bones]) for bones in levels]

    @functools.cached_property
    def _joined_to(self) -> Numbers:
        """Every bone's parent; the root has itself."""
        return np.maximum(self.parents, 0)

    @functools.cached_property
    def _ancestry(self) -> Floats:
        """Return (b, b): 1 where a row's bone is the column's or comes after it."""
        found = np.eye(len(self.parents))
        for bone, parent in enumerate(self.parents):
            if parent >= 0:
                found[bone] += found[parent]
        return found
