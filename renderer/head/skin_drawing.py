"""Skin drawn kind by kind: each kind's program puts textures where it wants."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import moderngl

from renderer.body.makehuman import Floats
from renderer.gl.program import build_program
from renderer.head.buffers import CellMesh
from renderer.head.face_mesh import face_mesh
from renderer.head.skin_maps import SkinMaps
from renderer.head.surfaces import SKIN_KINDS
from renderer.view import Matrix


class SkinDrawing:
    """The programs of skin with the pictures that they read."""

    def __init__(self, gl: moderngl.Context) -> None:
        self._programs = [
            build_program(gl, "skin.vert", fragment="skin.frag", constants=constants)
            for constants in SKIN_KINDS
        ]
        self._maps = SkinMaps(gl, face_mesh())

    def draw(
        self,
        meshes: Sequence[tuple[float, CellMesh]],
        view: dict[str, Any],
        clip: Matrix,
        *,
        camera_mm: Floats,
        pixels_per_mm: float,
    ) -> None:
        """Draw meshes, each with the mark that its pixels get, in a view of this density."""
        values = view | self._maps.uniforms(pixels_per_mm)
        for kind, program in enumerate(self._programs):
            own = [(mark, mesh) for mark, mesh in meshes if mesh.has_kind(kind)]
            if own:
                program.set(**values)
            for mark, mesh in own:
                program.set(u_mark=mark)
                mesh.draw(program, clip, camera_mm=camera_mm, kind=kind)
