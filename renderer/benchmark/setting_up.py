"""Set up one clip in this process, stage by stage, and tell what each took: JSON on stdout.

A program of its own (``python -m renderer.benchmark.setting_up LOD WIDTHxHEIGHT``): what a process
has made before, it keeps, so each measurement needs a fresh one.
"""

from __future__ import annotations

import importlib
import json
import sys
import time
from collections.abc import Callable
from typing import Any, Final, TypeVar

T = TypeVar("T")

# What ``renderer.scene.build_scene`` calls, and the stage that it is told as.
SCENE: Final = {
    "Surroundings": "surroundings",
    "Head": "head",
    "build_light": "light",
    "Crowd": "crowd",
}


class Stages:
    """Seconds by stage, in the order in which they began."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    def time(self, name: str, make: Callable[[], T]) -> T:
        """Make something and note how long it took."""
        self.seconds[name] = 0.0
        started = time.perf_counter()
        made = make()
        self.seconds[name] += time.perf_counter() - started
        return made

    def timed(self, name: str, make: Callable[..., T]) -> Callable[..., T]:
        """Return ``make`` as a stage."""
        return lambda *given, **named: self.time(name, lambda: make(*given, **named))


def set_up(lod: str, size: tuple[int, int]) -> dict[str, dict[str, float]]:
    """Return ``seconds`` by stage and ``bytes`` by kind after two frames of a LoD at macroscopic.

    Two equal eyes, as in a clip.
    """
    stages = Stages()
    frame = stages.time("modules", lambda: importlib.import_module("renderer.frame.frame"))
    # Imported now: importing is the first stage.
    from renderer import scene as scenes
    from renderer.benchmark.gl_memory import gl_bytes, resident_bytes
    from renderer.clip import ClipSpec
    from renderer.detail import Detail
    from renderer.gl.context import create_context

    detail = Detail.uniform(lod)
    spec = ClipSpec(left=detail, right=detail, width=size[0], height=size[1])
    gl = stages.time("context", create_context)
    for name, stage in SCENE.items():
        setattr(scenes, name, stages.timed(stage, getattr(scenes, name)))
    scene = scenes.build_scene(gl, spec)
    frames: Any = stages.time("targets", lambda: frame.FrameRenderer(gl, spec, scene=scene))
    stages.time("first frame", lambda: frames.render(0.0))
    stages.time("second frame", lambda: frames.render(1.0, time_s=1 / 30))
    held = gl_bytes(gl) | {"resident set": resident_bytes()}
    return {"seconds": stages.seconds, "bytes": {kind: float(held[kind]) for kind in held}}


if __name__ == "__main__":
    width, height = sys.argv[2].split("x")
    print(json.dumps(set_up(sys.argv[1], (int(width), int(height)))))
