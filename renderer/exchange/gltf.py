"""Both eyes with every LoD as one glTF 2.0 file (.glb), for engines and viewers.

Metres, y up, z the gaze. Each eye is a node with its highest LoD in the scene and the others named
by MSFT_lod; the pupil's size is a morph target of the iris. What a LoD of ours computes becomes a
material there, what it stores a texture.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Final

import numpy as np
import pygltflib as gltf

from renderer.atomic_file import write_atomically
from renderer.clip import ClipSpec
from renderer.detail import STANDARD_LODS, Detail
from renderer.exchange.gltf_buffer import GltfBuffer
from renderer.exchange.gltf_materials import EXTENSIONS, LodMaterials, add_materials
from renderer.exchange.lod_meshes import (
    PUPIL_TARGETS_MM,
    LodMesh,
    iris_tangents,
    iris_targets,
    lod_meshes,
    sclera_tangents,
)
from renderer.exchange.meshes import Floats, Mesh
from renderer.eye.place import eye_centre_mm
from renderer.sources import code_version

METRES: Final = 1e-3  # per mm
SIDES: Final = ("left", "right")
# Iris diameter in pixels of 1920 x 1080 from which the next lower mesh errs by half a pixel.
NEEDED_FROM_PX: Final = {"ultra": 200.0, "high": 48.0, "medium": 14.0, "low": 0.0}


def write_eyes(path: Path, spec: ClipSpec) -> Path:
    """Write both eyes of a clip with the four standard LoDs into a .glb; return its path.

    The clip gives iris, pupil and gaze; its own LoDs do not matter.
    """
    document = gltf.GLTF2(
        asset=gltf.Asset(version="2.0", generator=f"Ocularist {code_version()}"),
        extensionsUsed=sorted([*EXTENSIONS, "MSFT_lod"]),
    )
    buffer = GltfBuffer(document)
    materials = {
        lod: add_materials(buffer, spec, Detail.uniform(lod), lod=lod) for lod in STANDARD_LODS
    }
    eyes = [_add_eye(buffer, spec, materials, eye=eye) for eye in (0, 1)]
    document.scenes.append(gltf.Scene(name="eyes", nodes=eyes))
    document.scene = 0
    buffer.finish()
    write_atomically(path, b"".join(document.save_to_bytes()))
    return path


def _add_eye(
    buffer: GltfBuffer, spec: ClipSpec, materials: dict[str, LodMaterials], *, eye: int
) -> int:
    """Add one eye with all LoDs; return its node's number."""
    side = SIDES[eye]
    lods = [
        _add_lod(buffer, spec, materials[lod], name=f"eye_{side}_{lod}", lod=lod, eye=eye)
        for lod in reversed(STANDARD_LODS)
    ]
    nodes = buffer.document.nodes
    highest = nodes[lods[0]]
    highest.extensions["MSFT_lod"] = {"ids": lods[1:]}
    highest.extras["MSFT_screencoverage"] = [
        round(screen_share(NEEDED_FROM_PX[lod]), 6) for lod in reversed(STANDARD_LODS)
    ]
    yaw, pitch = spec.gaze_deg(eye)
    return _add_node(
        buffer,
        gltf.Node(
            name=f"eye_{side}",
            translation=(eye_centre_mm(eye) * METRES).tolist(),
            rotation=gaze_quaternion(yaw, pitch),
            children=[lods[0]],
        ),
    )


def _add_lod(
    buffer: GltfBuffer, spec: ClipSpec, materials: LodMaterials, *, name: str, lod: str, eye: int
) -> int:
    is_right = eye == 1
    parts = lod_meshes(Detail.uniform(lod), pupil_mm=spec.pupil_mm, mirror=is_right)
    iris_names = {"targetNames": [f"pupil {target:g} mm" for target in PUPIL_TARGETS_MM]}
    iris = gltf.Mesh(
        name=f"{name}_iris",
        primitives=[_iris(buffer, parts, materials, pupil_mm=spec.pupil_mm, mirror=is_right)],
        weights=[0.0] * len(PUPIL_TARGETS_MM),
        extras={**iris_names, "pupil_mm": spec.pupil_mm},
    )
    white = _primitive(
        buffer,
        parts.sclera,
        materials.sclera,
        tangents=sclera_tangents(parts.sclera, mirror=is_right),
    )
    clear = [] if parts.cornea is None else [_primitive(buffer, parts.cornea, materials.cornea)]
    globe = gltf.Mesh(name=f"{name}_globe", primitives=[white, *clear])
    children = []
    for mesh in (globe, iris):
        buffer.document.meshes.append(mesh)
        number = len(buffer.document.meshes) - 1
        children.append(_add_node(buffer, gltf.Node(name=mesh.name, mesh=number)))
    return _add_node(buffer, gltf.Node(name=name, children=children))


def _iris(
    buffer: GltfBuffer, parts: LodMesh, materials: LodMaterials, *, pupil_mm: float, mirror: bool
) -> gltf.Primitive:
    primitive = _primitive(
        buffer, parts.iris, materials.iris, tangents=iris_tangents(parts.iris, mirror=mirror)
    )
    primitive.targets = [
        gltf.Attributes(POSITION=buffer.vectors(moved * METRES))
        for moved in iris_targets(parts.iris, pupil_mm=pupil_mm)
    ]
    return primitive


def _primitive(
    buffer: GltfBuffer, mesh: Mesh, material: int, *, tangents: Floats | None = None
) -> gltf.Primitive:
    attributes = gltf.Attributes(
        POSITION=buffer.vectors(mesh.positions * METRES), NORMAL=buffer.vectors(mesh.normals)
    )
    if mesh.uv is not None:
        attributes.TEXCOORD_0 = buffer.vectors(mesh.uv * [1.0, -1.0] + [0.0, 1.0])
    if tangents is not None:
        attributes.TANGENT = buffer.vectors(tangents)
    return gltf.Primitive(
        attributes=attributes, indices=buffer.indices(mesh.triangles), material=material
    )


def _add_node(buffer: GltfBuffer, node: gltf.Node) -> int:
    buffer.document.nodes.append(node)
    return len(buffer.document.nodes) - 1


def screen_share(iris_px: float) -> float:
    """Return the share of a 1920 x 1080 picture that a globe covers, two irises wide."""
    return math.pi * iris_px**2 / (1920 * 1080)


def gaze_quaternion(yaw_deg: float, pitch_deg: float) -> list[float]:
    """Return x, y, z, w of a turn by yaw to the viewer's right, then by pitch upwards."""
    yaw, pitch = math.radians(yaw_deg) / 2, -math.radians(pitch_deg) / 2
    turn_y = np.array([0.0, math.sin(yaw), 0.0, math.cos(yaw)])
    turn_x = np.array([math.sin(pitch), 0.0, 0.0, math.cos(pitch)])
    vector = turn_y[3] * turn_x[:3] + turn_x[3] * turn_y[:3] + np.cross(turn_y[:3], turn_x[:3])
    return [*vector.tolist(), float(turn_y[3] * turn_x[3] - turn_y[:3] @ turn_x[:3])]
