"""What ``ocularist export-scene`` does: build the scene of a still once, write it as asked."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from renderer.clip import ClipSpec
from renderer.exchange.gltf import write_eyes
from renderer.exchange.scene_files import write_scene
from renderer.frame.frame import FrameRenderer
from renderer.gl.context import create_context


def export_scene(
    folder: Path,
    spec: ClipSpec,
    *,
    what: str = "all",
    azimuth_deg: float = 0.0,
    elevation_deg: float = 0.0,
    time_s: float = 0.0,
) -> Iterator[Path]:
    """Write a scene into a folder and yield the files to open first.

    ``what`` is "files" (meshes, textures, camera, light), "gltf" (both eyes with all LoDs), "all".
    """
    if what in ("all", "files"):
        gl = create_context()
        try:
            yield write_scene(
                folder,
                FrameRenderer(gl, spec),
                azimuth_deg=azimuth_deg,
                elevation_deg=elevation_deg,
                time_s=time_s,
            )
        finally:
            gl.release()
    if what in ("all", "gltf"):
        yield write_eyes(folder / "eyes.glb", spec)
