"""Members of the crowd with their meshes, and everybody's bones at a time. Pure numpy."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.rig import Rig
from renderer.cache import cached_arrays
from renderer.crowd.cast import TEMPLATES
from renderer.crowd.figure import BONES, Body, build_body
from renderer.crowd.gait import stride_s
from renderer.crowd.motion import Places, place, stand, walk, wave
from renderer.crowd.people import Person
from renderer.crowd.recolour import recoloured
from renderer.crowd.skeletons import Skeletons, Turns, turns_about
from renderer.crowd.sockets import awake
from renderer.crowd.stage import GROUND_MM, Member

Floats = npt.NDArray[np.float64]

_SPHERES_PER_BONE: Final = 4
_FLOAT_FIELDS: Final = ("positions_mm", "normals", "surface", "weights", "heads_mm", "tails_mm")
_WHOLE_FIELDS: Final = ("bones", "triangles", "outline", "parts", "parents")


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


def build_figures(members: Sequence[Member], *, is_awake: bool = False) -> tuple[Figure, ...]:
    """Return the members with their meshes, numbered for shared buffers."""
    worn = dict.fromkeys(member.person.body for member in members)
    bodies = {name: cached_body(TEMPLATES[name]) for name in worn}
    if is_awake:
        bodies = {name: awake(body) for name, body in bodies.items()}
    figures: list[Figure] = []
    first = 0
    for seed, member in enumerate(members):
        template = TEMPLATES[member.person.body]
        body = recoloured(bodies[template.name], template, person=member.person)
        scale = member.person.stature_mm / template.stature_mm
        figures.append(Figure(member, body, first, seed, scale, is_awake))
        first += len(body.positions_mm)
    return tuple(figures)


def cached_body(person: Person) -> Body:
    """Return a person's mesh from the disk cache, or build and keep it."""
    kept = cached_arrays(f"crowd body {person}", lambda: _body_arrays(build_body(person)))
    floats = {name: kept[name].astype(np.float64) for name in _FLOAT_FIELDS}
    whole = {name: kept[name].astype(np.int64) for name in _WHOLE_FIELDS}
    # Bodies are skinned by their four strongest bones, so the rig needs no weights of its own.
    rig = Rig(
        BONES,
        whole.pop("parents"),
        floats.pop("heads_mm"),
        floats.pop("tails_mm"),
        np.zeros((0, len(BONES)), dtype=np.float32),
    )
    return Body(
        positions_mm=floats["positions_mm"],
        normals=floats["normals"],
        surface=floats["surface"],
        weights=floats["weights"],
        bones=whole["bones"],
        triangles=whole["triangles"],
        outline=whole["outline"],
        parts=whole["parts"],
        rig=rig,
    )


def _body_arrays(body: Body) -> dict[str, npt.NDArray[np.generic]]:
    names = (*_FLOAT_FIELDS, *_WHOLE_FIELDS)
    return {name: getattr(body if hasattr(body, name) else body.rig, name) for name in names}
