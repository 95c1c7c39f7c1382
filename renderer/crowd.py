"""The five other characters: one walks past, one waves, three stand to the side.

Rule of the picture: the camera orbits where a photographer would walk, so nobody may stand there.
The walker and the waver are in front of the face, inside the orbit: the eyes reflect them, the
picture never shows them (nor the photographer). The bystanders stand beside the main character,
outside the lens's cone to the face from every azimuth: reflected and shown.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.cache import cached_arrays
from renderer.clip import ClipSpec
from renderer.figure import BONES, Body, build_body
from renderer.light import Light
from renderer.motion import WALK_SPEED_MM_S, Pose, place, stand, stride_s, walk, wave
from renderer.occlusion import cone_directions, openness, visibility
from renderer.panorama import EYE_HEIGHT_M
from renderer.people import PEOPLE, Person
from renderer.program import assemble, build_program
from renderer.rig import Rig, skin_vertices

Floats = npt.NDArray[np.float64]

GROUND_MM: Final = -1000.0 * EYE_HEIGHT_M
PATH_Z_MM: Final = 1500.0  # the walker passes this far in front of the face
PATH_LENGTH_MM: Final = 11000.0  # one turn: he comes again every 8.5 s
CENTRE_S: Final = 2.5  # when the walker first passes the face: amid a five-second clip
_FLOAT_FIELDS: Final = ("positions_mm", "normals", "surface", "weights", "heads_mm", "tails_mm")
_WHOLE_FIELDS: Final = ("bones", "triangles", "parents")
SKY_DIRECTIONS: Final = 48
SUN_RADIUS_RAD: Final = 0.05  # softer than the real 0.005, which vertex values cannot carry


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


class Crowd:
    """The crowd of a clip. Poses follow from time alone; ``draw`` shows the bystanders."""

    def __init__(self, gl: moderngl.Context, spec: ClipSpec, light: Light) -> None:
        self.gl = gl
        self.light = light
        self.figures = _figures(STAGE if spec.crowd else ())
        self._time_s: float | None = None
        self._bones: list[Floats] = []
        if self.figures:
            self._make_buffers()

    def pose(self, time_s: float) -> None:
        """Skin everybody for a time; does nothing when they already stand so."""
        if time_s != self._time_s:
            self._bones = [figure.bones(time_s) for figure in self.figures]
            for figure, transforms in zip(self.figures, self._bones, strict=True):
                self._skin(figure, transforms)
            self._time_s = time_s

    def joints_mm(self) -> list[Floats]:
        """Return each figure's joints, heads and tails of all bones, (2b, 3) in world space."""
        return [
            posed_joints(figure.body.rig, transforms)
            for figure, transforms in zip(self.figures, self._bones, strict=True)
        ]

    def draw(
        self,
        *,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
        camera_mm: npt.NDArray[np.floating],
        time_s: float,
    ) -> None:
        """Draw the bystanders into the picture (see the rule above)."""
        if not self.figures:
            return
        self.pose(time_s)
        shown = [number for number, figure in enumerate(self.figures) if figure.member.is_shown]
        self.gl.disable(moderngl.CULL_FACE)  # hair and hems are open shells
        self.draw_figures(
            shown, view_matrix=view_matrix, projection=projection, camera_mm=camera_mm
        )
        self.gl.enable(moderngl.CULL_FACE)

    def draw_figures(
        self,
        numbers: list[int],
        *,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
        camera_mm: npt.NDArray[np.floating],
    ) -> None:
        """Draw figures by number in the pose of the last ``pose``, without changing state."""
        self._program.set(
            u_view_matrix=view_matrix,
            u_projection=projection,
            u_camera_mm=camera_mm,
            **self.light.uniforms(),
        )
        for number in numbers:
            first, count = self._index_ranges[number]
            self._vertices.render(moderngl.TRIANGLES, vertices=count, first=first)

    def draw_shadows(
        self,
        numbers: list[int],
        *,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
    ) -> None:
        """Draw the figures' shadows on the ground as premultiplied coverage."""
        self._shadow.set(
            u_view_matrix=view_matrix,
            u_projection=projection,
            u_sun_direction=self.light.sky.sun_direction,
            u_ground_mm=GROUND_MM,
            u_shade=self._sun_share(),
        )
        for number in numbers:
            first, count = self._index_ranges[number]
            self._shadow_vertices.render(moderngl.TRIANGLES, vertices=count, first=first)

    def _sun_share(self) -> float:
        """Return the share of the sun in the light on level ground (green channel)."""
        sky = self.light.sky
        sun = float(sky.sun_irradiance[1] * max(sky.sun_direction[1], 0.0))
        # Upward irradiance from the first coefficients: Ramamoorthi and Hanrahan 2001, eq. 13.
        ambient = float(0.886227 * sky.ambient_sh[0, 1] + 1.023328 * sky.ambient_sh[1, 1])
        return sun / max(sun + ambient, 1e-6)

    def _skin(self, figure: Figure, transforms: Floats) -> None:
        number = self.figures.index(figure)
        matrices = np.swapaxes(transforms, 1, 2).astype(np.float32)
        bones = self._pose_program["u_bones"]
        bones.write(np.ascontiguousarray(matrices).tobytes())  # type: ignore[union-attr]  # a plain uniform
        self._rest[number].transform(
            self._posed, moderngl.POINTS, buffer_offset=figure.first_vertex * 24
        )

    def _make_buffers(self) -> None:
        gl = self.gl
        self._pose_program = gl.program(
            vertex_shader=assemble("crowd_pose.vert").text, varyings=("p_world", "n_world")
        )
        self._program = build_program(gl, "crowd.vert", fragment="crowd.frag")
        self._shadow = build_program(gl, "crowd_shadow.vert", fragment="crowd_shadow.frag")
        bodies = [figure.body for figure in self.figures]
        total = sum(len(body.positions_mm) for body in bodies)
        self._posed = gl.buffer(reserve=total * 24)
        self._rest = [self._rest_vertices(body) for body in bodies]
        fixed = [np.hstack([f.body.surface, self._light_shares(f)]) for f in self.figures]
        surfaces = gl.buffer(np.concatenate(fixed).astype(np.float32).tobytes())
        indices = gl.buffer(
            np.concatenate([f.body.triangles + f.first_vertex for f in self.figures])
            .astype(np.int32)
            .tobytes()
        )
        self._vertices = gl.vertex_array(
            self._program.gl_program,
            [
                (self._posed, "3f 3f", "p_world", "n_world"),
                (surfaces, "4f 2f", "in_surface", "in_light"),
            ],
            indices,
        )
        self._shadow_vertices = gl.vertex_array(
            self._shadow.gl_program, [(self._posed, "3f 3x4", "p_world")], indices
        )
        counts = [body.triangles.size for body in bodies]
        starts = np.cumsum([0, *counts])
        self._index_ranges = [(int(a), int(n)) for a, n in zip(starts, counts, strict=False)]

    def _rest_vertices(self, body: Body) -> moderngl.VertexArray:
        rows = np.hstack([body.positions_mm, body.normals, body.bones, body.weights])
        buffer = self.gl.buffer(rows.astype(np.float32).tobytes())
        names = ("in_position", "in_normal", "in_bones", "in_weights")
        return self.gl.vertex_array(self._pose_program, [(buffer, "3f 3f 4f 4f", *names)])

    def _light_shares(self, figure: Figure) -> Floats:
        """Return (n, 2): openness to the sky and visibility of the sun, in the pose at time 0."""
        sun = self.light.sky.sun_direction
        key = f"crowd light {figure.member} {np.round(sun, 6).tolist()}"
        return cached_arrays(key, lambda: {"shares": _light_shares(figure, sun)})["shares"].astype(
            np.float64
        )


def posed_joints(rig: Rig, transforms: Floats) -> Floats:
    """Return where transforms (b, 4, 4) carry the heads and tails of bones, (2b, 3)."""
    ends = np.stack([rig.heads_mm, rig.tails_mm], axis=1)
    posed = np.einsum("bij,bkj->bki", transforms[:, :3, :3], ends) + transforms[:, None, :3, 3]
    return np.asarray(posed.reshape(-1, 3))


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


def _figures(members: tuple[Member, ...]) -> tuple[Figure, ...]:
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
        rig=rig,
    )


def _body_arrays(body: Body) -> dict[str, npt.NDArray[np.generic]]:
    names = (*_FLOAT_FIELDS, *_WHOLE_FIELDS)
    return {name: getattr(body if hasattr(body, name) else body.rig, name) for name in names}
