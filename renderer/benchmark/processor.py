"""What a frame asks of the processor besides shading: the submitting thread's time and its calls.

A GPU shades while Python prepares what follows, so a rate is bound by the slower of the two. Time
in which pictures are read back is left out everywhere. On a GPU drawing, clearing and copying are
the driver's work, which the thread pays for. On software GL they transform, clip and shade on this
very thread and turn everything else out of its caches: there frames are rehearsed, without them.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import ModuleType
from typing import Any, Final

import moderngl

from renderer.gl.functions import gl_function

Methods = tuple[tuple[type, tuple[str, ...]], ...]

_DRAWS: Final[Methods] = (
    (moderngl.VertexArray, ("render", "render_indirect", "transform")),
    (moderngl.ComputeShader, ("run", "run_indirect")),
)
_FILLS: Final[Methods] = (
    (moderngl.Framebuffer, ("clear",)),
    (moderngl.Context, ("copy_framebuffer", "copy_buffer")),
    (moderngl.Texture, ("build_mipmaps",)),
    (moderngl.TextureArray, ("build_mipmaps",)),
    (moderngl.TextureCube, ("build_mipmaps",)),
)
_READS: Final[Methods] = (
    (moderngl.Framebuffer, ("read", "read_into")),
    (moderngl.Texture, ("read", "read_into")),
    (moderngl.TextureArray, ("read", "read_into")),
    (moderngl.TextureCube, ("read", "read_into")),
    (moderngl.Buffer, ("read", "read_into", "read_chunks")),
)
# Of the functions that modules of ours take from GL themselves, by how their names begin.
_OWN_DRAWS: Final = ("glDraw", "glMultiDraw", "glDispatch")
_OWN_FILLS: Final = ("glBlit", "glClear", "glCopy", "glGenerate")


@dataclass(frozen=True)
class Asked:
    """What a stretch of code asked of the processor and of GL.

    ``processor_ms``: the calling thread's, without reading back. ``reads``: pictures and buffers
    read back, which took ``wait_ms`` of wall time.
    """

    processor_ms: float
    draw_calls: int
    reads: int
    wait_ms: float


class Watch:
    """Count calls and the time that does not count, while ``watched``."""

    def __init__(self) -> None:
        self._rehearses = False
        self.begin()

    def begin(self) -> None:
        """Count from now on."""
        self.draws = self.reads = 0
        self.left_out_s = self.waited_s = 0.0
        self._started_s = time.thread_time()

    def asked(self) -> Asked:
        """Return what was asked since the watch began."""
        own_s = time.thread_time() - self._started_s - self.left_out_s
        return Asked(own_s * 1e3, self.draws, self.reads, self.waited_s * 1e3)

    @contextmanager
    def rehearsing(self) -> Iterator[None]:
        """Draw, clear and copy nothing meanwhile: calls are counted and end at once."""
        self._rehearses = True
        try:
            yield
        finally:
            self._rehearses = False

    def drawing(self, call: Callable[..., Any]) -> Callable[..., Any]:
        """Return a call that counts as a draw."""

        def counted(*given: Any, **named: Any) -> Any:
            self.draws += 1
            return None if self._rehearses else call(*given, **named)

        return counted

    def filling(self, call: Callable[..., Any]) -> Callable[..., Any]:
        """Return a call that a rehearsal leaves out."""

        def left_out(*given: Any, **named: Any) -> Any:
            return None if self._rehearses else call(*given, **named)

        return left_out

    def reading(self, call: Callable[..., Any]) -> Callable[..., Any]:
        """Return a call that counts as reading back: no processor time, but wall time waited."""

        def counted(*given: Any, **named: Any) -> Any:
            self.reads += 1
            own_s, started_s = time.thread_time(), time.perf_counter()
            try:
                return call(*given, **named)
            finally:
                self.waited_s += time.perf_counter() - started_s
                self.left_out_s += time.thread_time() - own_s

        return counted


@contextmanager
def watched() -> Iterator[Watch]:
    """Watch what is asked of moderngl's objects meanwhile.

    The methods of moderngl's classes are replaced for so long, and ``gl_function`` where modules of
    the renderer have it: what draws knows nothing of it.
    """
    watch = Watch()
    replaced: list[tuple[object, str, Any]] = []

    def replace(holder: object, name: str, make: Callable[[Any], Any]) -> None:
        own = getattr(holder, name)
        replaced.append((holder, name, own))
        setattr(holder, name, make(own))

    def own_function(name: str, *arguments: Any, **named: Any) -> Callable[..., Any]:
        call = gl_function(name, *arguments, **named)
        if name.startswith(_OWN_DRAWS):
            return watch.drawing(call)
        return watch.filling(call) if name.startswith(_OWN_FILLS) else call

    try:
        for methods, make in (
            (_DRAWS, watch.drawing),
            (_FILLS, watch.filling),
            (_READS, watch.reading),
        ):
            for kind, names in methods:
                for name in names:
                    replace(kind, name, make)
        for module in _users_of_gl():
            replace(module, "gl_function", lambda _own: own_function)
        watch.begin()
        yield watch
    finally:
        for holder, name, own in replaced:
            setattr(holder, name, own)


def _users_of_gl() -> list[ModuleType]:
    """Return the renderer's modules that have ``gl_function``, but for this one."""
    own = [module for name, module in sys.modules.items() if name.startswith("renderer.")]
    return [
        module
        for module in own
        if vars(module).get("gl_function") is gl_function and module.__name__ != __name__
    ]
