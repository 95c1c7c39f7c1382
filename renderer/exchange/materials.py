"""What each part of a scene is made of, in words and numbers that other renderers know."""

from __future__ import annotations

from typing import Any, Final

from renderer.eye.anatomy import CORNEA_IOR

MATERIALS: Final[dict[str, dict[str, Any]]] = {
    "cornea": {
        "kind": "smooth dielectric",
        "interior_ior": CORNEA_IOR,
        "exterior_ior": 1.0,
        "transmittance": 1.0,
        "meaning": "one interface stands for tear film, cornea and aqueous humour; what lies "
        "behind it, up to the iris and the sclera's inside, is the same medium",
    },
    "sclera": {
        "kind": "diffuse under a thin wet film",
        "reflectance": "textures: sclera_albedo, sclera_normal",
        "film_ior": CORNEA_IOR,
        "film_roughness": 0.2,
    },
    "iris": {
        "kind": "diffuse, four scattering layers beneath",
        "reflectance": "textures: iris_albedo times iris_gain; iris_normal; iris_thickness",
        "meaning": "inside the cornea's medium; the pupil is a hole with black behind",
    },
    "skin": {"kind": "diffuse with subsurface scattering", "reflectance": "vertices", "ior": 1.4},
    "wet tissue": {
        "kind": "diffuse under a wet film",
        "reflectance": "vertices",
        "film_ior": 1.336,
    },
    "cloth": {"kind": "diffuse", "reflectance": "vertices"},
    "hair": {"kind": "hair fibre", "reflectance": "vertices", "ior": 1.55},
    "person": {"kind": "diffuse", "reflectance": "vertices"},
}
# The first words of meshes' names.
_OF_MESH: Final = {
    "cornea": "cornea",
    "sclera": "sclera",
    "iris": "iris",
    "corners": "wet tissue",
    "sweater": "cloth",
    **dict.fromkeys(("lashes", "brow", "hair"), "hair"),
    "crowd": "person",
}


def material_of(mesh: str) -> str:
    """Return the material of a mesh by its name."""
    return _OF_MESH.get(mesh.partition("_")[0], "skin")
