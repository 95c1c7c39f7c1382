"""Who stands where in the crowd, and how: places, poses and meshes by time. Pure numpy.

Rule of the picture: the camera orbits where a photographer would walk, so nobody may stand there.
The walker and the waver are in front of the face, inside the orbit: the eyes reflect them, the
picture never shows them (nor the photographer). The bystanders stand beside the main character,
outside the lens's cone to the face from every azimuth: reflected and shown.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.rig import Rig, skin_vertices
from renderer.cache import cached_arrays
from renderer.crowd.figure import BONES, Body, build_body
from renderer.crowd.motion import WALK_SPEED_MM_S, Pose, place, stand, stride_s, walk, wave
from renderer.crowd.occlusion import cone_directions, openness, visibility
from renderer.crowd.people import PEOPLE, Person
from renderer.park.panorama import EYE_HEIGHT_M

Floats = npt.NDArray[np.float64]

GROUND_MM: Final = -1000.0 * EYE_HEIGHT_M
PATH_Z_MM: Final = 1500.0  # the walker passes this far in front of the face
PATH_LENGTH_MM: Final = 11000.0  # one turn: he comes again every 8.5 s
CENTRE_S: Final = 2.5  # when the walker first passes the face: amid a five-second clip
_SPHERES_PER_BONE: Final = 4
SKY_DIRECTIONS: Final = 32
SUN_RADIUS_RAD: Final = 0.05  # softer than the real 0.005, which vertex values cannot carry
_FLOAT_FIELDS: Final = ("positions_mm", "normals", "surface", "weights", "heads_mm", "tails_mm")
_WHOLE_FIELDS: Final = ("bones", "triangles", "outline", "parents")


@dataclass(frozen=True)
class Member:
    """A place in the crowd: azimuth (0 before the face, positive to the viewer's right), distance.

    ``heading_deg`` is where the character looks, 0 the way the main character looks.
    """

    person: Person
    action: str
    azimuth_deg: float = 0.0
    distance_mm: float = 0.0
    heading_deg: float = 0.0
    is_shown: bool = True


# Shown members come last: the picture draws the tail of the buffer.
STAGE: Final = (
    Member(PEOPLE[0], "walk", heading_deg=90.0, is_shown=False),
    Member(PEOPLE[1], "wave", 24.0, 1080.0, heading_deg=-158.0, is_shown=False),
    Member(PEOPLE[2], "stand", -86.0, 980.0, heading_deg=16.0),
    Member(PEOPLE[3], "stand", 98.0, 1020.0, heading_deg=-14.0),
    Member(PEOPLE[4], "stand", 83.0, 2000.0, heading_deg=-24.0),
)


@dataclass(frozen=True)
class Figure:
    """A member with its mesh, and where its vertices lie in the crowd's buffers."""

    member: Member
    body: Body
    first_vertex: int
    seed: int

    @functools.cached_property
    def stride(self) -> float:
        """Duration of a stride in seconds."""
        rig = self.body.rig
        leg = rig.heads_mm[rig.index("thigh_l")] - rig.heads_mm[rig.index("foot_l")]
        return stride_s(float(np.linalg.norm(leg)))

    @functools.cached_property
    def spheres(self) -> tuple[Floats, Floats, npt.NDArray[np.int64]]:
        """Spheres at rest that hold the mesh: centres (k, 3), radii (k,), their bones (k,)."""
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
                radii.append(distance[nearest == number, number].max() + 25.0)
                bones.append(bone)
        return np.array(centres), np.array(radii), np.array(bones)

    def carry_spheres(self, transforms: Floats) -> Floats:
        """Return the spheres' centres (k, 3) in a pose."""
        centres, _, bones = self.spheres
        turned = np.einsum("kij,kj->ki", transforms[bones, :3, :3], centres)
        return np.asarray(turned + transforms[bones, :3, 3])

    def bones(self, time_s: float) -> Floats:
        """Return the world transforms (b, 4, 4) of the bones at a time, in mm."""
        return place(self.body.rig, self.pose(time_s), ground_y_mm=GROUND_MM)

    def pose(self, time_s: float) -> Pose:
        """Return the member's pose and place at a time."""
        member, rig = self.member, self.body.rig
        if member.action == "walk":
            along = WALK_SPEED_MM_S * (time_s - CENTRE_S) + PATH_LENGTH_MM / 2
            x_mm = along % PATH_LENGTH_MM - PATH_LENGTH_MM / 2
            turns = walk(rig, time_s, stride=self.stride)
            return Pose(turns, x_mm, PATH_Z_MM, member.heading_deg)
        azimuth = np.radians(member.azimuth_deg)
        x_mm, z_mm = member.distance_mm * np.sin(azimuth), member.distance_mm * np.cos(azimuth)
        act = wave if member.action == "wave" else stand
        turns = act(rig, time_s, seed=self.seed)
        return Pose(turns, float(x_mm), float(z_mm), member.heading_deg)


def light_shares(figure: Figure, sun: Floats) -> Floats:
    """Return (n, 2): openness to the sky and visibility of the sun, in the pose at time 0."""
    key = f"crowd light {figure.member} {np.round(sun, 6).tolist()}"
    shares = cached_arrays(key, lambda: {"shares": _light_shares(figure, sun)})["shares"]
    return shares.astype(np.float64)


def _light_shares(figure: Figure, sun: Floats) -> Floats:
    body = figure.body
    full = np.zeros((len(body.positions_mm), len(BONES)))
    np.add.at(full, (np.arange(len(full))[:, None], body.bones), body.weights)
    transforms = figure.bones(0.0)
    positions = skin_vertices(body.positions_mm, transforms, weights=full)
    turns = transforms.copy()
    turns[:, :3, 3] = 0.0
    normals = skin_vertices(body.normals, turns, weights=full)
    sky = openness(positions, normals, triangles=body.triangles, count=SKY_DIRECTIONS)
    towards = cone_directions(sun, angle_rad=SUN_RADIUS_RAD)
    lit = visibility(positions, body.triangles, directions=towards).mean(axis=1)
    return np.stack([sky, lit], axis=1)


def build_figures(members: tuple[Member, ...]) -> tuple[Figure, ...]:
    """Return the members with their meshes, numbered for shared buffers."""
    figures: list[Figure] = []
    first = 0
    for seed, member in enumerate(members):
        body = cached_body(member.person)
        figures.append(Figure(member, body, first, seed))
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
        rig=rig,
    )


def _body_arrays(body: Body) -> dict[str, npt.NDArray[np.generic]]:
    names = (*_FLOAT_FIELDS, *_WHOLE_FIELDS)
    return {name: getattr(body if hasattr(body, name) else body.rig, name) for name in names}
