"""What the lids leave open of the globe, counted as a camera sees it: patch, corners and globe."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from renderer.eye.geometry import eye_mesh
from renderer.eye.model import gaze_rotation
from renderer.eye.place import eye_centre_mm
from renderer.gl.program import Program, build_program
from renderer.head.face_mesh import face_mesh
from renderer.head.lid_pose import LidPose
from renderer.head.skin_part import SkinPart
from renderer.view import Matrix, look_at, perspective

SIZE = (128, 128)


def view(azimuth_deg: float, elevation_deg: float) -> Matrix:
    azimuth, elevation = np.radians([azimuth_deg, elevation_deg])
    towards = [np.sin(azimuth) * np.cos(elevation), np.sin(elevation), np.cos(azimuth)]
    place = eye_centre_mm(1) + 170.0 * np.array(towards)
    return perspective(14.0, 1.0, 80.0, 400.0) @ look_at(place, eye_centre_mm(1))


def picture(gl: moderngl.Context, pose: LidPose, matrix: Matrix) -> np.ndarray:
    """Return which pixels (h, w) show the globe of the viewer's right eye, rows from below."""
    face = face_mesh((pose, pose))
    program = build_program(gl, "depth.vert", fragment="depth.frag")
    program.set(u_world_to_clip=matrix)
    depth = gl.depth_texture(SIZE)
    target = gl.framebuffer(depth_attachment=depth)
    target.use()
    target.clear(depth=1.0)
    gl.enable_only(moderngl.DEPTH_TEST)
    for part in (face.patches[1], face.corners[1]):
        _draw(gl, program, part.points_mm, part.triangles[_solid(part)])
    skin = np.frombuffer(depth.read(), np.float32).reshape(SIZE)
    globe = eye_mesh(2000)
    turned = globe.positions @ gaze_rotation(pose.turn_deg, pose.pitch_deg).T
    _draw(gl, program, turned + eye_centre_mm(1), globe.triangles)
    seen = np.frombuffer(depth.read(), np.float32).reshape(SIZE) < skin
    target.release()
    return seen


def _draw(gl: moderngl.Context, program: Program, points: np.ndarray, corners: np.ndarray) -> None:
    content = (gl.buffer(points.astype(np.float32).tobytes()), "3f", "in_position")
    index = gl.buffer(corners.astype(np.int32).tobytes())
    gl.vertex_array(program.gl_program, [content], index).render()


def _solid(part: SkinPart) -> np.ndarray:
    """Return the triangles that hide what is behind: all of the lids, corners where they cover."""
    if np.ndim(part.sclera):  # the corners
        return np.asarray(part.lid[part.triangles].min(axis=1) > 0.999)
    return np.ones(len(part.triangles), dtype=bool)


@pytest.mark.parametrize(
    "gaze", [(0.0, 0.0), (30.0, 0.0), (-30.0, 0.0), (0.0, -30.0), (10.0, 20.0)]
)
def test_shut_lids_leave_no_pixel_of_the_eye(
    gl: moderngl.Context, gaze: tuple[float, float]
) -> None:
    for azimuth, elevation in ((0, 0), (45, 0), (-30, 0), (0, 25), (20, -25)):
        seen = picture(gl, LidPose(*gaze, 1.0), view(azimuth, elevation))
        assert not seen.any(), f"{seen.sum()} pixels from {azimuth}, {elevation}"


def test_the_eye_disappears_steadily_while_it_blinks(gl: moderngl.Context) -> None:
    counts = [
        int(picture(gl, LidPose(blink=blink), view(0, 0)).sum())
        for blink in (0, 0.25, 0.5, 0.75, 1)
    ]
    assert counts[0] > 1500
    assert (np.diff(counts) < -100).all()


def test_every_parameter_of_the_pose_moves_the_lids_outline(gl: moderngl.Context) -> None:
    straight = picture(gl, LidPose(), view(0, 0))
    for pose in (LidPose(turn_deg=20.0), LidPose(pitch_deg=15.0), LidPose(pitch_deg=-15.0)):
        seen = picture(gl, pose, view(0, 0))
        changed = (seen != straight).sum()
        assert changed > 20, f"{pose}: {changed} pixels"


def test_the_outline_of_the_open_eye_has_no_notch(gl: moderngl.Context) -> None:
    seen = picture(gl, LidPose(), view(0, 0))
    columns = np.flatnonzero(seen.any(axis=0))[3:-3]
    top = np.array([np.flatnonzero(seen[:, x]).max() for x in columns], dtype=float)
    bottom = np.array([np.flatnonzero(seen[:, x]).min() for x in columns], dtype=float)
    # Against a smooth curve no edge strays by more than a pixel or so (0.3 mm).
    for edge in (top, bottom):
        smooth = np.polynomial.Polynomial.fit(columns, edge, 8)(columns)
        assert np.abs(edge - smooth).max() < 2.0
