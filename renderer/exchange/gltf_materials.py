"""A LoD's effects as glTF materials: what each level of an effect has a word for there.

Refraction: KHR_materials_transmission, _volume and _ior. Reflection: the cornea's and the tear
film's gloss (KHR_materials_clearcoat). Texture and sclera: base colours and normal maps at the
level's size. Subsurface and caustics have no counterpart and are left to the engine.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pygltflib as gltf

from renderer.clip import ClipSpec
from renderer.colour import linear_to_srgb
from renderer.detail import Detail
from renderer.exchange.gltf_buffer import GltfBuffer
from renderer.eye.anatomy import CORNEA_IOR, IRIS_DEPTH_MM
from renderer.eye.sclera import sclera_maps
from renderer.iris.source import iris_of

EXTENSIONS: Final = (
    "KHR_materials_clearcoat",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_volume",
)
SCLERA_ROUGHNESS: Final = 0.55
FILM_ROUGHNESS: Final = 0.06  # the tear film's


@dataclass(frozen=True)
class LodMaterials:
    """The numbers of a LoD's materials in the document."""

    sclera: int
    cornea: int
    iris: int


def add_materials(buffer: GltfBuffer, spec: ClipSpec, detail: Detail, *, lod: str) -> LodMaterials:
    """Add a LoD's textures and materials to the document."""
    materials = (_sclera(buffer, spec, detail), _cornea(detail), _iris(buffer, spec, detail))
    first = len(buffer.document.materials)
    for name, material in zip(("sclera", "cornea", "iris"), materials, strict=True):
        material.name = f"{name}_{lod}"
        buffer.document.materials.append(material)
    return LodMaterials(first, first + 1, first + 2)


def _sclera(buffer: GltfBuffer, spec: ClipSpec, detail: Detail) -> gltf.Material:
    colour_px = int(detail.setting("sclera", "diffuse_map_px"))
    normal_px = int(detail.setting("sclera", "normal_map_px"))
    albedo = sclera_maps(spec.iris_seed, size_px=colour_px).albedo
    material = _diffuse(buffer, albedo, f"sclera_{colour_px}", roughness=1.0)
    if normal_px:
        normal = sclera_maps(spec.iris_seed, size_px=normal_px).normal
        texture = buffer.texture(packed(normal), f"sclera_normal_{normal_px}")
        material.normalTexture = gltf.NormalMaterialTexture(index=texture)
        material.pbrMetallicRoughness.roughnessFactor = SCLERA_ROUGHNESS
    if detail.setting("reflection", "mode") != "none":
        material.extensions["KHR_materials_clearcoat"] = {
            "clearcoatFactor": 1.0,
            "clearcoatRoughnessFactor": FILM_ROUGHNESS,
        }
    return material


def _iris(buffer: GltfBuffer, spec: ClipSpec, detail: Detail) -> gltf.Material:
    size = int(detail.setting("texture", "iris_map_px"))
    maps = iris_of(spec).maps(size)
    material = _diffuse(buffer, maps.albedo, f"iris_{size}", roughness=1.0)
    if detail.texture in ("high", "ultra"):
        texture = buffer.texture(packed(maps.normal), f"iris_normal_{size}")
        material.normalTexture = gltf.NormalMaterialTexture(index=texture)
    return material


def _cornea(detail: Detail) -> gltf.Material:
    """Return clear glass; thin, so that it bends no ray, where the LoD does not refract."""
    extensions: dict[str, Any] = {
        "KHR_materials_transmission": {"transmissionFactor": 1.0},
        "KHR_materials_ior": {"ior": CORNEA_IOR},
    }
    if detail.setting("refraction", "refracts"):
        extensions["KHR_materials_volume"] = {"thicknessFactor": round(IRIS_DEPTH_MM * 1e-3, 6)}
    has_gloss = detail.setting("reflection", "mode") != "none"
    return gltf.Material(
        pbrMetallicRoughness=gltf.PbrMetallicRoughness(
            baseColorFactor=[1.0, 1.0, 1.0, 1.0],
            metallicFactor=0.0,
            roughnessFactor=0.0 if has_gloss else 1.0,
        ),
        extensions=extensions,
    )


def _diffuse(
    buffer: GltfBuffer, albedo: npt.NDArray[np.floating], name: str, *, roughness: float
) -> gltf.Material:
    texture = buffer.texture(_shown(albedo), name)
    return gltf.Material(
        pbrMetallicRoughness=gltf.PbrMetallicRoughness(
            baseColorTexture=gltf.TextureInfo(index=texture),
            metallicFactor=0.0,
            roughnessFactor=roughness,
        )
    )


def _shown(albedo: npt.NDArray[np.floating]) -> npt.NDArray[np.uint8]:
    """Return linear colour as sRGB bytes, first row on top."""
    encoded = np.rint(np.clip(linear_to_srgb(albedo), 0, 1) * 255).astype(np.uint8)
    return np.ascontiguousarray(encoded[::-1])


def packed(normal: npt.NDArray[np.floating]) -> npt.NDArray[np.uint8]:
    """Return unit normals as bytes, first row on top, green upwards as glTF has it."""
    pixels = np.rint((0.5 + 0.5 * normal) * 255).astype(np.uint8)
    return np.ascontiguousarray(pixels[::-1])
