"""The tear line: water that stands in the corner between the globe and the margin of each lid.

A strip with a hollow face, patch space (see ``lid_pose``). Its shader adds what the water mirrors
and takes away what its edge bends aside; everything else shines through.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, Indices
from renderer.body.normals import unit, vertex_normals
from renderer.body.subdivide import triangles_of
from renderer.gl.program import Program
from renderer.head.lid_fit import LidPatch
from renderer.head.lid_pose import LidPose
from renderer.head.lid_rims import rim, smooth_step
from renderer.head.lid_shell import on_globe
from renderer.head.patch_space import to_world
from renderer.head.strands import PREMULTIPLIED_KEEPING_TARGET, blending
from renderer.textures.noise import noise_1d

# Height on the globe and depth on the margin. Adults' lower meniscus: 0.15 to 0.4 mm high.
LOWER_MM: Final = (0.28, 0.24)
UPPER_MM: Final = (0.16, 0.14)
ENDS_MM: Final = ((-10.6, -9.0), (11.4, 10.2))  # along x: where the line runs dry, where it is full
LIFT_MM: Final = 0.02  # off globe and margin, so that surfaces do not fight
ALONG: Final = 240
ACROSS: Final = 8
# The line is uneven: (length in mm, deviation) of its height, of its surface's tilt along the lid
# and of what its foot gathers. Our estimates from slit-lamp photographs.
HEIGHT_WAVES: Final = ((3.2, 0.16), (0.9, 0.07))
TILT_WAVES: Final = ((1.1, 0.16), (0.45, 0.12))
GLOSS_WAVES: Final = ((2.4, 0.38), (0.7, 0.26))
LEVELS: Final = (0.62, 1.32)  # least and greatest height, of the mean
GLOSSES: Final = (0.08, 1.9)


@dataclass(frozen=True)
class TearStrip:
    """Points (n, 3) in mm, unit normals and tangents along the lid, triangles (m, 3), and per point

    ``across`` from 0 on the globe to 1 on the lid, ``amount`` of water, 0 to 1, and ``gloss``, how
    bright a line it gathers on the lid, about 1.
    """

    points_mm: Floats
    normals: Floats
    tangents: Floats
    triangles: Indices
    across: Floats
    amount: Floats
    gloss: Floats


def tear_strip(lid: LidPatch, *, is_upper: bool) -> TearStrip:
    """Return one lid's tear line in patch space."""
    pose = lid.pose
    shares = np.linspace(0.03, 0.985, ALONG)
    corner = rim(shares, pose, is_upper=is_upper)
    height, depth = UPPER_MM if is_upper else LOWER_MM
    x = corner[:, 0]
    level = np.clip(1.0 + _waves(x, HEIGHT_WAVES, is_upper=is_upper), *LEVELS)
    top = _on_eye(corner, (-height if is_upper else height) * level, pose)
    foot = _on_margin(lid, corner, depth, is_upper=is_upper)
    foot = corner + level[:, None] * (foot - corner)
    t = np.linspace(0.0, 1.0, ACROSS)[None, :, None]
    # A parabola that touches globe and margin: hollow, as surface tension draws it.
    points = (
        (1 - t) ** 2 * top[:, None] + 2 * t * (1 - t) * corner[:, None] + t**2 * foot[:, None]
    ).reshape(-1, 3)
    triangles = _triangles(turned=is_upper)
    tangents = np.repeat(unit(np.gradient(corner, axis=0)), ACROSS, axis=0)
    tilt = np.repeat(_waves(x, TILT_WAVES, is_upper=is_upper), ACROSS)
    normals = unit(vertex_normals(points, triangles) + tilt[:, None] * tangents)
    gloss = np.clip(1.0 + _waves(x, GLOSS_WAVES, is_upper=is_upper), *GLOSSES)
    dry_nose, full_nose = ENDS_MM[0]
    dry_temple, full_temple = ENDS_MM[1]
    amount = smooth_step((x - dry_nose) / (full_nose - dry_nose))
    amount = amount * smooth_step((dry_temple - x) / (dry_temple - full_temple))
    return TearStrip(
        points + LIFT_MM * normals,
        normals,
        tangents,
        triangles,
        np.tile(t[0, :, 0], ALONG),
        np.repeat(amount, ACROSS),
        np.repeat(gloss, ACROSS),
    )


def _waves(x_mm: Floats, waves: tuple[tuple[float, float], ...], *, is_upper: bool) -> Floats:
    """Return uneven numbers (n,) along a lid: noise of the given lengths and deviations."""
    lines = np.full(len(x_mm), int(is_upper))
    parts = [
        deviation * noise_1d(lines, (x_mm / length_mm).astype(np.float32), 31 * number + len(waves))
        for number, (length_mm, deviation) in enumerate(waves)
    ]
    return np.asarray(np.sum(parts, axis=0), dtype=np.float64)


def _on_eye(corner: Floats, height_mm: Floats, pose: LidPose) -> Floats:
    """Return where the water ends on the globe, ``height_mm`` up from the rim."""
    along = np.gradient(corner, axis=0)
    radial = unit(corner)
    up = unit(np.cross(radial, along))
    xy = (corner + height_mm[:, None] * up)[:, :2]
    return np.column_stack([xy, on_globe(xy, pose)])


def _on_margin(lid: LidPatch, corner: Floats, depth_mm: float, *, is_upper: bool) -> Floats:
    """Return where the water ends on the lid's margin, ``depth_mm`` from the inner edge."""
    half = len(lid.points_mm) // 2
    columns = slice(0, half) if is_upper else slice(half, None)
    points, across = lid.points_mm[columns], lid.across_mm[columns]
    foot = np.array(
        [
            [np.interp(depth_mm, way, line[:, axis]) for axis in range(3)]
            for way, line in zip(across, points, strict=True)
        ]
    )
    order = np.argsort(foot[:, 0], kind="stable")
    shift = np.array([np.interp(corner[:, 0], foot[order, 0], foot[order, k]) for k in (1, 2)])
    return np.column_stack([corner[:, 0], *shift])


def _triangles(*, turned: bool) -> Indices:
    i, j = np.meshgrid(np.arange(ALONG - 1), np.arange(ACROSS - 1), indexing="ij")
    first = (i * ACROSS + j).reshape(-1, 1)
    quads = first + np.array([0, 1, ACROSS + 1, ACROSS])
    triangles = triangles_of(quads)
    return np.asarray(triangles[:, ::-1] if turned else triangles)


class TearLine:
    """Both tear lines of one eye on the GPU."""

    def __init__(self, gl: moderngl.Context, program: Program, lid: LidPatch, *, eye: int) -> None:
        self._gl = gl
        self._program = program
        strips = [tear_strip(lid, is_upper=is_upper) for is_upper in (False, True)]
        rows, triangles = [], []
        for number, strip in enumerate(strips):
            side = [1.0 if eye else -1.0, 1.0, 1.0]
            rows.append(
                np.column_stack(
                    [
                        to_world(strip.points_mm, eye),
                        strip.normals * side,
                        strip.tangents * side,
                        strip.across,
                        strip.amount,
                        strip.gloss,
                    ]
                )
            )
            triangles.append(strip.triangles + number * len(strip.points_mm))
        content = gl.buffer(np.concatenate(rows).astype(np.float32).tobytes())
        index = gl.buffer(np.concatenate(triangles).astype(np.int32).tobytes())
        self._array = gl.vertex_array(
            program.gl_program,
            [(content, "3f 3f 3f 3f", "in_position", "in_normal", "in_tangent", "in_water")],
            index,
        )

    def draw(self, **uniforms: npt.ArrayLike | moderngl.Texture) -> None:
        """Draw over what lies behind; the framebuffer's alpha stays as it was."""
        self._program.set(**{"u_share": 1.0, **uniforms})
        with blending(self._gl):
            self._gl.blend_func = PREMULTIPLIED_KEEPING_TARGET
            self._array.render()
