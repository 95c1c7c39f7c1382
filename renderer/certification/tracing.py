"""Path-trace the twin: a picture in soft light, with its own noise measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from renderer.certification.environments import LAT_LONG_PX, SoftEnvironment
from renderer.certification.view import TARGET_MM, View

Picture = npt.NDArray[np.float64]

DEPTH: Final = 12  # of a path; each bounce between iris and cornea takes two


@dataclass(frozen=True)
class Reference:
    """A traced picture (n, n, 3), linear radiance, and the half difference of its two halves."""

    picture: Picture
    noise: Picture


def trace_picture(
    mi: Any,
    shapes: dict[str, Any],
    environment: SoftEnvironment,
    *,
    view: View,
    spp: int,
    seed: int = 0,
) -> Reference:
    """Trace a view of shapes in an environment with ``spp`` paths per pixel, in two halves."""
    scene = mi.load_dict(
        {
            "type": "scene",
            "integrator": {
                "type": "path",
                "max_depth": DEPTH,
                "rr_depth": DEPTH,
                "hide_emitters": True,  # black around the eye, as ours
            },
            "sensor": _camera(mi, view),
            "environment": emitter(mi, environment),
            **shapes,
        }
    )
    first, second = (
        np.asarray(mi.render(scene, spp=spp // 2, seed=2 * seed + half), dtype=np.float64)[..., :3]
        for half in (0, 1)
    )
    return Reference(0.5 * (first + second), 0.5 * (first - second))


def emitter(mi: Any, environment: SoftEnvironment) -> dict[str, Any]:
    """Return the environment as the path tracer's picture of all directions.

    Its columns run from -z over +x (measured; the middle column looks along +z), its rows from +y
    down.
    """
    height, width = LAT_LONG_PX, 2 * LAT_LONG_PX
    down = (np.arange(height) + 0.5) / height * np.pi
    around = (np.arange(width) + 0.5) / width * 2 * np.pi
    turn, polar = np.meshgrid(around, down)
    directions = np.stack(
        [np.sin(turn) * np.sin(polar), np.cos(polar), -np.cos(turn) * np.sin(polar)], axis=-1
    )
    radiance = environment.radiance(directions.reshape(-1, 3)).reshape(height, width, 3)
    return {"type": "envmap", "bitmap": mi.Bitmap(radiance.astype(np.float32))}


def _camera(mi: Any, view: View) -> dict[str, Any]:
    return {
        "type": "perspective",
        "fov": view.fov_deg,
        "fov_axis": "y",
        "near_clip": 1.0,
        "to_world": mi.ScalarTransform4f().look_at(
            origin=view.camera_mm.tolist(), target=TARGET_MM.tolist(), up=[0.0, 1.0, 0.0]
        ),
        "film": {
            "type": "hdrfilm",
            "width": view.size_px,
            "height": view.size_px,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
            "component_format": "float32",
        },
        "sampler": {"type": "multijitter"},
    }
