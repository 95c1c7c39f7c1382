"""Set up one clip in this process, stage by stage, and tell what each took: JSON on stdout.

A program of its own (``python -m renderer.benchmark.setting_up LOD WIDTHxHEIGHT``): what a process
has made before, it keeps, so each measurement needs a fresh one. Its stages are those of
``renderer.scene.build_scene`` and ``renderer.frame.FrameRenderer``.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")


def set_up(lod: str, size: tuple[int, int]) -> dict[str, dict[str, float]]:
    """Return ``seconds`` by stage and ``bytes`` by kind after two frames of a LoD at macroscopic.

    Two equal eyes, as in a clip.
    """
    seconds: dict[str, float] = {}

    def stage(name: str, make: Callable[[], T]) -> T:
        started = time.perf_counter()
        made = make()
        seconds[name] = time.perf_counter() - started
        return made

    parts = stage("modules", _import)
    spec = parts.clip(lod, size)
    gl = stage("context", parts.create_context)
    surroundings = stage("surroundings", lambda: parts.surroundings(gl, spec))
    head = stage("head", lambda: parts.head(gl, spec))
    light = stage("light", lambda: parts.light(gl, surroundings.sky, head))
    crowd = stage("crowd", lambda: parts.crowd(gl, spec, light))
    scene = parts.scene(parts.key(spec), surroundings, head, light, crowd)
    frames = stage("eyes", lambda: parts.frames(gl, spec, scene=scene))
    stage("first frame", lambda: frames.render(0.0))
    stage("second frame", lambda: frames.render(1.0, time_s=1 / 30))
    held = parts.gl_bytes(gl) | {"resident set": parts.resident_bytes()}
    return {"seconds": seconds, "bytes": held}


def _import() -> Any:
    """Import the renderer, which takes its time too, and return what setting up calls."""
    from types import SimpleNamespace

    from renderer.benchmark.gl_memory import gl_bytes, resident_bytes
    from renderer.clip import ClipSpec
    from renderer.context import create_context
    from renderer.crowd.crowd import Crowd
    from renderer.detail import Detail
    from renderer.frame import FrameRenderer
    from renderer.head.head import Head
    from renderer.head.sun_shadow import build_light
    from renderer.park.surroundings import Surroundings
    from renderer.scene import Scene, scene_key

    def clip(lod: str, size: tuple[int, int]) -> ClipSpec:
        detail = Detail.uniform(lod)
        return ClipSpec(left=detail, right=detail, width=size[0], height=size[1])

    return SimpleNamespace(
        clip=clip,
        create_context=create_context,
        surroundings=Surroundings,
        head=Head,
        light=build_light,
        crowd=Crowd,
        scene=Scene,
        key=scene_key,
        frames=FrameRenderer,
        gl_bytes=gl_bytes,
        resident_bytes=resident_bytes,
    )


if __name__ == "__main__":
    width, height = sys.argv[2].split("x")
    print(json.dumps(set_up(sys.argv[1], (int(width), int(height)))))
