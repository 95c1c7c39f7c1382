"""The passes that draw one view of a frame, in their order."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import moderngl

from renderer.eye.eyes import Eyes
from renderer.frame.edge_tiles import EdgeTiles
from renderer.frame.outlines import Outlines
from renderer.scene import Scene
from renderer.view import CameraUniforms, View

# What a view is drawn by, in this order: what lets something through lies over what does not.
PASSES: Final = ("head", "eyes", "tears", "bystanders", "background", "hair")


class ViewPasses:
    """Draw views of a scene with a clip's eyes, as far as the pass named ``until``.

    In an approach (``is_approach``) nothing may change in steps with the camera's distance.
    """

    def __init__(
        self, gl: moderngl.Context, scene: Scene, eyes: Eyes, *, is_approach: bool, until: str
    ) -> None:
        self._gl = gl
        self._scene = scene
        self._eyes = eyes
        self._is_approach = is_approach
        self._names = PASSES[: PASSES.index(until) + 1]

    def draw(
        self, view: View, time_s: float, *, wireframe: bool = False
    ) -> dict[int, moderngl.Query]:
        """Draw what is opaque and near, and tears, into the current target.

        Returns what counts each eye's visible pixels. ``wireframe`` draws the eyes as their
        triangles' edges.
        """
        camera = view.uniforms
        scene = self._scene
        queries: dict[int, moderngl.Query] = {}
        # Meshes that change with the distance would change the face amid an approach.
        scene.head.is_close = True if self._is_approach else None
        passes: dict[str, Callable[[], None]] = {
            "head": lambda: scene.head.draw(**camera, light=scene.light),
            "eyes": lambda: queries.update(self._draw_eyes(view, wireframe)),
            "tears": lambda: self._draw_tears(view),
            "bystanders": lambda: scene.crowd.draw(**camera, time_s=time_s),
        }
        for name in self._names:
            if name in passes:
                passes[name]()
        return queries

    def draw_background(self, view: View, tiles: EdgeTiles) -> None:
        """Fill what the last ``draw`` of a view left open; the viewport is the whole picture."""
        if "background" in self._names:
            self._gl.enable_only(moderngl.DEPTH_TEST)
            self._scene.surroundings.draw_background(
                view_matrix=view.view_matrix,
                projection=view.projection,
                is_smooth=self._is_approach,
                gaps=tiles.gaps,
                rectangle=view.rectangle,
            )

    def draw_hair(self, view: View) -> None:
        """Draw what lets something through over a view whose edges are smooth."""
        if "hair" in self._names:
            self._scene.head.draw_hair(**view.uniforms, light=self._scene.light)

    def draw_outlines(
        self, view: View, outlines: Outlines, tiles: EdgeTiles, *, wireframe: bool = False
    ) -> None:
        """Draw where things of the last ``draw`` of a view end, as far as they are opaque."""
        outlines.begin(view.rectangle, tiles)
        clip = view.projection @ view.view_matrix
        if "head" in self._names:
            self._scene.head.draw_outlines(outlines, tiles, clip, camera_mm=view.position_mm)
        if "eyes" in self._names:
            self._gl.wireframe = wireframe
            with outlines.marking():
                for eye in view.eyes:
                    self._eyes.draw_outline(
                        eye, tiles, view_matrix=view.view_matrix, projection=view.projection
                    )
            self._gl.wireframe = False
        if "bystanders" in self._names:
            self._scene.crowd.draw_outlines(view, outlines)

    def _draw_eyes(self, view: View, wireframe: bool) -> dict[int, moderngl.Query]:
        self._gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        return {eye: self._draw_eye(eye, view.uniforms, wireframe) for eye in view.eyes}

    def _draw_tears(self, view: View) -> None:
        head, light = self._scene.head, self._scene.light
        for eye in view.eyes:
            wet = sum(
                share
                for detail, share in self._eyes.shares(eye)
                if detail.reflection in {"high", "ultra"}
            )
            if wet > 0.0:
                head.draw_tears(eye, **view.uniforms, light=light, share=wet)

    def _draw_eye(self, eye: int, camera: CameraUniforms, wireframe: bool) -> moderngl.Query:
        self._eyes.shade(eye, **camera)  # outside the query: it counts what is seen
        query = self._gl.query(samples=True)
        self._gl.wireframe = wireframe
        with query:
            self._eyes.draw(eye, **camera)
        self._gl.wireframe = False
        return query
