"""The eye as the path tracer has it: the same surface, index, iris and sclera, and nothing else.

A smooth dielectric front whose limbus turns into sclera by the same clear share; an iris disc at
the same depth with the same colours; no relief, no lids, no head. Eye space in millimetres.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from renderer.clip import ClipSpec
from renderer.eye.anatomy import (
    CORNEA_IOR,
    GLOBE_RADIUS_MM,
    IRIS_MAP_RADIUS_MM,
    IRIS_Z_MM,
    PROFILE_END_MM,
)
from renderer.eye.flat_iris import flat_iris, plane_points
from renderer.eye.model import APPARENT_GAIN
from renderer.eye.optics import cornea_share, fresnel, surface_height, surface_normal
from renderer.eye.sclera import sclera_maps
from renderer.iris.source import iris_of
from renderer.textures.easing import ease

Array = npt.NDArray[np.float64]

RINGS: Final = 240  # 0.035 mm apart over the cornea
SEGMENTS: Final = 256
BACK_DEG: Final = 130.0
IRIS_PLANE_MM: Final = 7.05  # the iris plane meets the globe's inside at 7.08 mm
IRIS_PX: Final = 1400  # 0.01 mm: finer than the map that it is drawn from
SCLERA_PX: Final = 512
SCLERA_EDGE: Final = math.radians(110.0)  # where the sclera's maps end
ROOT_EDGE_MM: Final = 0.35  # half the width over which the root fades into limbal tissue
LIMBAL_TISSUE: Final = np.array([0.085, 0.07, 0.06])


def eye_shapes(mi: Any, iris: Array, sclera: Array) -> dict[str, Any]:
    """Return the eye's shapes for a scene.

    ``iris`` (n, n, 3) and ``sclera`` (m, m, 3) are linear reflectances; row 0 at the lower edge.
    """
    return {
        "front": front_mesh(mi, _front_material(mi, sclera)),
        "iris": iris_mesh(mi, _diffuse(mi, iris)),
    }


def iris_reflectance(spec: ClipSpec) -> Array:
    """Return the flat iris that the renderer draws from its maps: the shader's steps in numpy.

    (IRIS_PX, IRIS_PX, 3) over the square of half side IRIS_PLANE_MM.
    """
    map_px = int(spec.left.setting("texture", "iris_map_px"))
    iris = APPARENT_GAIN * flat_iris(
        iris_of(spec).maps(map_px), spec.pupil_mm, size_px=IRIS_PX, half_mm=IRIS_PLANE_MM
    )
    radius = np.hypot(*plane_points(IRIS_PX, IRIS_PLANE_MM))
    root = ease((radius - IRIS_MAP_RADIUS_MM) / (2 * ROOT_EDGE_MM) + 0.5)[..., None]
    return np.asarray(iris * (1 - root) + LIMBAL_TISSUE * CORNEA_IOR**2 * root)


def even_iris(reflectance: float) -> Array:
    """Return an iris of one grey without a pupil, (1, 1, 3)."""
    return np.full((1, 1, 3), reflectance)


def sclera_reflectance(spec: ClipSpec) -> Array:
    """Return the reflectance under a smooth film that looks like the sclera's map, (m, m, 3).

    The map holds what the eye shows under even light. Seen through a film, a tissue of reflectance
    r shows k r / (1 - r f): k what passes in and out, f what the film mirrors back inside.
    """
    shown = np.asarray(sclera_maps(spec.iris_seed, size_px=SCLERA_PX).albedo, dtype=np.float64)
    cosine = np.sqrt((np.arange(4000) + 0.5) / 4000)  # evenly over a diffuse hemisphere
    inside = float(np.mean(fresnel(cosine, ior=1 / CORNEA_IOR)))
    passed = float((1 - fresnel(1.0)) * (1 - np.mean(fresnel(cosine)))) / CORNEA_IOR**2
    return np.asarray(np.clip(shown / (passed + shown * inside), 0.0, 0.98))


def front_mesh(mi: Any, material: dict[str, Any]) -> Any:
    """Return the front surface with exact normals; its clear share stands at every vertex."""
    front = np.linspace(0.0, PROFILE_END_MM, RINGS)
    back = np.linspace(math.asin(PROFILE_END_MM / GLOBE_RADIUS_MM), math.radians(BACK_DEG), 90)[1:]
    r = np.concatenate([front, GLOBE_RADIUS_MM * np.sin(back)])
    z = np.concatenate([surface_height(front)[0], GLOBE_RADIUS_MM * np.cos(back)])
    turn = 2 * math.pi * np.arange(SEGMENTS) / SEGMENTS
    points = np.stack(
        [np.outer(r, np.cos(turn)), np.outer(r, np.sin(turn)), np.outer(z, np.ones(SEGMENTS))], -1
    ).reshape(-1, 3)
    clear = np.where(points[:, 2] > 0.0, cornea_share(points), 0.0)
    return _mesh(
        mi,
        points,
        ring_faces(len(r), SEGMENTS),
        normals=surface_normal(points),
        uv=_sclera_uv(points),
        attributes={"vertex_clear": clear},
        material=material,
    )


def iris_mesh(mi: Any, material: dict[str, Any]) -> Any:
    """Return the iris plane up to the globe's inside."""
    turn = 2 * math.pi * np.arange(SEGMENTS) / SEGMENTS
    rim = IRIS_PLANE_MM * np.column_stack([np.cos(turn), np.sin(turn)])
    flat = np.concatenate([np.zeros((1, 2)), rim])
    this = np.arange(SEGMENTS)
    faces = np.column_stack([np.zeros(SEGMENTS, int), 1 + this, 1 + (this + 1) % SEGMENTS])
    points = np.column_stack([flat, np.full(len(flat), IRIS_Z_MM)])
    uv = 0.5 + 0.5 * flat / IRIS_PLANE_MM
    return _mesh(mi, points, faces, normals=None, uv=uv, attributes={}, material=material)


def ring_faces(rings: int, segments: int) -> npt.NDArray[np.int64]:
    """Join rings of points into triangles that face outwards; the first ring is the apex."""
    ring, this = np.meshgrid(np.arange(rings - 1), np.arange(segments), indexing="ij")
    following = (this + 1) % segments
    a, b = ring * segments + this, ring * segments + following
    c, d = a + segments, b + segments
    outer = np.stack([a, c, d], axis=-1).reshape(-1, 3)
    inner = np.stack([a, d, b], axis=-1)[1:].reshape(-1, 3)  # empty at the apex
    return np.concatenate([outer, inner])


def _sclera_uv(points: Array) -> Array:
    """Return the azimuthal equidistant place on the sclera's maps, as ``sclera.glsl`` has it."""
    direction = points / np.linalg.norm(points, axis=1, keepdims=True)
    angle = np.arccos(np.clip(direction[:, 2], -1.0, 1.0))
    axis = direction[:, :2] / np.maximum(np.hypot(*direction[:, :2].T), 1e-9)[:, None]
    return np.asarray(0.5 + 0.5 * axis * np.minimum(angle / SCLERA_EDGE, 0.99)[:, None])


def _front_material(mi: Any, sclera: Array) -> dict[str, Any]:
    return {
        "type": "blendbsdf",
        "weight": {"type": "mesh_attribute", "name": "vertex_clear"},
        "sclera": {
            "type": "plastic",
            "int_ior": CORNEA_IOR,
            "ext_ior": 1.0,
            "nonlinear": True,
            "diffuse_reflectance": _bitmap(mi, sclera),
        },
        "cornea": {"type": "dielectric", "int_ior": CORNEA_IOR, "ext_ior": 1.0},
    }


def _diffuse(mi: Any, reflectance: Array) -> dict[str, Any]:
    return {"type": "diffuse", "reflectance": _bitmap(mi, reflectance)}


def _bitmap(mi: Any, values: Array) -> dict[str, Any]:
    """Return a texture whose row 0 lies at v = 0, as ours do."""
    rows = np.ascontiguousarray(values, dtype=np.float32)
    return {"type": "bitmap", "bitmap": mi.Bitmap(rows), "raw": True, "wrap_mode": "clamp"}


def _mesh(
    mi: Any,
    points: Array,
    faces: npt.NDArray[np.int64],
    *,
    normals: Array | None,
    uv: Array,
    attributes: dict[str, Array],
    material: dict[str, Any],
) -> Any:
    properties = mi.Properties()
    properties["mesh_bsdf"] = mi.load_dict(material)
    mesh = mi.Mesh(
        "mesh",
        vertex_count=len(points),
        face_count=len(faces),
        has_vertex_normals=normals is not None,
        has_vertex_texcoords=True,
        props=properties,
    )
    for name in attributes:
        mesh.add_attribute(name, 1, [0.0] * len(points))
    values = mi.traverse(mesh)
    values["vertex_positions"] = np.ravel(points).astype(np.float32)
    values["faces"] = np.ravel(faces).astype(np.uint32)
    values["vertex_texcoords"] = np.ravel(uv).astype(np.float32)
    if normals is not None:
        values["vertex_normals"] = np.ravel(normals).astype(np.float32)
    for name, column in attributes.items():
        values[name] = np.ravel(column).astype(np.float32)
    values.update()
    return mesh
