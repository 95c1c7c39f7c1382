"""Bloom: the few per cent of light that lens and eye scatter around every point of the picture.

A sun mirrored by the tear film is hundreds of times brighter than the iris. A tone curve cuts it to
a white dot; what tells a viewer how bright it was is its glow. No threshold: every point gives the
same share, so that nothing switches on or off along the orbit.
"""

from __future__ import annotations

from typing import Any, Final

import moderngl

from renderer.gl.program import Program, build_program

SHARE: Final = 0.07  # of the light; the eye alone scatters 5 to 10 % (Spencer et al. 1995)
FIRST_PX: Final = 4  # picture pixels per texel of the finest level; each next one doubles it
WEIGHTS: Final = (0.36, 0.26, 0.18, 0.12, 0.08)  # per level: a tail of about 1 / r^2


class Bloom:
    """A pyramid of small pictures: halved on the way down, blurred and summed on the way up.

    ``views`` pictures stand side by side in the picture and give each other no light.
    """

    def __init__(self, gl: moderngl.Context, size: tuple[int, int], *, views: int) -> None:
        self.gl = gl
        self._views = views
        sizes = [_size(size, FIRST_PX << level, views) for level in range(len(WEIGHTS))]
        self._narrow = [_target(gl, size) for size in sizes]
        self._sums = [_target(gl, size) for size in sizes]
        self._black = gl.texture((1, 1), 4, bytes(8), dtype="f2")
        names = ("bloom_gather.frag", "bloom_halve.frag", "bloom_sum.frag")
        constants = {"PX": FIRST_PX}
        self._programs = [
            build_program(gl, "screen.vert", fragment=name, constants=constants) for name in names
        ]
        self._screens = [gl.vertex_array(each.gl_program, []) for each in self._programs]

    def blurred(self, radiance: moderngl.Texture) -> moderngl.Texture:
        """Return a picture of radiance blurred: as bright, a quarter as wide."""
        self.gl.enable_only(moderngl.NOTHING)
        wide = radiance.size[0] // self._views
        self._draw(
            0, self._narrow[0], u_radiance=radiance, u_wide=wide, u_columns=-(-wide // FIRST_PX)
        )
        for fine, coarse in zip(self._narrow, self._narrow[1:], strict=False):
            self._draw(1, coarse, u_picture=_texture(fine), u_views=self._views)
        wider = self._black
        for level in reversed(range(len(WEIGHTS))):
            self._draw(
                2,
                self._sums[level],
                u_picture=_texture(self._narrow[level]),
                u_wider=wider,
                u_views=self._views,
                u_weight=WEIGHTS[level] / sum(WEIGHTS),
            )
            wider = _texture(self._sums[level])
        return wider

    def _draw(self, number: int, target: moderngl.Framebuffer, **uniforms: Any) -> None:
        program: Program = self._programs[number]
        target.use()
        program.set(**uniforms)
        self._screens[number].render(moderngl.TRIANGLES, vertices=3)


def _size(size: tuple[int, int], px: int, views: int) -> tuple[int, int]:
    return views * -(-size[0] // (views * px)), -(-size[1] // px)


def _target(gl: moderngl.Context, size: tuple[int, int]) -> moderngl.Framebuffer:
    texture = gl.texture(size, 4, dtype="f2")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return gl.framebuffer([texture])


def _texture(target: moderngl.Framebuffer) -> moderngl.Texture:
    texture = target.color_attachments[0]
    assert isinstance(texture, moderngl.Texture)
    return texture
