"""The headless OpenGL context: a GPU where there is one, Mesa's llvmpipe where there is none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import moderngl

# What Mesa and others call a renderer that computes on the processor.
SOFTWARE: Final = ("llvmpipe", "softpipe", "swr", "swiftshader", "software", "basic render")
GL_VERSION: Final = 430  # core profile: what llvmpipe and every GPU of the last ten years offer


@dataclass(frozen=True)
class GlIdentity:
    """Which implementation drew the frames: part of what a frame's hash depends on."""

    renderer: str
    version: str


def create_context() -> moderngl.Context:
    """Open a context without a window through EGL.

    Raises RuntimeError that names the libraries to install when EGL gives none.
    """
    settings: dict[str, Any] = {"standalone": True, "backend": "egl", "require": GL_VERSION}
    try:
        gl = moderngl.create_context(**settings)
    except Exception as error:
        raise RuntimeError(
            f"no OpenGL {GL_VERSION / 100:.1f} context through EGL ({error}); install a driver, "
            "for software rendering on Debian: apt-get install libegl1 libgl1 libgl1-mesa-dri"
        ) from error
    gl.gc_mode = "auto"
    return gl


def identify(gl: moderngl.Context) -> GlIdentity:
    """Return the names of the context's renderer and version."""
    return GlIdentity(gl.info["GL_RENDERER"], gl.info["GL_VERSION"])


def is_software(gl_renderer: str) -> bool:
    """Whether a renderer of this name computes on the processor."""
    name = gl_renderer.lower()
    return any(word in name for word in SOFTWARE)


def chooses_parts(gl: moderngl.Context) -> bool:
    """Whether it saves time to choose on the processor which parts of a scene a frame draws.

    Software GL shades on the processor as well: what is left out is won. On a GPU Python's choice
    takes longer than drawing everything, and reading a picture back amid a frame makes both wait.
    Asks GL: call it once for each object that is made.
    """
    return is_software(gl.info["GL_RENDERER"])
