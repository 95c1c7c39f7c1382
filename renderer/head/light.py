"""What a scene's sky does to the head's surfaces, baked once per sky.

How free each direction is depends on the head alone and is kept in the cache.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, Final

import moderngl
import numpy as np

from renderer.body.makehuman import Floats
from renderer.cache import cached_arrays
from renderer.head.corner_light import light_corner
from renderer.head.face_mesh import FaceMesh
from renderer.head.skin_light import SkinLight, light_skin
from renderer.head.skin_part import seam
from renderer.head.sky_visibility import Draw, Region, Visible, look_up, sky_visibility
from renderer.head.strands import StrandMesh
from renderer.head.surfaces import Surface
from renderer.light import Light

SUN_LIFT_MM: Final = 0.35  # off the surface, twice: along its normal and towards the sun
HEAD_REGION: Final = ((0.0, -30.0, -50.0), 190.0)
EYE_REGIONS: Final = (((-31.0, 0.0, 8.0), 34.0), ((31.0, 0.0, 8.0), 34.0))
BODY_REGION: Final = ((0.0, -350.0, -50.0), 520.0)


def open_sky(
    gl: moderngl.Context, surfaces: Mapping[str, Surface], *, whole: Draw, without_lids: Draw
) -> dict[str, Visible]:
    """Return for each surface by name how free (n, DIRECTIONS) its directions are, 0 to 1.

    Lids and corners change with gaze and blink, the rest does not: they are kept apart, and the
    rest sees sockets without lids. ``whole`` and ``without_lids`` draw the head's depth.
    """
    lids = [name for name in surfaces if name.startswith(("patch", "corner"))]
    fixed = {name: item for name, item in surfaces.items() if name not in lids}
    fixed_plan = [
        (HEAD_REGION, ("fine", "rest", "coarse", "cap")),
        *((place, ("fine",)) for place in EYE_REGIONS),
        (BODY_REGION, ("cloth",)),
    ]
    lid_plan = [(place, (f"patch{eye}", f"corner{eye}")) for eye, place in enumerate(EYE_REGIONS)]
    return _kept_sky(gl, without_lids, fixed, plan=fixed_plan, key=_digest(fixed)) | _kept_sky(
        gl, whole, surfaces, plan=lid_plan, key=_digest(surfaces)
    )


Plan = Iterable[tuple[tuple[tuple[float, float, float], float], tuple[str, ...]]]


def _kept_sky(
    gl: moderngl.Context, draw: Draw, surfaces: Mapping[str, Surface], *, plan: Plan, key: str
) -> dict[str, Visible]:
    def make() -> dict[str, Any]:
        regions = [
            Region(
                centre,
                half,
                {name: (surfaces[name].points_mm, surfaces[name].normals) for name in names},
            )
            for (centre, half), names in plan
        ]
        free = sky_visibility(gl, draw, regions)
        return {name: np.round(share * 255).astype(np.uint8) for name, share in free.items()}

    named = ", ".join(sorted({name for _, names in plan for name in names}))
    kept = cached_arrays(f"open sky over {named} {key}", make)
    return {
        name: np.asarray(share, dtype=np.float32) / np.float32(255) for name, share in kept.items()
    }


def _digest(surfaces: Mapping[str, Surface]) -> str:
    """Name the shapes: the same surfaces leave the same sky open."""
    digest = hashlib.sha256()
    for name, item in sorted(surfaces.items()):
        digest.update(name.encode())
        digest.update(np.ascontiguousarray(item.points_mm).tobytes())
        digest.update(np.ascontiguousarray(item.triangles).tobytes())
    return digest.hexdigest()


def light_surfaces(
    surfaces: Mapping[str, Surface], light: Light, free: Mapping[str, Visible], *, face: FaceMesh
) -> None:
    """Bake a light into every surface's vertex buffers."""
    depth, matrix = _shadow(light)
    without_sun = replace(light.sky, sun_irradiance=np.zeros(3))
    lights: dict[str, SkinLight] = {}
    for name, item in surfaces.items():
        lifted = item.points_mm + SUN_LIFT_MM * (item.normals + light.sky.sun_direction)
        sun = look_up(depth, matrix, lifted, radius_px=2).astype(float)
        if name.startswith("corner"):
            eye = int(name[-1])
            lights[name] = light_corner(
                item.points_mm,
                item.normals,
                item.triangles,
                eye=eye,
                pose=face.lids[eye].pose,
                sky=light.sky,
                sun=sun,
            )
            continue
        lights[name] = light_skin(
            item.points_mm,
            item.normals,
            item.triangles,
            # Wool has no scattered sun to bake: its shader looks the shadow up per pixel.
            sky=light.sky if item.is_skin else without_sun,
            open_sky=free[name],
            sun=sun,
        )
    for eye in (0, 1):
        join = seam(face.patches[eye], face.fine)
        own, beside = lights[f"patch{eye}"], lights["fine"]
        lights[f"patch{eye}"] = SkinLight(
            join.blend(own.diffuse, beside.diffuse),
            join.blend(own.ambient, beside.ambient),
            join.blend(own.sun, beside.sun),
        )
    # The ribbons shine, not the mass of the hair beneath.
    cap = lights["cap"]
    lights["cap"] = SkinLight(cap.diffuse, 0.3 * cap.ambient, 0.0 * cap.sun)
    for name, item in surfaces.items():
        item.write_light(lights[name].diffuse, lights[name].ambient, lights[name].sun)


def light_strands(strands: Iterable[tuple[StrandMesh, float]], light: Light) -> None:
    """Bake the sun into hairs; each mesh comes with its shadow bias in mm."""
    depth, matrix = _shadow(light)
    for mesh, bias_mm in strands:
        lifted = mesh.points_mm + bias_mm * light.sky.sun_direction
        mesh.write_sun(look_up(depth, matrix, lifted, radius_px=1))


def _shadow(light: Light) -> tuple[Visible, Floats]:
    """Return the light's depth map (size, size) and its world-to-clip matrix."""
    size = light.shadow_map.size[0]
    depth = np.frombuffer(light.shadow_map.read(), dtype=np.float32).reshape(size, size)
    return depth, np.asarray(light.world_to_shadow, dtype=float)
