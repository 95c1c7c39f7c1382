"""A whole scene as files for other renderers and engines: meshes, maps, camera, light, an index.

``scene.json`` names every file with its unit, space and encoding; README.txt tells it to people.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from renderer.atomic_file import write_atomically
from renderer.detail import Detail
from renderer.exchange.camera_file import cameras
from renderer.exchange.drawn import crowd_meshes, hair_meshes, head_meshes
from renderer.exchange.environment_file import CUBE_PX, lat_long_of
from renderer.exchange.exr import write_exr
from renderer.exchange.eye_parts import cornea_and_sclera, iris_disc, iris_relief
from renderer.exchange.materials import MATERIALS, material_of
from renderer.exchange.meshes import Mesh, write_ply
from renderer.exchange.readme import README
from renderer.exchange.textures import write_maps
from renderer.eye.model import EyeModel
from renderer.frame.frame import FrameRenderer
from renderer.frame.picture import EXPOSURE
from renderer.gl.context import identify
from renderer.iris.source import iris_of
from renderer.sources import code_version

INDEX: Final = "scene.json"
FORMAT: Final = "ocularist-scene"
VERSION: Final = 1
SIDES: Final = ("left", "right")

Entry = dict[str, Any]


def write_scene(
    folder: Path,
    renderer: FrameRenderer,
    *,
    azimuth_deg: float = 0.0,
    elevation_deg: float = 0.0,
    time_s: float = 0.0,
) -> Path:
    """Write everything that a frame shows into a folder; return the index's path."""
    folder.mkdir(parents=True, exist_ok=True)
    spec, sky = renderer.spec, renderer.scene.light.sky
    models = renderer.eye_models
    meshes = [
        _write_mesh(folder, name, mesh) for name, mesh in scene_meshes(renderer, time_s=time_s)
    ]
    textures = [entry for eye in (0, 1) for entry in _write_textures(folder, renderer, eye)]
    surroundings = renderer.scene.surroundings.cube(CUBE_PX)
    write_exr(folder / "environment.exr", lat_long_of(renderer.gl, surroundings), half=True)
    _write_json(folder / "camera.json", cameras(spec, azimuth_deg, elevation_deg))
    index = {
        "format": FORMAT,
        "version": VERSION,
        "unit": "mm",
        "axes": "right-handed: x to the viewer's right, y up, z from the face to the viewer; the "
        "origin midway between the globes' centres",
        "colour": "linear Rec. 709 (D65) unless an entry says sRGB",
        "clip": spec.to_dict(),
        "clip_id": spec.clip_id,
        "time_s": time_s,
        "code_version": code_version(),
        "gl_renderer": identify(renderer.gl).renderer,
        "camera": "camera.json",
        "exposure": {"scale": EXPOSURE, "meaning": "radiance times this goes into the tone curve"},
        "sun": {
            "direction_to_sun": np.asarray(sky.sun_direction).tolist(),
            "irradiance": np.asarray(sky.sun_irradiance).tolist(),
            "angular_radius_deg": 0.27,
            "meaning": "irradiance on a surface that faces the sun; not in the environment's file",
        },
        "environment": {
            "file": "environment.exr",
            "encoding": "linear radiance, Rec. 709",
            "layout": "latitude-longitude: first row y up, middle column z, left half x",
        },
        "materials": MATERIALS,
        "iris_gain": {
            side: np.asarray(model.values["u_iris_gain"]).tolist()
            for side, model in zip(SIDES, models, strict=True)
        },
        "meshes": meshes,
        "textures": textures,
    }
    _write_json(folder / INDEX, index)
    write_atomically(folder / "README.txt", README.encode())
    return folder / INDEX


def scene_meshes(renderer: FrameRenderer, *, time_s: float = 0.0) -> Iterator[tuple[str, Mesh]]:
    """Yield every mesh of a scene by name, in world space in mm."""
    for eye, side in enumerate(SIDES):
        for name, mesh in eye_meshes(renderer, eye):
            yield f"{name}_{side}", mesh
    yield from head_meshes(renderer.scene.head)
    yield from hair_meshes(renderer.scene.head)
    yield from crowd_meshes(renderer.scene.crowd, time_s)


def eye_meshes(renderer: FrameRenderer, eye: int) -> Iterator[tuple[str, Mesh]]:
    """Yield one eye's parts by name, in world space in mm."""
    spec, model = renderer.spec, renderer.eye_models[eye]
    matrix, is_right = np.asarray(model.values["u_eye_to_world"], dtype=np.float64), eye == 1
    cornea, sclera = cornea_and_sclera(mirror=is_right)
    height = _height_mm(renderer, eye)
    parts = {
        "cornea": cornea,
        "sclera": sclera,
        "iris": iris_disc(pupil_mm=spec.pupil_mm, mirror=is_right),
        "iris_relief": iris_relief(height, pupil_mm=spec.pupil_mm, mirror=is_right),
    }
    for name, mesh in parts.items():
        yield name, mesh.placed(matrix)


def _write_mesh(folder: Path, name: str, mesh: Mesh) -> Entry:
    path = folder / "meshes" / f"{name}.ply"
    write_ply(path, mesh, comment=f"Ocularist {name}, mm, world space")
    return {
        "name": name,
        "file": path.relative_to(folder).as_posix(),
        "unit": "mm",
        "space": "world",
        "vertices": len(mesh.positions),
        "triangles": len(mesh.triangles),
        "bounds": mesh.bounds,
        "material": material_of(name),
    }


def _write_textures(folder: Path, renderer: FrameRenderer, eye: int) -> Iterator[Entry]:
    model: EyeModel = renderer.eye_models[eye]
    place, side = folder / "textures", SIDES[eye]
    for entry in write_maps(place, model.values, suffix=side, root=folder):
        yield {"eye": side, **entry}
    height = _height_mm(renderer, eye)
    path = place / f"iris_height_{side}.exr"
    write_exr(path, height[::-1], channels=("height_mm",))
    yield {
        "eye": side,
        "file": path.relative_to(folder).as_posix(),
        "size_px": list(height.shape[::-1]),
        "channels": ["height_mm"],
        "encoding": "linear",
        "on": "iris plane",
        "meaning": "relief in mm above its lowest point; its mean lies on the iris plane",
    }


def _height_mm(renderer: FrameRenderer, eye: int) -> Any:
    spec = renderer.spec
    detail: Detail = (spec.left, spec.right)[eye]
    size = int(detail.setting("texture", "iris_map_px"))
    return iris_of(spec).maps(size).height_mm


def _write_json(path: Path, values: Entry) -> None:
    write_atomically(path, (json.dumps(values, indent=1) + "\n").encode())
