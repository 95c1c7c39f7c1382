"""What a frame asks of the processor: calls are counted, software GL's drawing is left out."""

from __future__ import annotations

import ctypes
import sys
import time
from types import ModuleType
from typing import Any

import moderngl
import pytest

from renderer.benchmark.processor import watched
from renderer.gl.functions import gl_function
from renderer.gl.program import build_program

BUSY_S = 0.02


def keep_busy(*_given: Any, **_named: Any) -> bytes:
    until = time.thread_time() + BUSY_S
    while time.thread_time() < until:
        pass
    return b""


@pytest.fixture
def target(gl: moderngl.Context) -> moderngl.Framebuffer:
    return gl.framebuffer([gl.texture((8, 8), 4)])


def test_draws_and_reads_are_counted_and_methods_are_theirs_again(
    gl: moderngl.Context, target: moderngl.Framebuffer
) -> None:
    program = build_program(gl, "screen.vert", fragment="busy.frag")
    screen = gl.vertex_array(program.gl_program, [])
    before = moderngl.VertexArray.render, moderngl.Framebuffer.read
    with watched() as watch, gl.scope(target, moderngl.NOTHING):
        target.clear()
        screen.render(moderngl.TRIANGLES, vertices=3)
        screen.render(moderngl.TRIANGLES, vertices=3)
        assert target.read(components=1)[:1] == bytes([64])
        asked = watch.asked()
        assert (asked.draw_calls, asked.reads) == (2, 1)
        assert asked.wait_ms > 0.0
        watch.begin()
        assert watch.asked().draw_calls == 0
    assert (moderngl.VertexArray.render, moderngl.Framebuffer.read) == before


@pytest.mark.parametrize(
    ("kind", "name", "is_rehearsed", "counts"),
    [
        ("VertexArray", "render", False, True),
        ("VertexArray", "transform", False, True),
        ("Framebuffer", "clear", False, True),
        ("TextureCube", "build_mipmaps", False, True),
        ("Framebuffer", "read", True, False),
        ("Texture", "read", True, False),
        ("Buffer", "write", True, True),
    ],
)
def test_drawing_counts_as_the_drivers_and_is_not_rehearsed(
    monkeypatch: pytest.MonkeyPatch, kind: str, name: str, is_rehearsed: bool, counts: bool
) -> None:
    own = getattr(moderngl, kind)
    called = []

    def work(*_given: Any, **_named: Any) -> bytes:
        called.append(name)
        return keep_busy()

    monkeypatch.setattr(own, name, work)
    with watched() as watch:
        getattr(own, name)(None)
        assert (watch.asked().processor_ms >= BUSY_S * 1e3) is counts
        assert called == [name]
        with watch.rehearsing():
            watch.begin()
            getattr(own, name)(None)
            spent_ms = watch.asked().processor_ms
        assert (spent_ms >= BUSY_S * 1e3) is (is_rehearsed and counts)
        assert len(called) == 1 + is_rehearsed


def test_what_is_rehearsed_is_counted_and_leaves_pictures_alone(
    gl: moderngl.Context, target: moderngl.Framebuffer
) -> None:
    program = build_program(gl, "screen.vert", fragment="busy.frag")
    screen = gl.vertex_array(program.gl_program, [])
    with watched() as watch, gl.scope(target, moderngl.NOTHING):
        target.clear(1.0, 1.0, 1.0, 1.0)
        with watch.rehearsing():
            target.clear()
            screen.render(moderngl.TRIANGLES, vertices=3)
            assert watch.asked().draw_calls == 1
        assert set(target.read(components=3)) == {255}


@pytest.mark.usefixtures("gl")
def test_functions_that_modules_take_from_gl_count_too(monkeypatch: pytest.MonkeyPatch) -> None:
    user: Any = ModuleType("renderer.user_of_gl")
    user.gl_function = gl_function
    monkeypatch.setitem(sys.modules, user.__name__, user)
    with watched() as watch:
        user.gl_function("glFlush")()
        assert watch.asked().draw_calls == 0
        draw = user.gl_function("glDrawArrays", ctypes.c_uint, ctypes.c_int, ctypes.c_int)
        draw(moderngl.TRIANGLES, 0, 0)
        assert watch.asked().draw_calls == 1
    assert user.gl_function is gl_function


def test_methods_are_theirs_again_after_a_failure() -> None:
    before = moderngl.Framebuffer.read
    with pytest.raises(ZeroDivisionError), watched():
        _ = 1 / 0
    assert moderngl.Framebuffer.read is before
