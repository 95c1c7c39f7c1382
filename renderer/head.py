"""The main character on the GPU: skin, sweater, lashes, brows and hair, drawn in a scene's light.

World space in mm. The head stands still during a clip: what the sky does to it is baked once per
light, and a frame only projects and textures it.
"""

from __future__ import annotations

from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.cache import cached_arrays
from renderer.camera import Matrix
from renderer.character import figure
from renderer.clip import ClipSpec
from renderer.clothing import COLOUR, knit_tile, sweater
from renderer.face_mesh import SkinPart, face_mesh
from renderer.head_buffers import CellMesh
from renderer.lid_fit import ALONG, AROUND, grid_quads, lid_rims
from renderer.lids import LidRims
from renderer.light import Light
from renderer.makehuman import Floats, Indices
from renderer.occlusion import look_up, sky_visibility
from renderer.program import build_program
from renderer.skin import TILE_MM, TILE_PX, detail_coordinates, paint, pore_tile
from renderer.skin_light import SkinLight, light_skin

CLOSE_MM: Final = 800.0  # nearer cameras get the fine meshes
SUN_LIFT_MM: Final = 0.35
LINES_PER_MM_AT_1MM: Final = 1080 / (2 * 0.10510424)  # pixels per mm at 1 mm for 12 degrees
_STATIC: Final = (
    "3f 3f 3f 4f 1f",
    ["in_position", "in_normal", "in_albedo", "in_detail", "in_lid"],
)
_LIT: Final = ("3f 4f", ["in_diffuse", "in_surface"])


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
            "depth": build_program(gl, "depth.vert", fragment="depth.frag"),
        }
        self._pores = _tile(gl, pore_tile_cached())
        self._knit = _tile(gl, knit_tile())
        self._skin = _Skin(gl)
        self._cloth = _Cloth(gl)
        self._open_sky = self._bake_open_sky()
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
        for mesh in self._skin.meshes(close=distance < CLOSE_MM):
            mesh.draw(skin, clip)
        fabric.set(**common, u_knit=self._knit, u_knit_level=max(0.0, np.log2(35.0 / density)))
        self._cloth.mesh.draw(fabric, clip)

    def draw_hair(
        self, *, view_matrix: Matrix, projection: Matrix, camera_mm: npt.ArrayLike, light: Light
    ) -> None:
        """Draw lashes, brows and hair; they cover samples by their alpha."""

    def draw_depth(self, matrix: npt.ArrayLike) -> None:
        """Draw skin and sweater into a depth map with a world-to-clip matrix."""
        program = self._programs["depth"]
        program.set(u_world_to_clip=matrix)
        clip = np.asarray(matrix, dtype=float)
        self.gl.disable(moderngl.CULL_FACE)
        for mesh in [*self._skin.meshes(close=True), self._cloth.mesh]:
            mesh.draw(program, clip)

    def _bake_open_sky(self) -> dict[str, npt.NDArray[np.float32]]:
        def make() -> dict[str, Any]:
            head = ((0.0, -30.0, -50.0), 190.0)
            eyes = [((x, 0.0, 5.0), 34.0) for x in (-31.0, 31.0)]
            places = {
                "fine": head,
                "rest": head,
                "coarse": head,
                "patch0": eyes[0],
                "patch1": eyes[1],
                "corner0": eyes[0],
                "corner1": eyes[1],
            }
            regions = [
                (part.points_mm, part.normals, *places[name])
                for name, part in self._skin.parts.items()
            ]
            cloth = self._cloth.garment
            regions.append((cloth.points_mm, cloth.normals, (0.0, -350.0, -50.0), 520.0))
            shares = sky_visibility(self.gl, self.draw_depth, regions)
            names = [*self._skin.parts, "cloth"]
            return {
                name: np.round(share * 255).astype(np.uint8)
                for name, share in zip(names, shares, strict=True)
            }

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
        self._cloth.write_light(lit(cloth.points_mm, cloth.normals, cloth.triangles, "cloth"))
        self._lit_by = light


class _Skin:
    """The skin's vertex buffers and the meshes that index them."""

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
        painted = {name: paint(part) for name, part in self.parts.items()}
        self._gloss = {name: gloss for name, (_, gloss) in painted.items()}
        static = np.concatenate(
            [_static(part, painted[name][0]) for name, part in self.parts.items()]
        )
        self._light_buffer = gl.buffer(reserve=len(static) * 7 * 4)
        buffers = [
            (gl.buffer(static.astype(np.float32).tobytes()), *_STATIC),
            (self._light_buffer, *_LIT),
        ]
        points = static[:, :3]
        starts = dict(
            zip(
                self.parts,
                np.cumsum([0, *(len(p.points_mm) for p in self.parts.values())]),
                strict=False,
            )
        )
        plain = {name: part.triangles + starts[name] for name, part in self.parts.items()}
        for eye in (0, 1):
            plain[f"plain{eye}"] = _coarse_patch(eye) + starts[f"patch{eye}"]
        self._meshes = {
            name: CellMesh(gl, points, triangles, buffers=buffers)
            for name, triangles in plain.items()
        }

    def meshes(self, *, close: bool) -> list[CellMesh]:
        """Return what a close or a distant view draws."""
        corners = ["corner0", "corner1"]
        names = ["fine", "rest", "patch0", "patch1"] if close else ["coarse", "plain0", "plain1"]
        return [self._meshes[name] for name in names + corners]

    def write_light(self, lights: dict[str, SkinLight]) -> None:
        """Replace the baked light of every part."""
        rows = [
            _lit_rows(lights[name], gloss=self._gloss[name], wet=part.wet)
            for name, part in self.parts.items()
        ]
        self._light_buffer.write(np.concatenate(rows).astype(np.float32).tobytes())


class _Cloth:
    """The sweater's buffers."""

    def __init__(self, gl: moderngl.Context) -> None:
        self.garment = sweater(figure())
        count = len(self.garment.points_mm)
        static = np.column_stack(
            [
                self.garment.points_mm,
                self.garment.normals,
                np.tile(COLOUR, (count, 1)),
                self.garment.knit,
                np.zeros((count, 3)),
            ]
        )
        self._light_buffer = gl.buffer(reserve=count * 7 * 4)
        buffers = [
            (gl.buffer(static.astype(np.float32).tobytes()), *_STATIC),
            (self._light_buffer, *_LIT),
        ]
        self.mesh = CellMesh(gl, self.garment.points_mm, self.garment.triangles, buffers=buffers)

    def write_light(self, light: SkinLight) -> None:
        """Replace the baked light."""
        zero = np.zeros(len(light.sun))
        self._light_buffer.write(
            _lit_rows(light, gloss=zero, wet=zero).astype(np.float32).tobytes()
        )


def pore_tile_cached() -> npt.NDArray[np.uint8]:
    """Return the pore tile from the cache, or make it (2 s)."""
    return cached_arrays("skin's pores", lambda: {"tile": pore_tile()})["tile"].astype(np.uint8)


def _static(part: SkinPart, albedo: Floats) -> Floats:
    detail = detail_coordinates(part.points_mm)
    return np.column_stack([part.points_mm, part.normals, albedo, detail, part.along_mm, part.lid])


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
