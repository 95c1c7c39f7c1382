"""Tiles that may have edges are found, few others, and only what may cover them is drawn."""

from __future__ import annotations

from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.frame.bare_mesh import GROUP, BareMesh, along_curve
from renderer.frame.boxes import Boxes
from renderer.frame.edge_tiles import TILE_PX, EdgeFinder, EdgeTiles, runs_of
from renderer.gl.program import build_program
from renderer.view import View, look_at, perspective

SIZE: Final = (208, 152)  # the second view's tiles reach beyond the picture
CAMERA_MM: Final = np.array([0.0, 0.0, 1000.0])
LOOK: Final = look_at(CAMERA_MM, np.zeros(3))
VIEWS: Final = tuple(
    View(rectangle, LOOK, perspective(12.0, 104 / 152, 500.0, 60000.0), CAMERA_MM, ())
    for rectangle in ((0, 0, 104, 152), (104, 0, 104, 152))
)
CLIP: Final = np.asarray(VIEWS[0].projection @ VIEWS[0].view_matrix, float)


class Stage:
    """A picture of both views whose depth and marks are given."""

    def __init__(self, gl: moderngl.Context) -> None:
        self.gl = gl
        self.radiance = gl.texture(SIZE, 4, dtype="f4")
        self.depth = gl.depth_texture(SIZE)
        self.depth.compare_func = ""
        self.finder = EdgeFinder(gl, self.radiance, self.depth)
        self.z_mm = np.zeros(SIZE[::-1])  # rows from below
        self.mark = np.zeros(SIZE[::-1])

    def masks(self) -> list[npt.NDArray[np.bool_]]:
        z_mm = self.z_mm - CAMERA_MM[2]
        lens = np.asarray(VIEWS[0].projection, float)
        depth = np.minimum(0.5 - 0.5 * (lens[2, 2] * z_mm + lens[2, 3]) / z_mm, 1.0)
        self.depth.write(depth.astype(np.float32).tobytes())
        colours = np.repeat((1.0 + self.mark)[..., None], 4, axis=2).astype(np.float32)
        self.radiance.write(colours.tobytes())
        return [tiles.mask for tiles in self.finder.find(VIEWS)]


def test_a_plane_has_no_edge_however_it_slopes(gl: moderngl.Context) -> None:
    stage = Stage(gl)
    columns, rows = np.meshgrid(np.arange(SIZE[0]) % 104, np.arange(SIZE[1]))
    stage.z_mm = 2.0 * columns - 1.5 * rows  # some 55 and 64 degrees
    assert not np.any(stage.masks())


def test_a_step_and_a_mark_are_found_in_their_tiles_alone(gl: moderngl.Context) -> None:
    stage = Stage(gl)
    stage.z_mm[:, 75:104] = -20.0
    stage.mark[101:, 130:] = 1.0
    left, right = stage.masks()
    assert sorted(set(np.nonzero(left)[1])) == [75 // TILE_PX]
    assert left[: SIZE[1] // TILE_PX, 75 // TILE_PX].all()
    assert set(np.nonzero(right)[0]) == set(range(100 // TILE_PX, SIZE[1] // TILE_PX + 1))
    assert right[100 // TILE_PX, (131 - 104) // TILE_PX : 104 // TILE_PX].all()
    assert not right[:, : 129 // TILE_PX - 104 // TILE_PX].any()


def test_one_view_does_not_end_at_the_next(gl: moderngl.Context) -> None:
    stage = Stage(gl)
    stage.z_mm[:, 104:] = -300.0
    stage.mark[:, 104:] = 1.0
    assert not np.any(stage.masks())


def test_what_nothing_covers_lies_in_gaps_and_what_is_covered_does_not(
    gl: moderngl.Context,
) -> None:
    stage = Stage(gl)
    stage.z_mm[:, :30] = stage.z_mm[60:90, 104:150] = -1e9  # the far plane and beyond
    stage.masks()
    tiles = stage.finder.find(VIEWS)
    for each, view in zip(tiles, VIEWS, strict=True):
        x, y, width, height = view.rectangle
        target = gl.framebuffer([gl.texture(SIZE, 1)])
        target.use()
        target.clear()
        gl.enable_only(moderngl.NOTHING)
        assert each.gaps is not None
        each.gaps.draw(build_program(gl, "boxes.vert", fragment="mark.frag"), u_mark=1.0)
        pixels = np.frombuffer(target.read(components=1, alignment=1), np.uint8)
        drawn = pixels.reshape(SIZE[::-1])[y : y + height, x : x + width] > 0
        is_open = stage.z_mm[y : y + height, x : x + width] < 0.0
        assert drawn[is_open].all()
        reach = np.array([is_open.any(axis=1).sum(), is_open.any(axis=0).sum()]) + 2 * TILE_PX
        assert 0 < drawn.sum() <= reach.prod()


def test_runs_cover_a_mask_within_its_view() -> None:
    rng = np.random.default_rng(3)
    mask = rng.random((20, 14)) < 0.4
    covered = np.zeros(SIZE[::-1], dtype=int)
    for x, y, width, height in runs_of(mask, VIEWS[1].rectangle):
        covered[y : y + height, x : x + width] += 1
    wanted = np.kron(mask, np.ones((TILE_PX, TILE_PX), dtype=int))[: SIZE[1], :104]
    assert np.array_equal(covered[:, 104:], wanted)
    assert not covered[:, :104].any()


def test_what_covers_a_tile_is_drawn_and_little_else(gl: moderngl.Context) -> None:
    size = VIEWS[0].rectangle[2:]
    rng = np.random.default_rng(5)
    middles = rng.uniform([-60.0, -90.0, -10.0], [60.0, 90.0, 10.0], (3000, 3))
    points = (middles[:, None] + rng.normal(0.0, 1.5, (3000, 3, 3))).reshape(-1, 3)
    program = build_program(gl, "depth.vert", fragment="mark.frag")
    mesh = BareMesh(gl, program, points, np.arange(9000).reshape(-1, 3))
    program.set(u_world_to_clip=CLIP, u_mark=1.0)
    target = gl.framebuffer([gl.texture(size, 1)])

    def drawn(mask: npt.NDArray[np.bool_]) -> tuple[npt.NDArray[np.bool_], int]:
        target.use()
        target.clear()
        gl.enable_only(moderngl.NOTHING)
        query = gl.query(primitives=True)
        with query:
            mesh.draw(CLIP, EdgeTiles(mask, Boxes(gl, size), size))
        pixels = np.frombuffer(target.read(components=1, alignment=1), np.uint8)
        return pixels.reshape(size[1], size[0]) > 0, int(query.primitives)

    every, everything = drawn(np.ones((19, 13), dtype=bool))
    assert everything == 3000
    mask = np.zeros((19, 13), dtype=bool)
    mask[4, 3:6] = mask[12:15, 9] = True
    some, few = drawn(mask)
    inside = np.kron(mask, np.ones((TILE_PX, TILE_PX), dtype=bool))[: size[1], : size[0]]
    assert np.array_equal(some[inside], every[inside])
    assert 0 < few < 0.25 * everything
    assert drawn(np.zeros((19, 13), dtype=bool))[1] == 0


def test_neighbours_along_the_curve_are_near() -> None:
    points = np.random.default_rng(2).uniform(0.0, 100.0, (4000, 3))
    ordered = points[np.argsort(along_curve(points))][: 4000 // GROUP * GROUP]
    groups = ordered.reshape(-1, GROUP, 3)
    assert np.median(np.ptp(groups, axis=1).max(axis=1)) < 25.0
