"""``ocularist inspect``: look into the scene through a local page."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from study.commands.eye_arguments import add_picture
from study.commands.eye_options import spec_of
from study.commands.values import port

if TYPE_CHECKING:
    from renderer.clip import ClipSpec
    from renderer.inspection import Inspector, Shot, Viewpoint
    from study.inspection.look import Look

HELP = "look around the scene on a local page"
DESCRIPTION = (
    "Serve a page for this machine's browser: drag to orbit, wheel for distance, keys for each "
    "effect's level, wire frame, counters of time and triangles, and the scene from above. The "
    "options say which eyes and which light it starts with. Participants never see this."
)
EXAMPLE = "--left medium --right ultra"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_picture(parser)
    parser.set_defaults(size=(1280, 720))
    parser.add_argument(
        "--host", default="127.0.0.1", help="address to listen on (default: %(default)s)"
    )
    parser.add_argument(
        "--port", type=port, default=8020, help="port to listen on (default: %(default)s)"
    )


def run(options: argparse.Namespace) -> int:
    """Serve until stopped by Ctrl-C or SIGTERM."""
    import socket

    import uvicorn

    from study.commands.listening import address_of, check_port
    from study.commands.options import settings_of
    from study.inspection.app import create_inspection

    base = spec_of(options)
    settings = settings_of(options)
    check_port(settings)
    address = address_of(settings)
    hosts = ("localhost", "127.0.0.1", "[::1]", options.host, socket.gethostname())
    print(f"Look around at {address}/\n  stop          Ctrl-C", flush=True)
    uvicorn.run(
        create_inspection(base, Desk, hosts=hosts),
        host=settings.host,
        port=settings.port,
        log_level="warning",
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=2,
    )
    return 0


class Told:
    """A shot as the page is told of it."""

    def __init__(self, shot: Shot, marks: dict[str, Any] | None = None) -> None:
        self.pixels = shot.pixels
        self.facts: dict[str, object] = {
            "ms": round(shot.frame_ms, 2),
            "triangles": shot.triangles,
            "iris_px": shot.iris_px,
            "visible_px": shot.visible_px,
            "lods": shot.lods,
            "marks": marks or {},
        }


class Desk:
    """The renderer's inspector at the page's service."""

    def __init__(self) -> None:
        from renderer.inspection import Inspector
        from renderer.studio import Studio

        self._inspector: Inspector = Inspector(Studio())

    @property
    def gl_renderer(self) -> str:
        """The name of what draws."""
        return self._inspector.gl_renderer

    def shot(self, spec: ClipSpec, look: Look) -> Told:
        """Draw the eyes."""
        return Told(self._inspector.shot(spec, viewpoint_of(look)))

    def overhead(self, spec: ClipSpec, look: Look) -> Told:
        """Draw the scene from above, with the camera's place on it."""
        from renderer.camera import views
        from renderer.inspection import on_picture, overhead_view

        viewpoint = viewpoint_of(look)
        above = overhead_view(spec)
        cameras = views(
            spec, viewpoint.azimuth_deg, viewpoint.elevation_deg, distance_px=viewpoint.distance_px
        )
        marks = {
            "camera": on_picture(above, cameras[0].position_mm),
            "eyes": on_picture(above, (0.0, 0.0, 0.0)),
        }
        return Told(self._inspector.overhead(spec, viewpoint), marks)

    def close(self) -> None:
        """Give the renderer's context back."""
        self._inspector.close()


def viewpoint_of(look: Look) -> Viewpoint:
    """Return the camera that the page asks for."""
    from renderer.inspection import Viewpoint
    from study.inspection.look import EYES

    return Viewpoint(
        azimuth_deg=look.azimuth,
        elevation_deg=look.elevation,
        distance_px=look.distance,
        time_s=look.time,
        eyes=EYES[look.eyes],
        wireframe=look.wireframe,
    )
