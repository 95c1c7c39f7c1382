"""Smooth edges in a picture with one sample per pixel, by the outlines of what it shows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import moderngl

from renderer.frame.edge_tiles import EdgeTiles, depth_step
from renderer.frame.outlines import Outlines
from renderer.gl.program import build_program
from renderer.view import View

ALWAYS, MARKED, USUAL = "1", ">", "<"  # tests of depth; an edge's is 0, a triangle's 0.5


class Edges:
    """Find the edges of a picture and smooth them in place."""

    def __init__(
        self, gl: moderngl.Context, radiance: moderngl.Texture, depth: moderngl.Texture
    ) -> None:
        """``radiance`` and ``depth`` are of one sample per pixel and stay the same."""
        size = radiance.size
        self._gl = gl
        self._radiance, self._depth = radiance, depth
        found = gl.depth_renderbuffer(size)
        self._smooth = gl.texture(size, 4, dtype="f2")
        self._targets = {
            "find": gl.framebuffer([], found),
            "smooth": gl.framebuffer([self._smooth], found),
            "copy": gl.framebuffer([radiance], found),
        }
        for name in ("smooth", "copy"):
            self._targets[name].depth_mask = False
        self._programs = {
            "find": build_program(gl, "boxes.vert", fragment="find_edges.frag"),
            "smooth": build_program(
                gl, "boxes.vert", fragment="smooth_edges.frag", constants={"PLAIN": 0}
            ),
            "plain": build_program(
                gl, "boxes.vert", fragment="smooth_edges.frag", constants={"PLAIN": 1}
            ),
            "copy": build_program(gl, "boxes.vert", fragment="copy.frag"),
        }

    def smooth(
        self,
        views: Sequence[View],
        tiles: Sequence[EdgeTiles],
        outlines: Outlines,
        *,
        exposure: float,
        is_plain: bool,
    ) -> None:
        """Smooth the edges in each view's ``tiles``; ``is_plain`` takes the mean of radiance."""
        self._gl.enable_only(moderngl.DEPTH_TEST)
        for view, places in zip(views, tiles, strict=True):
            values = {**outlines.uniforms(), "u_depth_step": depth_step(view)}
            self._draw("find", "find", places, ALWAYS, **values)
            self._draw(
                "smooth",
                "plain" if is_plain else "smooth",
                places,
                MARKED,
                **values,
                u_radiance=self._radiance,
                u_depth=self._depth,
                u_view=view.rectangle,
                u_exposure=exposure,
            )
            self._draw("copy", "copy", places, MARKED, u_picture=self._smooth)
        self._gl.depth_func = USUAL

    def _draw(
        self, target: str, program: str, places: EdgeTiles, passes: str, **uniforms: Any
    ) -> None:
        self._targets[target].use()
        self._gl.depth_func = passes
        places.runs.draw(self._programs[program], **uniforms)
