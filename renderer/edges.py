"""Smooth edges in a picture with one sample per pixel, by the outlines of what it shows."""

from __future__ import annotations

from collections.abc import Iterable

import moderngl
import numpy as np

from renderer.camera import View
from renderer.outlines import Outlines
from renderer.program import build_program

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
            "find": build_program(gl, "screen.vert", fragment="find_edges.frag"),
            "smooth": build_program(
                gl, "screen.vert", fragment="smooth_edges.frag", constants={"PLAIN": 0}
            ),
            "plain": build_program(
                gl, "screen.vert", fragment="smooth_edges.frag", constants={"PLAIN": 1}
            ),
            "copy": build_program(gl, "screen.vert", fragment="copy.frag"),
        }
        self._screens = {
            name: gl.vertex_array(program.gl_program, [])
            for name, program in self._programs.items()
        }

    def smooth(
        self, views: Iterable[View], outlines: Outlines, *, exposure: float, is_plain: bool
    ) -> None:
        """Smooth every view's edges; ``is_plain`` takes the mean of radiance."""
        self._gl.enable_only(moderngl.DEPTH_TEST)
        for view in views:
            values = {**outlines.uniforms(), "u_depth_step": depth_step(view)}
            self._draw("find", "find", view, ALWAYS, **values)
            self._draw(
                "smooth",
                "plain" if is_plain else "smooth",
                view,
                MARKED,
                **values,
                u_radiance=self._radiance,
                u_depth=self._depth,
                u_view=view.rectangle,
                u_exposure=exposure,
            )
            self._draw("copy", "copy", view, MARKED, u_picture=self._smooth)
        self._gl.depth_func = USUAL

    def _draw(self, target: str, program: str, view: View, passes: str, **uniforms: object) -> None:
        self._targets[target].use()
        self._targets[target].scissor = view.rectangle
        self._gl.depth_func = passes
        self._programs[program].set(**uniforms)
        self._screens[program].render(moderngl.TRIANGLES, vertices=3)


def depth_step(view: View) -> tuple[float, float]:
    """Return a and b: at a depth d of the buffer, one pixel's width is a depth of a (b - d).

    A pixel is z / f wide at a distance z, f being the focal length in pixels, and the buffer's
    depth is b - c / z.
    """
    projection = np.asarray(view.projection, dtype=float)
    focal_px = projection[1, 1] * view.rectangle[3] / 2
    return float(1.0 / focal_px), float(0.5 * (1.0 - projection[2, 2]))
