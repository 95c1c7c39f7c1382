"""How long a GPU itself works on a frame, apart from the processor that hands the frame over.

A timer query tells the time from a frame's first command to its last. On an idle GPU that counts
every pause in which the GPU waits for Python's next command: it would tell the processor's time. So
the GPU is given a load first that lasts until the whole frame has been handed over; then it works
off the frame's commands without a pause. A fence behind the load says whether that came true.
"""

from __future__ import annotations

import ctypes
import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import moderngl

from renderer.gl.functions import gl_function
from renderer.gl.program import build_program

SIDE: Final = 1024  # pixels of the load's target
LAYERS: Final = 64  # how often its first load covers it
LAYERS_MOST: Final = 1 << 20
SPARE: Final = 2.0  # a load lasts so many times as long as handing over is expected to take
LONGEST_MS: Final = 300.0  # drivers stop a GPU that answers nobody for seconds
TRIES: Final = 3
_FENCE: Final = 0x9117  # GL_SYNC_GPU_COMMANDS_COMPLETE
_NOT_YET: Final = 0x911B  # GL_TIMEOUT_EXPIRED


@dataclass(frozen=True)
class GpuTime:
    """``ms`` of a frame by the GPU's clock; ``has_gaps``: it counts waiting for commands too."""

    ms: float
    has_gaps: bool


class GpuTimer:
    """Time what a function submits. It may run up to TRIES times, told which try it is."""

    def __init__(self, gl: moderngl.Context, *, side: int = SIDE) -> None:
        self.gl = gl
        self._program = build_program(gl, "screen.vert", fragment="busy.frag")
        self._screen = gl.vertex_array(self._program.gl_program, [])
        self._target = gl.framebuffer([gl.texture((side, side), 4, dtype="f2")])
        self._layer_ms = 0.0  # not known yet
        self._handing_ms = 0.0

    def time(self, submit: Callable[[int], None]) -> GpuTime:
        """Return the GPU's time for what ``submit`` hands over."""
        found = GpuTime(math.inf, True)
        for number in range(TRIES):
            found = self._try(submit, number)
            if not found.has_gaps:
                return found
        self._handing_ms = 0.0  # whoever waits for the GPU is never ahead of it: start small again
        return found

    def _try(self, submit: Callable[[int], None], number: int) -> GpuTime:
        self.gl.finish()
        layers = self._layers()
        before = self._busy(layers)
        fence = _Fence()
        started = time.perf_counter()
        spent = self.gl.query(time=True)
        with spent:
            submit(number)
        fence.flush()
        has_gaps = fence.is_passed()
        self._handing_ms = (time.perf_counter() - started) * 1e3
        fence.release()
        ms = _elapsed_ms(spent)
        self._layer_ms = max(_elapsed_ms(before) / layers, 1e-6)
        return GpuTime(ms, has_gaps)

    def _layers(self) -> int:
        """Return how many layers last until a frame is handed over, as the last one took."""
        if not self._layer_ms:
            return LAYERS
        wanted_ms = min(SPARE * self._handing_ms, LONGEST_MS)
        return min(max(math.ceil(wanted_ms / self._layer_ms), LAYERS), LAYERS_MOST)

    def _busy(self, layers: int) -> moderngl.Query:
        """Draw so many layers over each other, whose sum nothing may leave out; return the time."""
        spent = self.gl.query(time=True)
        with self.gl.scope(self._target, moderngl.BLEND), spent:
            self.gl.blend_func = moderngl.ONE, moderngl.ONE
            self._screen.render(moderngl.TRIANGLES, vertices=3, instances=layers)
            self.gl.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA  # the usual
        return spent


def _elapsed_ms(query: moderngl.Query) -> float:
    return int(query.elapsed) / 1e6


class _Fence:
    """A mark in the stream of commands, behind those given so far."""

    def __init__(self) -> None:
        make = gl_function("glFenceSync", ctypes.c_uint, ctypes.c_uint, result=ctypes.c_void_p)
        self._mark = make(_FENCE, 0)

    def flush(self) -> None:
        """Hand over what the driver still keeps back."""
        gl_function("glFlush")()

    def is_passed(self) -> bool:
        """Say whether the GPU has done everything before the mark."""
        ask = gl_function(
            "glClientWaitSync",
            ctypes.c_void_p,
            ctypes.c_uint,
            ctypes.c_uint64,
            result=ctypes.c_uint,
        )
        return bool(ask(self._mark, 0, 0) != _NOT_YET)

    def release(self) -> None:
        """Forget the mark."""
        gl_function("glDeleteSync", ctypes.c_void_p)(self._mark)
