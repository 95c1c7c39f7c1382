"""Edges that shading leaves jagged are the mean of four samples afterwards; all else stays."""

from __future__ import annotations

from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.frame.edge_tiles import depth_step
from renderer.frame.edges import Edges
from renderer.frame.frame import FrameRenderer
from renderer.frame.outlines import EYE
from renderer.frame.picture import EXPOSURE, Picture
from renderer.scene import Scene
from renderer.view import View, look_at, perspective

SIZE: Final = 64
CAMERA_MM: Final = np.array([0.0, 0.0, 1000.0])
VIEW: Final = View(
    (0, 0, SIZE, SIZE),
    look_at(CAMERA_MM, np.zeros(3)),
    perspective(12.0, 1.0, 500.0, 60000.0),
    CAMERA_MM,
    (),
)
CLIP: Final = VIEW.projection @ VIEW.view_matrix
# A slanting edge: what lies left of it is the nearer thing.
EDGE: Final = np.array([[-500.0, -500.0], [30.0, -500.0], [-40.0, 500.0]])
ALL: Final = np.array([[-900.0, -900.0], [900.0, -900.0], [0.0, 1800.0]])

VERTEX: Final = """#version 430
in vec3 p; uniform mat4 u_clip;
void main() { gl_Position = u_clip * vec4(p, 1.0); }"""
FRAGMENT: Final = """#version 430
uniform vec4 u_colour; out vec4 c;
void main() { c = u_colour; }"""


class Stage:
    """Draw flat triangles into a picture and into its outlines."""

    def __init__(self, gl: moderngl.Context) -> None:
        self.gl = gl
        self.picture = Picture(gl, (SIZE, SIZE))
        self.program = gl.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
        self.things: list[tuple[npt.NDArray[np.float64], float, float, int]] = []

    def add(
        self, corners: npt.NDArray[np.float64], z_mm: float, radiance: float, mark: int = 0
    ) -> None:
        """Have a triangle in the plane z = ``z_mm``."""
        self.things.append((corners, z_mm, radiance, mark))

    def _render(self, corners: npt.NDArray[np.float64], z_mm: float, *colour: float) -> None:
        rows = np.column_stack([corners, np.full(3, z_mm)]).astype(np.float32)
        self.program["u_clip"].write(np.ascontiguousarray(CLIP.T).tobytes())
        self.program["u_colour"].value = colour
        self.gl.vertex_array(self.program, [(self.gl.buffer(rows.tobytes()), "3f", "p")]).render()

    def draw(self, *, is_plain: bool = True, is_smooth: bool = True) -> npt.NDArray[np.float32]:
        """Return one channel of the radiance (n, n), first row on top."""
        self.picture.begin()
        self.picture.use_rectangle(VIEW.rectangle)
        for corners, z_mm, radiance, mark in self.things:
            self._render(corners, z_mm, radiance, radiance, radiance, 1.0 + mark)
        tiles = self.picture.find_edges([VIEW])
        self.picture.outlines.begin(VIEW.rectangle, tiles[0])
        for corners, z_mm, _, mark in self.things:
            if not mark:
                self._render(corners, z_mm, 0.0, 0.0, 0.0, 0.0)
        with self.picture.outlines.marking():
            for corners, z_mm, _, mark in self.things:
                if mark:
                    self._render(corners, z_mm, *([mark / 255.0] * 4))
        if is_smooth:
            self.picture.smooth_edges([VIEW], tiles, is_plain=is_plain)
        return self.picture.radiance()[..., 0]


@pytest.fixture
def stage(gl: moderngl.Context) -> Stage:
    return Stage(gl)


def test_an_edge_of_depth_is_the_mean_of_its_four_samples(stage: Stage) -> None:
    stage.add(ALL, -100.0, 0.0)
    stage.add(EDGE, 0.0, 8.0)
    assert np.unique(stage.draw(is_smooth=False)).tolist() == [0.0, 8.0]
    values, counts = np.unique(stage.draw(), return_counts=True)
    assert values.tolist() == [0.0, 2.0, 4.0, 6.0, 8.0]
    assert counts[1:4].min() > 3


def test_an_edge_lies_where_the_triangle_ends(stage: Stage) -> None:
    stage.add(ALL, -100.0, 0.0)
    stage.add(EDGE, 0.0, 1.0)
    rows = stage.draw()[4:-4]
    px_per_mm = SIZE / 2 * VIEW.projection[1, 1] / 1000.0
    y_mm = (SIZE / 2 - 0.5 - np.arange(4, SIZE - 4)) / px_per_mm
    edge_px = SIZE / 2 + px_per_mm * np.interp(y_mm, [-500.0, 500.0], [30.0, -40.0])
    np.testing.assert_allclose(rows.sum(axis=1), edge_px, atol=0.26)


def test_things_that_meet_at_one_depth_have_an_edge_where_marks_differ(stage: Stage) -> None:
    stage.add(ALL, 0.0, 0.0)
    stage.add(EDGE, 0.01, 8.0)
    assert np.unique(stage.draw()).tolist() == [0.0, 8.0]
    stage.things[1] = (EDGE, 0.01, 8.0, EYE)
    assert np.unique(stage.draw()).tolist() == [0.0, 2.0, 4.0, 6.0, 8.0]


def test_for_the_tone_curve_the_sun_counts_less(stage: Stage) -> None:
    stage.add(ALL, -100.0, 0.5)
    stage.add(EDGE, 0.0, 100.0)
    values = np.unique(stage.draw(is_plain=False))
    weights = 1.0 / (1.0 + EXPOSURE * np.array([0.5, 100.0]))
    one = (3 * 0.5 * weights[0] + 100.0 * weights[1]) / (3 * weights[0] + weights[1])
    assert values[1] == pytest.approx(one, rel=0.002)
    assert values[1] < 2.0


def test_an_even_surface_stays_bit_for_bit(stage: Stage) -> None:
    stage.add(ALL, 0.0, 0.37)
    before = stage.draw(is_smooth=False)
    assert np.array_equal(stage.draw(), before)


def test_a_step_of_depth_is_a_pixels_width() -> None:
    scale, far = depth_step(VIEW)
    pixel_mm = 1000.0 / (SIZE / 2 * VIEW.projection[1, 1])

    def depth(z_mm: float) -> float:
        clip = np.asarray(CLIP, float) @ [0.0, 0.0, z_mm, 1.0]
        return float(0.5 + 0.5 * clip[2] / clip[3])

    step = depth(-pixel_mm / 2) - depth(pixel_mm / 2)
    assert step == pytest.approx(scale * (far - depth(0.0)), rel=0.01)


def test_conjunctiva_has_no_edge_where_its_solid_part_ends(
    gl: moderngl.Context, standard_scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    low = Detail.uniform("low")
    spec = ClipSpec(left=low, right=low, width=960, height=540, crowd=0)
    renderer = FrameRenderer(gl, spec, scene=standard_scene)
    smooth = renderer.render(20).pixels.astype(int)
    monkeypatch.setattr(Edges, "smooth", lambda *_args, **_named: None)
    rough = renderer.render(20).pixels.astype(int)
    between_globe_and_caruncle = (slice(265, 310), slice(545, 565))
    changed = np.abs(smooth - rough)[between_globe_and_caruncle]
    assert changed.max() < 8
