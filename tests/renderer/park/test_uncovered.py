"""Tiles that nothing covers: exact, and the picture is the same with and without them."""

from __future__ import annotations

import moderngl
import numpy as np

from renderer.camera import views
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.park.surroundings import Surroundings
from renderer.park.uncovered import TILES, Uncovered, tiles_of

ULTRA = Detail.uniform("ultra")
SPEC = ClipSpec(left=ULTRA, right=ULTRA, width=160, height=96)


def half_covered(gl: moderngl.Context) -> moderngl.Framebuffer:
    size = (160, 96)
    target = gl.framebuffer([gl.texture(size, 4, dtype="f2")], gl.depth_texture(size))
    target.use()
    target.clear(depth=1.0)
    target.scissor = (0, 0, 90, 96)
    target.clear(9.0, 0.0, 0.0, 1.0, depth=0.5)
    target.scissor = (0, 0, *size)
    gl.enable_only(moderngl.DEPTH_TEST)
    return target


def test_tiles_cover_every_pixel_once() -> None:
    counts = np.zeros((97, 163), int)
    for x, y, width, height in tiles_of((3, 1, 159, 95)):
        counts[y : y + height, x : x + width] += 1
    assert (counts[1:96, 3:162] == 1).all()
    assert counts.sum() == 159 * 95


def test_only_tiles_with_an_open_pixel_are_found(gl: moderngl.Context) -> None:
    target = half_covered(gl)
    gl.depth_func = "<="
    found = Uncovered(gl).tiles()
    gl.depth_func = "<"
    assert found == [box for box in tiles_of((0, 0, 160, 96)) if box[0] + box[2] > 90]
    assert len(found) == TILES * 4
    assert target.scissor == (0, 0, 160, 96)


def test_background_in_tiles_is_the_whole_background(gl: moderngl.Context) -> None:
    park = Surroundings(gl, SPEC)
    view = views(SPEC, 20.0)[0]
    pictures = []
    for uncovered in (Uncovered(gl), None):
        park._uncovered = uncovered
        target = half_covered(gl)
        park.draw_background(view_matrix=view.view_matrix, projection=view.projection)
        pictures.append(target.read(components=4, dtype="f2"))
    assert pictures[0] == pictures[1]
    assert np.frombuffer(pictures[0], np.float16).reshape(96, 160, 4)[:, 100:, :3].min() > 0.0
