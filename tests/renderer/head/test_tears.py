"""The tear line: where it stands, which way its hollow faces, and that it shines and follows."""

from __future__ import annotations

import moderngl
import numpy as np
import numpy.typing as npt
import pytest

from renderer.gl.program import build_program
from renderer.head.face_mesh import face_mesh
from renderer.head.lid_fit import fit_lids
from renderer.head.lid_pose import STRAIGHT, LidPose
from renderer.head.lid_shell import height_over_globe
from renderer.head.tears import ACROSS, TearLine, TearStrip, tear_strip
from renderer.light import Light, Sky

POSES = (STRAIGHT, LidPose(20.0, -25.0), LidPose(-20.0, 15.0, 0.5))


def strip(pose: LidPose, *, is_upper: bool = False) -> TearStrip:
    return tear_strip(fit_lids(face_mesh().sockets[1], pose), is_upper=is_upper)


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("is_upper", [True, False])
def test_the_line_lies_between_globe_and_margin(pose: LidPose, is_upper: bool) -> None:
    tears = strip(pose, is_upper=is_upper)
    wet = tears.amount > 0.5
    over = height_over_globe(tears.points_mm[wet], pose)
    assert over.min() > -0.005  # where the water ends it touches the globe
    on_globe = tears.across[wet] == 0.0
    assert over[on_globe].max() < 0.12
    assert (over[tears.across[wet] == 1.0] > over[on_globe].max()).mean() > 0.8


def test_the_lower_line_is_as_high_as_a_tear_meniscus() -> None:
    tears = strip(STRAIGHT)
    rows = tears.points_mm.reshape(-1, ACROSS, 3)
    middle = np.abs(rows[:, 0, 0]) < 6.0
    height = np.linalg.norm(rows[middle, 0] - rows[middle, -1], axis=1)
    # Reference: 0.15 to 0.4 mm, here from the globe to the lid.
    assert height.min() > 0.2
    assert height.max() < 0.5


def test_the_hollow_turns_from_the_globes_normal_to_the_lids() -> None:
    tears = strip(STRAIGHT)
    normals = tears.normals.reshape(-1, ACROSS, 3)
    middle = np.abs(tears.points_mm.reshape(-1, ACROSS, 3)[:, 0, 0]) < 6.0
    first, last = normals[middle, 0], normals[middle, -1]
    assert (first[:, 2] > 0.5).all()
    turn = np.degrees(np.arccos(np.clip((first * last).sum(axis=1), -1, 1)))
    assert 30.0 < turn.mean() < 110.0
    assert (last[:, 1] > first[:, 1]).all()  # the lid's side looks up to the sky
    np.testing.assert_allclose(np.linalg.norm(tears.tangents, axis=1), 1.0)


@pytest.mark.parametrize("is_upper", [True, False])
def test_the_line_is_uneven(is_upper: bool) -> None:
    tears = strip(STRAIGHT, is_upper=is_upper)
    rows = tears.points_mm.reshape(-1, ACROSS, 3)
    middle = np.abs(rows[:, 0, 0]) < 8.0
    height = np.linalg.norm(rows[middle, 0] - rows[middle, -1], axis=1)
    assert 0.08 < height.std() / height.mean() < 0.35
    gloss = tears.gloss.reshape(-1, ACROSS)[middle, 0]
    assert gloss.mean() == pytest.approx(1.0, abs=0.25)
    assert gloss.max() > 2 * gloss.min() > 0.0
    # Its surface waves along the lid, so that the sun's image breaks.
    along = (tears.normals * tears.tangents).sum(axis=1).reshape(-1, ACROSS)[middle, ACROSS // 2]
    assert 0.05 < along.std() < 0.4


def test_upper_and_lower_line_differ_and_keep_their_shape() -> None:
    lower, upper, again = strip(STRAIGHT), strip(STRAIGHT, is_upper=True), strip(STRAIGHT)
    np.testing.assert_array_equal(lower.gloss, again.gloss)
    assert np.abs(lower.gloss - upper.gloss).mean() > 0.1


def test_the_line_runs_dry_before_the_canthi() -> None:
    tears = strip(STRAIGHT)
    x = tears.points_mm[:, 0]
    assert tears.amount[x < -10.8].max(initial=0.0) == 0.0
    assert tears.amount[x > 11.6].max(initial=0.0) == 0.0
    assert tears.amount[np.abs(x) < 7.0].min() == 1.0


def drawn(
    gl: moderngl.Context,
    irradiance: float,
    *,
    mm_per_px: float,
    middle_y_mm: float,
    ground: float = 0.4,
) -> npt.NDArray[np.float32]:
    """Draw the right eye's tear lines over a grey ground, from in front: (96, 96, 4) upwards."""
    program = build_program(gl, "tears.vert", fragment="tears.frag")
    line = TearLine(gl, program, fit_lids(face_mesh().sockets[1], STRAIGHT), eye=1)
    depth = gl.depth_texture((1, 1), data=np.ones(1, np.float32).tobytes())
    depth.compare_func = ""
    harmonics = np.zeros((9, 3))
    harmonics[0] = 0.5 / 0.282095
    light = Light(
        Sky(np.array([0.0, 0.6, 0.8]), np.full(3, irradiance), harmonics),
        depth,
        np.eye(4, dtype=np.float32),
    )
    half_mm = 48 * mm_per_px
    matrix = np.eye(4)
    matrix[0, :] = 1 / half_mm, 0, 0, -31 / half_mm
    matrix[1, :] = 0, 1 / half_mm, 0, -middle_y_mm / half_mm
    matrix[2, :] = 0, 0, -1 / 40, 0
    target = gl.framebuffer([gl.texture((96, 96), 4, dtype="f4")], gl.depth_renderbuffer((96, 96)))
    target.use()
    target.clear(ground, ground, ground, 1.0)
    line.draw(
        u_view_matrix=np.eye(4),
        u_projection=matrix,
        u_camera_mm=np.array([31.0, 0.0, 170.0]),
        u_mm_per_px=mm_per_px,
        **light.uniforms(),
    )
    picture = np.frombuffer(target.read(components=4, dtype="f4"), np.float32)
    target.release()
    return picture.reshape(96, 96, 4)


def test_sun_and_sky_shine_on_it_and_little_is_taken_away(gl: moderngl.Context) -> None:
    pictures = [
        drawn(gl, irradiance, mm_per_px=0.125, middle_y_mm=-5.0) for irradiance in (0.0, 2.4)
    ]
    sky, sun = (picture[..., 0] for picture in pictures)
    assert np.isfinite(sun).all()
    changed = np.abs(sky - 0.4) > 1e-4
    assert 0.005 < changed.mean() < 0.2
    assert sky.min() > 0.3
    assert (sun - sky).max() > 0.1  # a glint
    assert pictures[0][..., 3].min() > 0.999


def test_the_line_begins_softly_on_the_globe(gl: moderngl.Context) -> None:
    """The hollow meets the film at its own slope: no edge is there to be mirrored."""
    shine = drawn(gl, 0.0, mm_per_px=0.02, middle_y_mm=3.4, ground=0.0)[..., 0]
    columns = [column[column > 0.0] for column in shine.T if column.max() > 0.0]
    assert len(columns) > 80
    # Rows run upwards, from the globe to the upper lid.
    assert np.median([column[0] / column.max() for column in columns]) < 0.2
