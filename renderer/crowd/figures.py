"""Members of the crowd with their meshes, and everybody's bones at a time. Pure numpy."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.crowd.figure import BONES, Body
from renderer.crowd.gait import stride_s
from renderer.crowd.motion import Places, place, stand, walk, wave
from renderer.crowd.skeletons import Skeletons, Turns, turns_about
from renderer.crowd.stage import GROUND_MM, Member

Floats = npt.NDArray[np.float64]

_SPHERES_PER_BONE: Final = 4


@dataclass(frozen=True)
class Figure:
    """A member with its mesh, and where its vertices lie in the crowd's buffers.

    The mesh is of the size of the member's body; ``scale`` makes it as tall as the person.
    ``is_awake`` where its lids are raised for real eyes.
    """

    member: Member
    body: Body
    first_vertex: int
    seed: int
    scale: float = 1.0
    is_awake: bool = False

    @functools.cached_property
    def stride(self) -> float:
        """Duration of a stride in seconds."""
        rig = self.body.rig
        leg = rig.heads_mm[rig.index("thigh_l")] - rig.heads_mm[rig.index("foot_l")]
        return stride_s(self.scale * float(np.linalg.norm(leg)))

    @functools.cached_property
    def spheres(self) -> tuple[Floats, Floats, npt.NDArray[np.int64]]:
        """Spheres at rest that hold the mesh: centres (k, 3), posed radii (k,), bones (k,)."""
        body, rig = self.body, self.body.rig
        share = np.linspace(0.0, 1.0, _SPHERES_PER_BONE)[:, None]
        owner = body.bones[:, 0]  # the strongest bone of each vertex
        centres, radii, bones = [], [], []
        for bone in np.unique(owner):
            places = body.positions_mm[owner == bone]
            along = rig.heads_mm[bone] + share * (rig.tails_mm[bone] - rig.heads_mm[bone])
            distance = np.linalg.norm(places[:, None] - along[None], axis=2)
            nearest = distance.argmin(axis=1)
            for number in np.unique(nearest):
                centres.append(along[number])
                # Blending with other bones moves a vertex a little out of its own bone's sphere.
                reach = distance[nearest == number, number].max() + 25.0
                radii.append(self.scale * reach)
                bones.append(bone)
        return np.array(centres), np.array(radii), np.array(bones)

    def carry_spheres(self, transforms: Floats) -> Floats:
        """Return the spheres' centres (k, 3) in a pose."""
        centres, _, bones = self.spheres
        turned = np.einsum("kij,kj->ki", transforms[bones, :3, :3], centres)
        return np.asarray(turned + transforms[bones, :3, 3])

    def bones(self, time_s: float) -> Floats:
        """Return the world transforms (b, 4, 4) of the bones at a time, in mm."""
        return np.asarray(Troupe((self,)).bones(time_s)[0])


class Troupe:
    """Figures that are posed together: ``bones(time_s)``."""

    def __init__(self, figures: Sequence[Figure]) -> None:
        self.figures = tuple(figures)
        if not figures:
            return
        skeletons = Skeletons.of([figure.body.rig for figure in figures])
        actions = [figure.member.action for figure in figures]
        self._groups = [
            (rows, skeletons.pick(rows), ACTIONS[action])
            for action in dict.fromkeys(actions)
            for rows in [[row for row, other in enumerate(actions) if other == action]]
        ]

    def bones(self, time_s: float) -> Floats:
        """Return everybody's world transforms (f, b, 4, 4) at a time, in mm."""
        found = np.empty((len(self.figures), len(BONES), 4, 4))
        if self.figures:
            for rows, skeletons, act in self._groups:
                chosen = [self.figures[row] for row in rows]
                turns = _bowed(chosen, act(chosen, skeletons, time_s))
                places = _places(chosen, time_s)
                found[rows] = place(skeletons, turns, places, ground_y_mm=GROUND_MM)
        return found


Act = Callable[[Sequence[Figure], Skeletons, float], Turns]


def _walk(figures: Sequence[Figure], skeletons: Skeletons, time_s: float) -> Turns:
    return walk(skeletons, time_s, strides=np.array([figure.stride for figure in figures]))


def _stand(figures: Sequence[Figure], skeletons: Skeletons, time_s: float) -> Turns:
    return stand(skeletons, time_s, seeds=tuple(figure.seed for figure in figures))


def _wave(figures: Sequence[Figure], skeletons: Skeletons, time_s: float) -> Turns:
    return wave(skeletons, time_s, seeds=tuple(figure.seed for figure in figures))


ACTIONS: Final[dict[str, Act]] = {"walk": _walk, "stand": _stand, "wave": _wave}


def _bowed(figures: Sequence[Figure], turns: Turns) -> Turns:
    """Bow or raise the heads of those who look down or up, from the neck on."""
    nod = np.array([figure.member.nod_deg for figure in figures])
    if not nod.any():
        return turns
    half = turns_about([1.0, 0.0, 0.0], nod / 2)
    bowed = {bone: turns[bone] @ half if bone in turns else half for bone in ("neck_01", "head")}
    return turns | bowed


def _places(figures: Sequence[Figure], time_s: float) -> Places:
    where = np.array([figure.member.place_mm(time_s) for figure in figures])
    return Places(
        x_mm=where[:, 0],
        z_mm=where[:, 1],
        heading_deg=np.array([figure.member.heading_deg for figure in figures]),
        scale=np.array([figure.scale for figure in figures]),
    )
