"""The main character on the GPU: skin, sweater, lashes, brows and hair, drawn in a scene's light.

World space in mm. The head stands still during a clip: what the sky does to it is baked once per
light, and a frame only projects and textures it.
"""

from __future__ import annotations

from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.clip import ClipSpec
from renderer.eye.lids import LidRims
from renderer.eye.place import eye_centre_mm
from renderer.frame.bare_mesh import BareMesh
from renderer.frame.edge_tiles import EdgeTiles
from renderer.frame.outlines import CLOTH, HAIR, Outlines
from renderer.gl.program import build_program
from renderer.head.buffers import CellMesh, TilePyramid, joined
from renderer.head.clothing import knit_tile
from renderer.head.face_mesh import face_mesh
from renderer.head.fornix import Fornix, fold_triangles
from renderer.head.growing import grow_all_hair
from renderer.head.lid_pose import lid_poses
from renderer.head.lid_rims import lid_rims
from renderer.head.light import light_strands, light_surfaces, open_sky
from renderer.head.skin_drawing import SkinDrawing
from renderer.head.strands import blending, strand_programs
from renderer.head.surfaces import cap_surface, cloth_surface, skin_surfaces
from renderer.head.tears import TearLine
from renderer.light import Light
from renderer.view import Matrix

CLOSE_MM: Final = 800.0  # nearer cameras get the fine meshes
KNIT_PX_PER_MM: Final = 60.0  # of the knit's tile; more than it has: wool looks soft, not sharp


class Head:
    """The main character's head and shoulders."""

    def __init__(self, gl: moderngl.Context, spec: ClipSpec) -> None:
        """Build meshes and textures; of ``spec`` count gaze and blink, which move the lids."""
        self.gl = gl
        poses = lid_poses(spec)
        self.rims: tuple[LidRims, LidRims] = (lid_rims(0, poses[0]), lid_rims(1, poses[1]))
        self._programs = {
            "fabric": build_program(gl, "skin.vert", fragment="fabric.frag"),
            "depth": build_program(gl, "depth.vert", fragment="depth.frag"),
            "mark": build_program(gl, "depth.vert", fragment="mark.frag"),
            "tears": build_program(gl, "tears.vert", fragment="tears.frag"),
        }
        self._skin_drawing = SkinDrawing(gl)
        self._strand_programs = strand_programs(gl)
        self._fornix = Fornix(gl)
        self._knit = TilePyramid(gl, knit_tile())
        self._face = face_mesh(poses)
        skin = skin_surfaces(gl, self._face)
        self._surfaces = skin | {"cloth": cloth_surface(gl), "cap": cap_surface(gl)}
        self._veils = [item.veil for item in skin.values() if item.veil is not None]
        self._close = [item.mesh for name, item in skin.items() if name != "coarse"]
        self._distant = [
            item.distant or item.mesh for name, item in skin.items() if name not in ("fine", "rest")
        ]
        self._bare = self._bare_meshes()
        self._open_sky = open_sky(
            gl, self._surfaces, whole=self.draw_depth, without_lids=self._draw_depth_without_lids
        )
        self._hair = grow_all_hair(gl, self._face)
        self._tears = [
            TearLine(gl, self._programs["tears"], self._face.lids[eye], eye=eye) for eye in (0, 1)
        ]
        self._lit_by: Light | None = None
        # Whether cameras get the fine meshes; None decides by their distance.
        self.is_close: bool | None = None

    def _bare_meshes(self) -> dict[str, BareMesh]:
        """Return what outlines are drawn of: skin near and far, and what has marks."""
        depth, mark = self._programs["depth"], self._programs["mark"]
        # Conjunctiva goes on where its solid part ends, so there is no edge.
        near, far = [*self._close, *self._veils], [*self._distant, *self._veils]
        folds = fold_triangles()
        return {
            "close": BareMesh(self.gl, depth, *joined(near, folds)),
            "distant": BareMesh(self.gl, depth, *joined(far, folds)),
            "cap": BareMesh(self.gl, mark, *joined([self._mesh("cap")])),
            "cloth": BareMesh(self.gl, mark, *joined([self._mesh("cloth")])),
        }

    def draw(
        self, *, view_matrix: Matrix, projection: Matrix, camera_mm: npt.ArrayLike, light: Light
    ) -> None:
        """Draw what is opaque: skin, sweater and the mass of the hair."""
        self._use_light(light)
        self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        camera = np.asarray(camera_mm, dtype=float)
        distance = float(np.linalg.norm(camera))
        density = self._pixel_per_mm(projection) / distance
        view = {
            "u_view_matrix": view_matrix,
            "u_projection": projection,
            "u_camera_mm": camera_mm,
            **light.uniforms(),
        }
        clip = projection @ view_matrix
        marked = [*((0.0, mesh) for mesh in self._skin(distance)), (HAIR, self._mesh("cap"))]
        self._skin_drawing.draw(marked, view, clip, camera_mm=camera, pixels_per_mm=density)
        self._fornix.draw(clip, light.sky)
        fabric = self._programs["fabric"]
        fabric.set(**view, u_mark=CLOTH, u_knit=self._knit.at(KNIT_PX_PER_MM / density))
        self.gl.disable(moderngl.CULL_FACE)  # the roll neck shows its inside
        self._mesh("cloth").draw(fabric, clip)

    def draw_outlines(
        self, outlines: Outlines, tiles: EdgeTiles, clip: Matrix, *, camera_mm: npt.ArrayLike
    ) -> None:
        """Draw the outlines of what ``draw`` draws; what is marked stays marked if drawn later."""
        is_close = self._is_close_to(float(np.linalg.norm(np.asarray(camera_mm))))
        self._programs["depth"].set(u_world_to_clip=clip)
        self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._bare["close" if is_close else "distant"].draw(clip, tiles)
        marking = self._programs["mark"]
        with outlines.marking():
            marking.set(u_world_to_clip=clip, u_mark=HAIR / 255.0)
            self._bare["cap"].draw(clip, tiles)
            marking.set(u_mark=CLOTH / 255.0)
            self.gl.disable(moderngl.CULL_FACE)
            self._bare["cloth"].draw(clip, tiles)
            self.gl.enable(moderngl.CULL_FACE)

    def draw_hair(
        self, *, view_matrix: Matrix, projection: Matrix, camera_mm: npt.ArrayLike, light: Light
    ) -> None:
        """Draw what lets something through over everything else: conjunctiva, lashes, hair.

        It follows ``draw`` of the same view.
        """
        self._use_light(light)
        pixel_per_mm = self._pixel_per_mm(projection)
        view = {
            "u_view_matrix": view_matrix,
            "u_projection": projection,
            "u_camera_mm": camera_mm,
            **light.uniforms(),
        }
        for program in self._strand_programs.values():
            program.set(
                **view,
                u_pixel_per_mm=pixel_per_mm,
                u_pixel_mm=float(np.linalg.norm(np.asarray(camera_mm))) / pixel_per_mm,
            )
        clip = projection @ view_matrix
        camera = np.asarray(camera_mm, dtype=float)
        with blending(self.gl):
            # Conjunctiva fades into the sclera beneath; its solid part stands there already.
            veils = [(0.0, mesh) for mesh in self._veils]
            density = pixel_per_mm / float(np.linalg.norm(camera))
            self._skin_drawing.draw(veils, view, clip, camera_mm=camera, pixels_per_mm=density)
            for mesh, _ in self._hair:
                mesh.draw(self._strand_programs[mesh.kind], clip, camera_mm=camera)

    def draw_tears(
        self,
        eye: int,
        *,
        view_matrix: Matrix,
        projection: Matrix,
        camera_mm: npt.ArrayLike,
        light: Light,
        share: float = 1.0,
    ) -> None:
        """Draw the tear line of the viewer's left (0) or right (1) eye over lids and globe.

        ``share`` of 1 as it is; less lets through what lies behind.
        """
        distance = float(np.linalg.norm(np.asarray(camera_mm) - eye_centre_mm(eye)))
        if not self._is_close_to(distance):
            return
        self._tears[eye].draw(
            u_view_matrix=view_matrix,
            u_projection=projection,
            u_camera_mm=camera_mm,
            u_mm_per_px=distance / self._pixel_per_mm(projection),
            u_share=share,
            **light.uniforms(),
        )

    def draw_depth(self, matrix: npt.ArrayLike) -> None:
        """Draw what is opaque into a depth map with a world-to-clip matrix."""
        self._draw_depth(matrix, [*self._close, self._mesh("cap"), self._mesh("cloth")])

    def _draw_depth_without_lids(self, matrix: npt.ArrayLike) -> None:
        self._draw_depth(matrix, [self._mesh(name) for name in ("fine", "rest", "cap", "cloth")])

    def _draw_depth(self, matrix: npt.ArrayLike, meshes: list[CellMesh]) -> None:
        program = self._programs["depth"]
        program.set(u_world_to_clip=matrix)
        self.gl.disable(moderngl.CULL_FACE)
        for mesh in meshes:
            mesh.draw(program, np.asarray(matrix, dtype=float))

    def _skin(self, distance_mm: float) -> list[CellMesh]:
        """Return the meshes of opaque skin that a camera at this distance gets."""
        return self._close if self._is_close_to(distance_mm) else self._distant

    def _is_close_to(self, distance_mm: float) -> bool:
        return distance_mm < CLOSE_MM if self.is_close is None else self.is_close

    def _mesh(self, name: str) -> CellMesh:
        return self._surfaces[name].mesh

    def _pixel_per_mm(self, projection: npt.NDArray[Any]) -> float:
        """Return how many pixels a millimetre spans at 1 mm distance in the current viewport."""
        return float(projection[1, 1]) * self.gl.fbo.viewport[3] / 2

    def _use_light(self, light: Light) -> None:
        """Bake the light into the vertex buffers unless it is the last one."""
        if self._lit_by is not light:
            light_surfaces(self._surfaces, light, self._open_sky, face=self._face)
            light_strands(self._hair, light)
            self._lit_by = light
