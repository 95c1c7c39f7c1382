"""GL's memory, asked from GL: known objects weigh what they should."""

from __future__ import annotations

import mmap
from pathlib import Path

import moderngl
import pytest

from renderer.benchmark.gl_memory import gl_bytes, resident_bytes


def test_objects_weigh_their_texels_levels_faces_and_samples(gl: moderngl.Context) -> None:
    before = gl_bytes(gl)
    kept: list[object] = []

    def grown(kind: str) -> int:
        after = gl_bytes(gl)
        more = after[kind] - before[kind]
        before.update(after)
        return more

    plain = gl.texture((64, 32), 4)
    kept.append(plain)
    assert grown("textures") == 64 * 32 * 4
    plain.build_mipmaps(max_level=2)
    assert grown("textures") == (32 * 16 + 16 * 8) * 4
    kept.append(gl.texture((16, 16), 4, samples=4, dtype="f2"))
    assert grown("textures") == 16 * 16 * 4 * 8
    kept.append(gl.texture_cube((8, 8), 4, dtype="f2"))
    assert grown("textures") == 6 * 8 * 8 * 8
    kept.append(gl.buffer(reserve=1000))
    assert grown("buffers") == 1000
    kept.append(gl.depth_renderbuffer((16, 8)))
    assert grown("renderbuffers") == 16 * 8 * 4


def test_the_resident_set_grows_with_what_is_touched() -> None:
    before = resident_bytes()
    with mmap.mmap(-1, 64_000_000) as ballast:  # fresh pages: an allocator may have old ones left
        for page in range(0, len(ballast), mmap.PAGESIZE):
            ballast[page] = 1
        assert resident_bytes() - before > 0.8 * len(ballast)


def test_without_proc_the_largest_resident_set_is_told(tmp_path: Path) -> None:
    assert resident_bytes(tmp_path / "absent") >= 10_000_000


def test_an_old_driver_is_not_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    class Old:
        version_code = 430

    old: moderngl.Context = Old()  # no such driver is at hand
    monkeypatch.setattr("renderer.benchmark.gl_memory.gl_function", None)
    assert gl_bytes(old) == {}
