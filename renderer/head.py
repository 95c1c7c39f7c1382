"""The main character on the GPU: skin, sweater, lashes, brows and hair, drawn in a scene's light.

World space in mm. The head stands still during a clip: what the sky does to it is baked once per
light, and a frame only projects and textures it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.cache import cached_arrays
from renderer.camera import Matrix
from renderer.character import figure
from renderer.clip import ClipSpec
from renderer.clothing import COLOUR, knit_tile, sweater
from renderer.face_mesh import SkinPart, face_mesh, to_world
from renderer.hair import COLOUR as HAIR_COLOUR
from renderer.hair import grow_hair, hair_cap
from renderer.head_buffers import CellMesh
from renderer.lashes import grow_brow, grow_lashes
from renderer.lid_fit import ALONG, AROUND, grid_quads, lid_rims
from renderer.lids import LidRims
from renderer.light import Light
from renderer.makehuman import Floats, Indices
from renderer.program import build_program
from renderer.skin import SCALP, TILE_MM, TILE_PX, detail_coordinates, paint, pore_tile
from renderer.skin_light import SkinLight, light_skin
from renderer.sky_visibility import Region, look_up, sky_visibility
from renderer.strand_buffers import StrandMesh

CLOSE_MM: Final = 800.0  # nearer cameras get the fine meshes
SAMPLE_ALPHA_TO_COVERAGE: Final = 0x809E
HAIR_BIAS_MM: Final = 1.2
HAIR_SEED: Final = 20
SUN_LIFT_MM: Final = 0.35
LINES_PER_MM_AT_1MM: Final = 1080 / (2 * 0.10510424)  # pixels per mm at 1 mm for 12 degrees


class Head:
    """The main character's head and shoulders."""

    def __init__(self, gl: moderngl.Context, spec: ClipSpec) -> None:
        """Build meshes and textures; ``spec`` decides nothing yet: lids do not follow the gaze."""
        del spec
        self.gl = gl
        self.rims: tuple[LidRims, LidRims] = (lid_rims(0), lid_rims(1))
        self._programs = {
            "skin": build_program(gl, "skin.vert", fragment="skin.frag"),
            "fabric": build_program(gl, "skin.vert", fragment="fabric.frag"),
            "hair": build_program(gl, "hair.vert", fragment="hair.frag"),
            "depth": build_program(gl, "depth.vert", fragment="depth.frag"),
        }
        self._pores = _tile(gl, pore_tile_cached())
        self._knit = _tile(gl, knit_tile())
        self._skin = _Skin(gl)
        self._cloth = _Cloth(gl)
        self._cap = _Cap(gl)
        self._open_sky = self._bake_open_sky()
        self._hair = _grow_hair(gl)
        self._lit_by: Light | None = None

    def draw(
        self, *, view_matrix: Matrix, projection: Matrix, camera_mm: npt.ArrayLike, light: Light
    ) -> None:
        """Draw what is opaque: skin and sweater."""
        self._light(light)
        self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        distance = float(np.linalg.norm(np.asarray(camera_mm)))
        common = {
            "u_view_matrix": view_matrix,
            "u_projection": projection,
            "u_camera_mm": camera_mm,
            **light.uniforms(),
        }
        clip = projection @ view_matrix
        density = LINES_PER_MM_AT_1MM / distance
        skin, fabric = self._programs["skin"], self._programs["fabric"]
        level = max(0.0, np.log2(TILE_PX / TILE_MM / density))
        skin.set(**common, u_pores=self._pores, u_pore_level=level)
        for mesh in self._skin.close if distance < CLOSE_MM else self._skin.distant:
            mesh.draw(skin, clip)
        fabric.set(**common, u_knit=self._knit, u_knit_level=max(0.0, np.log2(60.0 / density)))
        self._cloth.mesh.draw(fabric, clip)
        self._cap.mesh.draw(skin, clip)

    def draw_hair(
        self, *, view_matrix: Matrix, projection: Matrix, camera_mm: npt.ArrayLike, light: Light
    ) -> None:
        """Draw lashes, brows and hair; they cover samples by their alpha."""
        self._light(light)
        program = self._programs["hair"]
        self.gl.enable_only(moderngl.DEPTH_TEST)
        self.gl.enable_direct(SAMPLE_ALPHA_TO_COVERAGE)
        program.set(
            u_view_matrix=view_matrix,
            u_projection=projection,
            u_camera_mm=camera_mm,
            u_pixel_per_mm=LINES_PER_MM_AT_1MM,
            u_pixel_mm=float(np.linalg.norm(np.asarray(camera_mm))) / LINES_PER_MM_AT_1MM,
            u_shadow_bias_mm=HAIR_BIAS_MM,
            u_gloss=1.0,
            **light.uniforms(),
        )
        for mesh in self._hair:
            mesh.draw(program)
        self.gl.disable_direct(SAMPLE_ALPHA_TO_COVERAGE)

    def draw_depth(self, matrix: npt.ArrayLike) -> None:
        """Draw skin and sweater into a depth map with a world-to-clip matrix."""
        program = self._programs["depth"]
        program.set(u_world_to_clip=matrix)
        clip = np.asarray(matrix, dtype=float)
        self.gl.disable(moderngl.CULL_FACE)
        for mesh in [*self._skin.close, self._cloth.mesh, self._cap.mesh]:
            mesh.draw(program, clip)

    def _bake_open_sky(self) -> dict[str, npt.NDArray[np.float32]]:
        def make() -> dict[str, Any]:
            parts = {
                name: (part.points_mm, part.normals) for name, part in self._skin.parts.items()
            }
            cloth = self._cloth.garment
            head = {name: parts[name] for name in ("fine", "rest", "coarse")}
            regions = [Region((0.0, -30.0, -50.0), 190.0, head)]
            for eye, x in enumerate((-31.0, 31.0)):
                meshes = {name: parts[name] for name in ("fine", f"patch{eye}", f"corner{eye}")}
                regions.append(Region((x, 0.0, 8.0), 34.0, meshes))
            regions[0].meshes["cap"] = (self._cap.cap.points_mm, self._cap.cap.normals)
            meshes = {"cloth": (cloth.points_mm, cloth.normals)}
            regions.append(Region((0.0, -350.0, -50.0), 520.0, meshes))
            shares = sky_visibility(self.gl, self.draw_depth, regions)
            return {name: np.round(share * 255).astype(np.uint8) for name, share in shares.items()}

        kept = cached_arrays("head's open sky", make)
        return {
            name: np.asarray(share, dtype=np.float32) / np.float32(255)
            for name, share in kept.items()
        }

    def _light(self, light: Light) -> None:
        """Bake the light into the vertex buffers unless it is the last one."""
        if self._lit_by is light:
            return
        size = light.shadow_map.size[0]
        depth = np.frombuffer(light.shadow_map.read(), dtype=np.float32).reshape(size, size)
        matrix = np.asarray(light.world_to_shadow, dtype=float)

        def lit(points: Floats, normals: Floats, triangles: Indices, name: str) -> SkinLight:
            lifted = points + SUN_LIFT_MM * (normals + light.sky.sun_direction)
            sun = look_up(depth, matrix, lifted, radius_px=2).astype(float)
            return light_skin(
                points, normals, triangles, sky=light.sky, open_sky=self._open_sky[name], sun=sun
            )

        parts = self._skin.parts
        self._skin.write_light(
            {
                name: lit(part.points_mm, part.normals, part.triangles, name)
                for name, part in parts.items()
            }
        )
        cloth = self._cloth.garment
        shaded = replace(light.sky, sun_irradiance=np.zeros(3))
        self._cloth.write_light(
            light_skin(
                cloth.points_mm,
                cloth.normals,
                cloth.triangles,
                sky=shaded,
                open_sky=self._open_sky["cloth"],
                sun=np.zeros(len(cloth.points_mm)),
            )
        )
        cap = self._cap.cap
        self._cap.write_light(lit(cap.points_mm, cap.normals, cap.triangles, "cap"))
        self._lit_by = light


class _Skin:
    """The skin's parts and the meshes that draw them."""

    def __init__(self, gl: moderngl.Context) -> None:
        face = face_mesh()
        self.parts: dict[str, SkinPart] = {
            "fine": face.fine,
            "rest": face.rest,
            "coarse": face.coarse,
            "patch0": face.patches[0],
            "patch1": face.patches[1],
            "corner0": face.corners[0],
            "corner1": face.corners[1],
        }
        self._gloss: dict[str, Floats] = {}
        self._meshes: dict[str, list[CellMesh]] = {}
        self.close: list[CellMesh] = []
        self.distant: list[CellMesh] = []
        for name, part in self.parts.items():
            albedo, self._gloss[name] = paint(part)
            rows = _static(part, albedo)
            meshes = {"all": CellMesh(gl, rows, part.triangles)}
            if name.startswith("patch"):
                meshes["thinned"] = CellMesh(gl, rows, _coarse_patch(int(name[-1])))
            self._meshes[name] = list(meshes.values())
            if name != "coarse":
                self.close.append(meshes["all"])
            if name not in ("fine", "rest"):
                self.distant.append(meshes.get("thinned", meshes["all"]))

    def write_light(self, lights: dict[str, SkinLight]) -> None:
        """Replace the baked light of every part."""
        for name, part in self.parts.items():
            rows = _lit_rows(lights[name], gloss=self._gloss[name], wet=part.wet)
            for mesh in self._meshes[name]:
                mesh.write_light(rows)


class _Cloth:
    """The sweater and its mesh."""

    def __init__(self, gl: moderngl.Context) -> None:
        self.garment = sweater(figure())
        count = len(self.garment.points_mm)
        rows = [
            self.garment.points_mm,
            self.garment.normals,
            np.tile(COLOUR, (count, 1)),
            self.garment.knit,
            np.zeros((count, 3)),
        ]
        self.mesh = CellMesh(gl, np.column_stack(rows), self.garment.triangles)

    def write_light(self, light: SkinLight) -> None:
        """Replace the baked light."""
        zero = np.zeros(len(light.sun))
        self.mesh.write_light(_lit_rows(light, gloss=zero, wet=zero))


class _Cap:
    """The mass of the hair and its mesh."""

    def __init__(self, gl: moderngl.Context) -> None:
        self.cap = hair_cap(face_mesh())
        count = len(self.cap.points_mm)
        rows = [
            self.cap.points_mm,
            self.cap.normals,
            np.tile(np.array(HAIR_COLOUR) * SCALP, (count, 1)),
            np.zeros((count, 5)),
        ]
        self.mesh = CellMesh(gl, np.column_stack(rows), self.cap.triangles)

    def write_light(self, light: SkinLight) -> None:
        """Replace the baked light; the ribbons shine, not the mass beneath."""
        zero = np.zeros(len(light.sun))
        dull = SkinLight(light.diffuse, 0.3 * light.ambient, zero)
        self.mesh.write_light(_lit_rows(dull, gloss=zero, wet=zero))


def pore_tile_cached() -> npt.NDArray[np.uint8]:
    """Return the pore tile from the cache, or make it (2 s)."""
    return cached_arrays("skin's pores", lambda: {"tile": pore_tile()})["tile"].astype(np.uint8)


def _grow_hair(gl: moderngl.Context) -> list[StrandMesh]:
    """Grow lashes and brows on both sides, mirrored in their laws, not hair by hair."""
    face = face_mesh()
    meshes = []
    for eye in (0, 1):
        rng = np.random.Generator(np.random.PCG64(HAIR_SEED + eye))
        for strands in (grow_lashes(face.lids[eye], rng), grow_brow(face.sockets[eye], rng)):
            placed = replace(strands, points_mm=to_world(strands.points_mm, eye))
            meshes.append(StrandMesh(gl, placed, rng))
    rng = np.random.Generator(np.random.PCG64(HAIR_SEED + 2))
    meshes.append(StrandMesh(gl, grow_hair(hair_cap(face), rng), rng))
    return meshes


def _static(part: SkinPart, albedo: Floats) -> Floats:
    detail = detail_coordinates(part.points_mm)
    sunk = part.points_mm - part.normals * np.reshape(part.sink_mm, (-1, 1))
    return np.column_stack([sunk, part.normals, albedo, detail, part.along_mm, part.lid])


def _lit_rows(light: SkinLight, *, gloss: Floats, wet: Floats) -> Floats:
    return np.column_stack([light.diffuse, gloss, light.ambient, light.sun, wet])


def _coarse_patch(eye: int) -> Indices:
    """Return triangles that skip three of four rings' points: for views from further away."""
    around, along = np.arange(0, AROUND, 4), np.append(np.arange(0, ALONG - 1, 3), ALONG - 1)
    quads = grid_quads(len(around), len(along))
    number = (around[:, None] * ALONG + along[None, :]).ravel()
    triangles = number[np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])]
    return np.asarray(triangles[:, ::-1] if eye == 0 else triangles)


def _tile(gl: moderngl.Context, pixels: npt.NDArray[np.uint8]) -> moderngl.Texture:
    texture = gl.texture(pixels.shape[1::-1], 4, pixels.tobytes())
    texture.build_mipmaps()
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    return texture
