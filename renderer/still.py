"""One frame as a picture: what ``ocularist still`` shows."""

from __future__ import annotations

from renderer.clip import ClipSpec
from renderer.context import create_context
from renderer.frame import FrameRenderer
from renderer.picture import Pixels


def render_still(
    spec: ClipSpec,
    azimuth_deg: float = 0.0,
    *,
    elevation_deg: float = 0.0,
    time_s: float = 0.0,
    wireframe: bool = False,
) -> Pixels:
    """Render one frame, (height, width, 3) uint8 sRGB, first row on top.

    ``wireframe`` draws the eyes' meshes as lines, which shows their tessellation.
    """
    gl = create_context()
    try:
        renderer = FrameRenderer(gl, spec, wireframe=wireframe)
        return renderer.render(azimuth_deg, time_s=time_s, elevation_deg=elevation_deg).pixels
    finally:
        gl.release()
