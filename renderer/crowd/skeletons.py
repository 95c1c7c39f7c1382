"""Skeletons of many figures posed at once: the same bones, one row per figure. Pure numpy.

Numpy's calls cost more than their arithmetic here, so every step takes all figures together.
Rotations are in world axes about a bone's head, relative to its parent (``renderer.body.rig``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from renderer.body.rig import Rig

Floats = npt.NDArray[np.float64]
Turns = dict[str, Floats]  # by bone (f, 3, 3); absent ones stay


@dataclass(frozen=True)
class Skeletons:
    """Figures' joints: ``heads_mm``, ``tails_mm`` (f, b, 3); bones as in ``renderer.body.rig``."""

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
            np.stack([rig.heads_mm for rig in rigs]),
            np.stack([rig.tails_mm for rig in rigs]),
        )

    def pick(self, rows: Sequence[int]) -> Skeletons:
        """Return some of the figures."""
        chosen = list(rows)
        return Skeletons(self.names, self.parents, self.heads_mm[chosen], self.tails_mm[chosen])

    def index(self, bone: str) -> int:
        """Return a bone's number."""
        return self.names.index(bone)

    def head(self, bone: str) -> Floats:
        """Return where a bone begins at rest, (f, 3)."""
        return np.asarray(self.heads_mm[:, self.index(bone)])

    def along(self, bone: str) -> Floats:
        """Return the way from a bone's joint to its first child's, or to its end, (f, 3)."""
        number = self.index(bone)
        children = [row for row, parent in enumerate(self.parents) if parent == number]
        end = self.heads_mm[:, children[0]] if children else self.tails_mm[:, number]
        return np.asarray(end - self.heads_mm[:, number])

    def frame(self, turns: Mapping[str, Floats], bone: str) -> Floats:
        """Return a bone's rotation in the body frame, (f, 3, 3)."""
        number = self.index(bone)
        turn = np.broadcast_to(np.eye(3), (len(self.heads_mm), 3, 3))
        while number >= 0:
            if self.names[number] in turns:
                turn = turns[self.names[number]] @ turn
            number = self.parents[number]
        return turn

    def posed(self, turns: Mapping[str, Floats]) -> Floats:
        """Return the transforms (f, b, 4, 4) that carry bones from rest to a pose."""
        count = len(self.heads_mm)
        transforms = np.zeros((count, len(self.names), 4, 4))
        transforms[..., 3, 3] = 1.0
        rotations, shifts = transforms[..., :3, :3], transforms[..., :3, 3]
        for bone, parent in enumerate(self.parents):
            turn = turns.get(self.names[bone])
            if parent < 0:
                rotations[:, bone] = np.eye(3)
            else:
                rotations[:, bone], shifts[:, bone] = rotations[:, parent], shifts[:, parent]
            if turn is not None:
                head = self.heads_mm[:, bone]
                moved = head - applied(turn, head)
                shifts[:, bone] += applied(rotations[:, bone], moved)
                rotations[:, bone] = rotations[:, bone] @ turn
        return transforms


def applied(turn: Floats, vectors: Floats) -> Floats:
    """Return vectors (f, 3) turned by rotations (f, 3, 3), row by row."""
    return np.asarray((turn @ vectors[..., None])[..., 0])


def turns_about(axis: npt.ArrayLike, angle_deg: npt.ArrayLike) -> Floats:
    """Return rotations (f, 3, 3) about one axis or one per row, by angles (f,) in degrees."""
    angle = np.radians(np.atleast_1d(np.asarray(angle_deg, dtype=float)))
    along = np.broadcast_to(np.asarray(axis, dtype=float), (len(angle), 3))
    x, y, z = (along / np.linalg.norm(along, axis=1, keepdims=True)).T
    cross = np.zeros((len(angle), 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -z, y, -x
    cross[:, 1, 0], cross[:, 2, 0], cross[:, 2, 1] = z, -y, x
    sine, cosine = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.asarray(np.eye(3) + sine * cross + (1 - cosine) * (cross @ cross))


def shortest_turns(start: Floats, end: Floats) -> Floats:
    """Return rotations (f, 3, 3) that carry directions (f, 3) into others the shortest way."""
    a = start / np.linalg.norm(start, axis=1, keepdims=True)
    b = end / np.linalg.norm(end, axis=1, keepdims=True)
    axis = np.cross(a, b)
    sine = np.linalg.norm(axis, axis=1)
    is_still = sine < 1e-9
    axis[is_still] = [0.0, 0.0, 1.0]
    angle = np.degrees(np.arctan2(sine, np.einsum("fk,fk->f", a, b)))
    return turns_about(axis, np.where(is_still, 0.0, angle))
