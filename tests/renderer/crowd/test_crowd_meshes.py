"""Everybody's meshes: skinned and drawn with few calls, whoever is left out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import moderngl
import numpy as np
import pytest

from renderer.camera import views
from renderer.clip import ClipSpec
from renderer.crowd.crowd import Crowd
from renderer.crowd.meshes import CrowdMeshes
from renderer.crowd.pieces import PARTS
from renderer.detail import Detail
from renderer.light import Light, Sky
from renderer.view import look_at, perspective

LOW = Detail.uniform("low")
SPEC = ClipSpec(left=LOW, right=LOW, distance="far", width=320, height=180)


def light(gl: moderngl.Context) -> Light:
    sh = np.zeros((9, 3))
    sh[0] = 1.0
    sky = Sky(np.array([-0.6, 0.64, 0.48]), np.array([2.0, 2.0, 2.0]), sh)
    lit = gl.texture((2, 2), 1, np.ones(4, np.float32).tobytes(), dtype="f4")
    return Light(sky, lit, np.eye(4, dtype=np.float32))


@pytest.fixture(scope="module")
def crowd(gl: moderngl.Context) -> Crowd:
    return Crowd(gl, SPEC, light(gl))


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int]]:
    """Return a list that grows with all that GL is asked for: the call and its vertices."""
    calls: list[tuple[str, int]] = []
    for name in ("render", "transform"):
        monkeypatch.setattr(moderngl.VertexArray, name, counted(name, calls))
    return calls


def counted(name: str, calls: list[tuple[str, int]]) -> Callable[..., None]:
    call = getattr(moderngl.VertexArray, name)

    def counting(self: moderngl.VertexArray, *args: Any, vertices: int, **named: Any) -> None:
        calls.append((name, vertices))
        call(self, *args, vertices=vertices, **named)

    return counting


def picture(gl: moderngl.Context, crowd: Crowd, azimuth_deg: float, time_s: float) -> bytes:
    size = (SPEC.width, SPEC.height)
    target = gl.framebuffer([gl.texture(size, 4, dtype="f2")], gl.depth_texture(size))
    target.use()
    target.clear(depth=1.0)
    gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
    crowd.draw(**views(SPEC, azimuth_deg)[0].uniforms, time_s=time_s)
    return bytes(target.read(components=4, dtype="f2"))


def test_a_gpu_skins_and_draws_everybody_at_once_and_shows_the_same(
    gl: moderngl.Context,
    crowd: Crowd,
    monkeypatch: pytest.MonkeyPatch,
    drawn: list[tuple[str, int]],
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr("renderer.gl.context.SOFTWARE", ())
        whole = Crowd(gl, SPEC, crowd.light)
    monkeypatch.setattr(whole, "bounds_mm", None)  # nobody asks where they are
    for azimuth, time in ((-60.0, 0.4), (10.0, 2.9)):
        drawn.clear()
        shown = picture(gl, whole, azimuth, time)
        assert [name for name, _ in drawn] == ["transform", "render"]
        assert shown == picture(gl, crowd, azimuth, time)
        assert any(shown)


def test_some_are_skinned_as_all_are(crowd: Crowd, drawn: list[tuple[str, int]]) -> None:
    expected = crowd.vertices(1.7)
    assert [name for name, _ in drawn] == ["transform"]
    crowd.vertices(0.2)
    drawn.clear()
    crowd.pose(1.7)
    crowd.skin([3])
    crowd.skin([0, 1, 3])
    sizes = [len(figure.body.positions_mm) for figure in crowd.figures]
    # Neighbours together, nobody twice.
    assert drawn == [("transform", sizes[3]), ("transform", sizes[0] + sizes[1])]
    found = crowd.meshes.skinned.vertices()
    for number, figure in enumerate(crowd.figures):
        rows = slice(figure.first_vertex, figure.first_vertex + len(figure.body.positions_mm))
        assert (found[rows] == expected[rows]).all() == (number in (0, 1, 3))


def test_painted_eyes_alone_are_left_out_of_the_eyeless(
    gl: moderngl.Context, crowd: Crowd, drawn: list[tuple[str, int]]
) -> None:
    shares = [np.ones((len(figure.body.positions_mm), 2)) for figure in crowd.figures]
    meshes = CrowdMeshes(gl, crowd.figures, shares=shares, has_real_eyes=True)
    eyes = [
        3 * int((figure.body.parts[figure.body.triangles[:, 0]] == PARTS.index("eyes")).sum())
        for figure in crowd.figures
    ]

    def asked(numbers: Sequence[int], eyeless: Sequence[int]) -> tuple[int, int]:
        drawn.clear()
        meshes.draw(numbers, view_matrix=np.eye(4), eyeless=eyeless)
        return len(drawn), sum(vertices for _, vertices in drawn)

    whole = [3 * len(figure.body.triangles) for figure in crowd.figures]
    assert min(eyes) > 0
    assert asked(range(5), ()) == (1, sum(whole))
    assert asked(range(5), range(5)) == (1, sum(whole) - sum(eyes))
    assert asked([1, 2, 4], [2]) == (4, whole[1] + whole[2] + whole[4] - eyes[2])
    assert asked([], ()) == (0, 0)


def test_whom_only_eyes_are_to_see_is_shown_on_request(crowd: Crowd) -> None:
    camera = look_at(np.array([0.0, 6000.0, 12000.0]), np.zeros(3))
    from_above = perspective(60.0, 1.0, 100.0, 50000.0) @ camera
    crowd.pose(0.5)
    assert crowd.in_view(from_above) == [2, 3, 4]
    crowd.shows_everybody = True
    try:
        assert crowd.in_view(from_above) == [0, 1, 2, 3, 4]
    finally:
        crowd.shows_everybody = False
