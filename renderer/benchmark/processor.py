"""What a frame asks of the processor besides shading: the submitting thread's time and its calls.

A GPU shades while Python prepares what follows, so a rate is bound by the slower of the two. Of the
time that the thread itself was running, waiting for pictures read back is left out everywhere, and
on software GL also drawing, clearing and copying: there they transform, clip and shade on the
processor. On a GPU these calls are the driver's work, which the thread does pay for.
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

    ``processor_ms``: the calling thread's, without what the module leaves out. ``reads``: pictures
    and buffers read back, which took ``wait_ms`` of wall time.
    """

    processor_ms: float
    draw_calls: int
    reads: int
    wait_ms: float


class Watch:
    """Count calls and the time that does not count, while ``watched``."""

    def __init__(self) -> None:
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

    def drawing(self, call: Callable[..., Any], *, is_timed: bool) -> Callable[..., Any]:
        """Return a call that counts as a draw; its time is left out where it ``is_timed``."""
        timed = self.filling(call) if is_timed else call

        def counted(*given: Any, **named: Any) -> Any:
            self.draws += 1
            return timed(*given, **named)

        return counted

    def filling(self, call: Callable[..., Any]) -> Callable[..., Any]:
        """Return a call whose time is left out."""

        def timed(*given: Any, **named: Any) -> Any:
            started_s = time.thread_time()
            try:
                return call(*given, **named)
            finally:
                self.left_out_s += time.thread_time() - started_s

        return timed

    def reading(self, call: Callable[..., Any]) -> Callable[..., Any]:
        """Return a call that counts as reading back: no processor time, but wall time waited."""
        timed = self.filling(call)

        def counted(*given: Any, **named: Any) -> Any:
            self.reads += 1
            started_s = time.perf_counter()
            try:
                return timed(*given, **named)
            finally:
                self.waited_s += time.perf_counter() - started_s

        return counted


@contextmanager
def watched(*, is_software: bool) -> Iterator[Watch]:
    """Watch what is asked of moderngl's objects meanwhile; ``is_software``: drawing is left out.

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
            return watch.drawing(call, is_timed=is_software)
        return watch.filling(call) if is_software and name.startswith(_OWN_FILLS) else call

    try:
        for kind, names in _DRAWS:
            for name in names:
                replace(kind, name, lambda own: watch.drawing(own, is_timed=is_software))
        for kind, names in _FILLS if is_software else ():
            for name in names:
                replace(kind, name, watch.filling)
        for kind, names in _READS:
            for name in names:
                replace(kind, name, watch.reading)
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
