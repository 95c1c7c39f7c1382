"""One frame as a picture: what ``ocularist still`` shows."""

from __future__ import annotations

import json
from pathlib import Path

from PIL import Image

from renderer.clip import ClipSpec
from renderer.crowd.group import GroupRenderer
from renderer.exchange.exr import Attribute, write_exr
from renderer.frame.frame import FrameRenderer
from renderer.frame.picture import EXPOSURE
from renderer.gl.context import create_context, identify
from renderer.lod.choice import LodPolicy
from renderer.sources import code_version


def write_still(
    path: Path,
    spec: ClipSpec,
    *,
    azimuth_deg: float = 0.0,
    elevation_deg: float = 0.0,
    time_s: float = 0.0,
    wireframe: bool = False,
    view: str = "face",
    policy: LodPolicy | None = None,
) -> None:
    """Render one frame into a file; see ``write_frame``.

    ``wireframe`` draws the eyes' meshes as lines, which shows their tessellation. ``view`` "crowd"
    shows the other characters in rows (``renderer.crowd.group``) instead of the main one;
    ``policy`` then chooses their eyes' LoDs.
    """
    gl = create_context()
    try:
        renderer = (
            GroupRenderer(gl, spec, policy=policy)
            if view == "crowd"
            else FrameRenderer(gl, spec, wireframe=wireframe)
        )
        write_frame(
            path,
            renderer,
            azimuth_deg=azimuth_deg,
            elevation_deg=elevation_deg,
            time_s=time_s,
        )
    finally:
        gl.release()


def write_frame(
    path: Path,
    renderer: FrameRenderer | GroupRenderer,
    *,
    azimuth_deg: float = 0.0,
    elevation_deg: float = 0.0,
    time_s: float = 0.0,
) -> None:
    """Render one frame into a file: ``.exr`` gets linear radiance, any other name the picture.

    The radiance is scene-referred Rec. 709, before exposure, bloom and tone curve; the file's
    attributes say what it shows and what drew it.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    viewpoint = {"elevation_deg": elevation_deg, "time_s": time_s}
    if path.suffix != ".exr":
        Image.fromarray(renderer.render(azimuth_deg, **viewpoint).pixels).save(path)
        return
    identity = identify(renderer.gl)
    attributes: dict[str, Attribute] = {
        "software": "Ocularist",
        "comments": "linear scene-referred radiance; a white Lambertian surface facing the sun "
        "leaves with about 1",
        "spec": json.dumps(renderer.spec.to_dict(), sort_keys=True),
        "clip_id": renderer.spec.clip_id,
        "azimuth_deg": azimuth_deg,
        **viewpoint,
        "exposure": EXPOSURE,
        "code_version": code_version(),
        "gl_renderer": identity.renderer,
        "gl_version": identity.version,
    }
    write_exr(path, renderer.render_radiance(azimuth_deg, **viewpoint), attributes=attributes)
