"""``ocularist inspect``: look into the scene through a local page."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from study.commands.errors import CommandError
from study.commands.eye_arguments import add_lod_policy, add_picture
from study.commands.eye_options import policy_of, spec_of, viewpoint_of
from study.commands.values import port

if TYPE_CHECKING:
    from renderer.clip import ClipSpec
    from renderer.inspection import Inspector, Shot, Viewpoint
    from study.inspection.look import Look

HELP = "look around the scene on a local page"
DESCRIPTION = (
    "Serve a page for this machine's browser: drag to orbit, wheel for distance, keys for each "
    "effect's level or for LoDs by size, wire frame, counters of time and triangles, and the scene "
    "from above. The options say with which eyes, light and place it starts. Participants never "
    "see this."
)
EXAMPLE = "--left medium --right ultra"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_picture(parser)
    parser.set_defaults(size=(1280, 720))
    add_lod_policy(parser, used_by="for eyes that take their LoD from their size (key B)")
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

    from renderer.gl.context import create_context
    from study.commands.listening import address_of, check_port
    from study.commands.options import settings_of
    from study.inspection.app import create_inspection

    base, policy = spec_of(options), policy_of(options.lod_policy)
    settings = settings_of(options)
    check_port(settings)
    create_context().release()  # a machine without GL is told here, not by a page without pictures
    address = address_of(settings)
    hosts = ("localhost", "127.0.0.1", "[::1]", options.host, socket.gethostname())
    print(f"Look around at {address}/\n  stop          Ctrl-C", flush=True)
    uvicorn.run(
        create_inspection(base, Desk, policy=policy, first=first_look(options, base), hosts=hosts),
        host=settings.host,
        port=settings.port,
        log_level="warning",
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=2,
    )
    return 0


def first_look(options: argparse.Namespace, base: ClipSpec) -> Look:
    """Return what the page shows first: the options' levels, distance and viewpoint."""
    from renderer.camera import IRIS_PX
    from study.inspection.look import STEEPEST_DEG, Look, code_of

    place = viewpoint_of(options, base)
    if abs(place["elevation_deg"]) > STEEPEST_DEG:
        raise CommandError(
            f"--elevation {place['elevation_deg']:g}: the page's camera goes up and down to "
            f"{STEEPEST_DEG:g} degrees"
        )
    return Look(
        left=code_of(base.left),
        right=code_of(base.right),
        azimuth=(place["azimuth_deg"] + 180.0) % 360.0 - 180.0,
        elevation=place["elevation_deg"],
        time=place["time_s"],
        distance=IRIS_PX[base.distance],
        eyes="halves" if base.distance == "macroscopic" else "both",
    )


class Told:
    """A shot as the page is told of it."""

    def __init__(self, shot: Shot, marks: dict[str, Any]) -> None:
        self.pixels = shot.pixels
        self.facts: dict[str, object] = {
            "ms": round(shot.frame_ms, 2),
            "triangles": shot.triangles,
            "iris_px": shot.iris_px,
            "visible_px": shot.visible_px,
            "lods": shot.lods,
            "marks": marks,
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
        """Draw the eyes; tell where the camera stands on the scene from above."""
        return Told(self._inspector.shot(spec, camera_of(look)), _marks(spec, look))

    def overhead(self, spec: ClipSpec, look: Look) -> Told:
        """Draw the scene from above, with the camera's place on it."""
        return Told(self._inspector.overhead(spec, camera_of(look)), _marks(spec, look))

    def close(self) -> None:
        """Give the renderer's context back."""
        self._inspector.close()


def _marks(spec: ClipSpec, look: Look) -> dict[str, Any]:
    """Return where the scene from above shows camera and eyes, and how far around them it reaches.

    Its picture stays while ``reach_mm`` does.
    """
    from renderer.camera import radius_of_px, views
    from renderer.overhead import on_picture, overhead_view, reach_mm

    reach = reach_mm(radius_of_px(look.distance))
    above = overhead_view(spec, reach_mm=reach)
    cameras = views(spec, look.azimuth, look.elevation, distance_px=look.distance)
    return {
        "reach_mm": reach,
        "camera": on_picture(above, cameras[0].position_mm),
        "eyes": on_picture(above, (0.0, 0.0, 0.0)),
    }


def camera_of(look: Look) -> Viewpoint:
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
