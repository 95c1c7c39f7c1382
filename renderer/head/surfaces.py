"""The head's surfaces ready for the GPU: skin, sweater and the mass of the hair."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import moderngl
import numpy as np

from renderer.body.makehuman import Floats, Indices
from renderer.head.buffers import CellMesh
from renderer.head.character import figure
from renderer.head.clothing import COLOUR as WOOL_COLOUR
from renderer.head.clothing import sweater
from renderer.head.face_mesh import FaceMesh, face_mesh
from renderer.head.hair import COLOUR as HAIR_COLOUR
from renderer.head.hair_cap import hair_cap
from renderer.head.lid_layout import ACROSS_MM, AROUND_MM, lid_coordinates
from renderer.head.skin import SCALP, detail_coordinates, paint
from renderer.head.skin_part import SkinPart
from renderer.head.thinned import distant_patch, near_corners, near_patch

GRAIN_SCALE: Final = 2.2  # the caruncle's granules are so much finer than the cheek's polygons
VESSELS_AT: Final = (-0.7, 0.3)  # in the lids' map, a turn early: on the upper lid
VESSELS_SCALE: Final = 1.7  # ... and so much finer than they lie there
AROUND_COLUMN: Final = 11  # of the rows: the way around the fissure in the lids' map
# Constants of the programs that shade skin away from the lids, dry lids, and what tears wet.
SKIN_KINDS: Final = (
    {"LIDS": 0, "WET": 0},
    {"LIDS": 1, "WET": 0},
    {"LIDS": 1, "WET": 1},
)


@dataclass
class Surface:
    """One lit surface: its geometry for bakes, and its mesh, or its fine and its distant mesh.

    ``veil`` holds triangles that let something through, if there are such; ``mesh`` holds
    those alone that do not.
    """

    points_mm: Floats
    normals: Floats
    triangles: Indices
    gloss: Floats
    wet: Floats
    mesh: CellMesh
    distant: CellMesh | None = None
    veil: CellMesh | None = None
    is_skin: bool = True
    meshes: list[CellMesh] = field(init=False)

    def __post_init__(self) -> None:
        self.meshes = [mesh for mesh in (self.mesh, self.distant, self.veil) if mesh is not None]

    def write_light(self, diffuse: Floats, ambient: Floats, sun: Floats) -> None:
        """Replace the baked light: diffuse (n, 3), free share of sky and of sun (n,)."""
        rows = np.column_stack([diffuse, self.gloss, ambient, sun, self.wet])
        for mesh in self.meshes:
            mesh.write_light(rows)


def skin_surfaces(gl: moderngl.Context, face: FaceMesh) -> dict[str, Surface]:
    """Return the skin: fine, rest, coarse, and for each eye its patch and its corners."""
    parts = {"fine": face.fine, "rest": face.rest, "coarse": face.coarse}
    for eye in (0, 1):
        parts |= {f"patch{eye}": face.patches[eye], f"corner{eye}": face.corners[eye]}
    surfaces = {}
    for name, part in parts.items():
        albedo, gloss = paint(part)
        lid = int(name[-1]) if name.startswith("patch") else None
        rows = _skin_rows(part, albedo, lid)
        solid, sheer = (part.triangles, None)
        if name.startswith("corner"):
            solid, sheer = _by_cover(part, near_corners(int(name[-1])))
        surfaces[name] = Surface(
            part.points_mm,
            part.normals,
            part.triangles,
            gloss,
            part.wet if part.grain is None else 1.0 - 0.5 * part.grain,
            _mesh(gl, part, rows, solid if lid is None else near_patch(lid), lid=lid),
            None if lid is None else _mesh(gl, part, rows, distant_patch(lid), lid=lid),
            None if sheer is None else _mesh(gl, part, rows, sheer),
        )
    return surfaces


def _mesh(
    gl: moderngl.Context,
    part: SkinPart,
    rows: Floats,
    triangles: Indices,
    *,
    lid: int | None = None,
) -> CellMesh:
    turn = None if lid is None else AROUND_COLUMN
    return CellMesh(gl, rows, triangles, turn=turn, kinds=skin_kinds(part, triangles))


def skin_kinds(part: SkinPart, triangles: Indices) -> Indices:
    """Return for each triangle (m,) which of SKIN_KINDS shades it: the least that will do."""
    is_wet = (part.wet > 0.0) | (part.grain is not None)
    kind = np.where(is_wet, 2, np.where(part.lid > 0.0, 1, 0))
    return np.asarray(kind[triangles].max(axis=1))


def cloth_surface(gl: moderngl.Context) -> Surface:
    """Return the sweater."""
    garment = sweater(figure())
    count = len(garment.points_mm)
    rows = [
        garment.points_mm,
        garment.normals,
        np.tile(WOOL_COLOUR, (count, 1)),
        garment.knit,
        np.zeros((count, 3)),
    ]
    mesh = CellMesh(gl, np.column_stack(rows), garment.triangles)
    zero = np.zeros(count)
    return Surface(
        garment.points_mm, garment.normals, garment.triangles, zero, zero, mesh, is_skin=False
    )


def cap_surface(gl: moderngl.Context) -> Surface:
    """Return the mass of the hair under the ribbons: dark, with neither pores nor shine."""
    cap = hair_cap(face_mesh())
    count = len(cap.points_mm)
    colour = np.tile(np.array(HAIR_COLOUR) * SCALP, (count, 1))
    rows = np.column_stack([cap.points_mm, cap.normals, colour, np.zeros((count, 5))])
    zero = np.zeros(count)
    return Surface(
        cap.points_mm, cap.normals, cap.triangles, zero, zero, CellMesh(gl, rows, cap.triangles)
    )


def _skin_rows(part: SkinPart, albedo: Floats, eye: int | None) -> Floats:
    detail = detail_coordinates(part.points_mm)
    lid = np.zeros((len(detail), 2)) if eye is None else lid_coordinates(part, eye)
    if part.grain is not None:
        # The shader knows conjunctiva by a place before the lids' map; its vessels are the lids'.
        detail = detail * GRAIN_SCALE
        away = part.points_mm[:, :2] - part.points_mm[:, :2].mean(axis=0)
        lid = VESSELS_AT + VESSELS_SCALE * away / [AROUND_MM, 2 * ACROSS_MM]
    sunk = part.points_mm - part.normals * np.reshape(part.sink_mm, (-1, 1))
    return np.column_stack([sunk, part.normals, albedo, detail, lid, part.lid])


def _by_cover(part: SkinPart, triangles: Indices) -> tuple[Indices, Indices | None]:
    """Return the triangles that hide what is behind, and those that let something through."""
    cover = part.lid[triangles]
    is_solid = cover.min(axis=1) > 0.999
    return triangles[is_solid], triangles[~is_solid & (cover.max(axis=1) > 0.001)]
