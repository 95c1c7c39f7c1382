"""Both eyes of a clip on the GPU, each drawn at its LoD or between two of them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

import moderngl
import numpy as np

from renderer.eye.model import EyeModel
from renderer.eye.models import EyeModels, Shares, refracting
from renderer.eye.place import eye_centre_mm
from renderer.eye.silhouette import common_box
from renderer.frame.edge_tiles import EdgeTiles


class Eyes:
    """The eyes of a clip, like everything here the viewer's left, then right."""

    def __init__(self, gl: moderngl.Context, models: EyeModels) -> None:
        """Draw eyes of ``models``, at the LoDs of their clip until ``use`` says otherwise."""
        self._gl = gl
        self._models = models
        spec = models.spec
        self._shares: list[Shares] = [((spec.left, 1.0),), ((spec.right, 1.0),)]

    @property
    def models(self) -> tuple[EyeModel, EyeModel]:
        """Both eyes at the clip's own LoDs, which switching eyes have when they are large."""
        left, right = self._models.spec.left, self._models.spec.right
        return self._models.model(0, left), self._models.model(1, right)

    def use(self, eye: int, shares: Shares) -> None:
        """Draw an eye with one LoD, or with two and their shares, the coarser first, from now on.

        Builds what was not asked for before, in a state of its own: call it before a frame.
        """
        self._shares[eye] = shares
        self._drawn(eye)
        if len(shares) > 1:
            self._models.morph(self._shares[eye])

    def shares(self, eye: int) -> Shares:
        """Return the LoDs that an eye is drawn with."""
        return self._shares[eye]

    def draw(self, eye: int, *, view_matrix: Any, projection: Any, camera_mm: Any) -> None:
        """Draw the viewer's left (0) or right (1) eye, opaque and depth-tested."""
        models = self._drawn(eye)
        camera = {"u_view_matrix": view_matrix, "u_projection": projection}
        stale = [m for m in models if m.shaded.camera is not camera_mm]
        if stale and (models[0].silhouette or len(models) > 1):
            self.shade(eye, view_matrix=view_matrix, projection=projection, camera_mm=camera_mm)
        self._gl.enable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        placed = camera | {"u_eye_to_world": models[0].values["u_eye_to_world"]}
        with self._between_lids(models[0], np.asarray(projection) @ np.asarray(view_matrix)):
            if len(models) > 1:
                coarse, fine = models
                share = self._shares[eye][1][1]
                self._models.morph(self._shares[eye]).draw(
                    placed, coarse=coarse.shaded, fine=fine.shaded, share=share
                )
            elif models[0].silhouette:
                models[0].silhouette.draw(placed, models[0].shaded)
            else:
                self._set(models[0], camera, camera_mm, eye=eye)
                models[0].mesh.render()

    def draw_outline(
        self, eye: int, tiles: EdgeTiles, *, view_matrix: Any, projection: Any
    ) -> None:
        """Draw what ``draw`` draws as bare triangles that mark their samples, on ``tiles``."""
        models = self._drawn(eye)
        placed = {
            "u_view_matrix": view_matrix,
            "u_projection": projection,
            "u_eye_to_world": models[0].values["u_eye_to_world"],
        }
        with self._between_lids(models[0], np.asarray(projection) @ np.asarray(view_matrix)):
            if len(models) > 1:
                self._models.morph(self._shares[eye]).draw_outline(
                    placed, share=self._shares[eye][1][1]
                )
            else:
                models[0].outline.draw(placed, tiles)

    def shade(self, eye: int, *, view_matrix: Any, projection: Any, camera_mm: Any) -> None:
        """Prepare ``draw`` for a camera, outside of its queries and wire frames.

        The picture goes to a target of its own, as large as the current viewport. ``draw`` does
        this itself for a camera that was not announced; levels that need nothing do nothing.
        """
        models = self._drawn(eye)
        if len(models) == 1 and models[0].silhouette is None:
            return
        target, wireframe = self._gl.fbo, self._gl.wireframe
        self._gl.wireframe = False
        for model in models:
            placed = np.asarray(view_matrix) @ model.values["u_eye_to_world"]
            model.shaded.begin(
                self._gl, target.viewport, eye_to_clip=np.asarray(projection) @ placed
            )
            with self._only_seen(model, target, view_matrix=view_matrix, projection=projection):
                # Its textures come after those that tell what is seen.
                self._set(
                    model,
                    {"u_view_matrix": view_matrix, "u_projection": projection},
                    camera_mm,
                    eye=eye,
                    lines=target.viewport[3],
                )
                model.mesh.render()
            model.shaded.camera = camera_mm
        self._gl.wireframe = wireframe
        self._gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        target.use()

    def _only_seen(
        self, model: EyeModel, target: moderngl.Framebuffer, *, view_matrix: Any, projection: Any
    ) -> AbstractContextManager[None]:
        """Leave out what ``target`` hides already; ``begin`` came before."""
        depth, silhouette = target.depth_attachment, model.silhouette
        if silhouette is None or not isinstance(depth, moderngl.Texture) or depth.samples:
            return nullcontext()
        placed = {
            "u_view_matrix": view_matrix,
            "u_projection": projection,
            "u_eye_to_world": model.values["u_eye_to_world"],
        }
        return model.shaded.only_seen(self._gl, lambda: silhouette.draw_seen(placed, depth))

    def is_active(self, eye: int, uniform: str) -> bool:
        """Whether the eye's program still reads a uniform: off levels leave none behind."""
        return self._drawn(eye)[0].program.is_active(uniform)

    @contextmanager
    def _between_lids(self, model: EyeModel, world_to_clip: Any) -> Iterator[None]:
        """Confine drawing to where lids are open: what they hide costs as much as what is seen."""
        target = self._gl.fbo
        kept, eye_to_clip = target.scissor, world_to_clip @ model.values["u_eye_to_world"]
        target.scissor = common_box(kept, model.shaded.box(target.viewport, eye_to_clip))
        try:
            yield
        finally:
            target.scissor = kept

    def _drawn(self, eye: int) -> list[EyeModel]:
        return self._models.of(eye, self._shares[eye])

    def _set(
        self,
        model: EyeModel,
        camera: dict[str, Any],
        camera_mm: Any,
        *,
        eye: int,
        lines: int | None = None,
    ) -> None:
        bending = refracting(self._shares[eye])
        distance_mm = float(np.linalg.norm(np.asarray(camera_mm) - eye_centre_mm(eye)))
        lines = lines or self._gl.fbo.viewport[3]
        model.program.set(
            **model.values,
            **camera,
            u_camera_mm=camera_mm,
            u_unbent=0.0 if bending is None else 1.0 - bending[1],
            u_mm_per_px=2 * distance_mm / (float(camera["u_projection"][1][1]) * lines),
        )
