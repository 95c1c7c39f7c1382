"""OpenGL functions that moderngl does not offer, through ctypes."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from typing import Any


@functools.cache
def gl_function(name: str, *arguments: Any, result: Any = None) -> Callable[..., Any]:
    """Return an OpenGL function by name with ctypes' argument types.

    Raises RuntimeError that names the libraries when neither EGL nor libGL offers it.
    """
    prototype = ctypes.CFUNCTYPE(result, *arguments)
    try:
        egl = ctypes.CDLL("libEGL.so.1")
        egl.eglGetProcAddress.restype = ctypes.c_void_p
        egl.eglGetProcAddress.argtypes = [ctypes.c_char_p]
        address = egl.eglGetProcAddress(name.encode())
        if address:
            return prototype(address)
    except OSError:
        pass
    for library in ("libOpenGL.so.0", "libGL.so.1"):
        try:
            return prototype((name, ctypes.CDLL(library)))
        except (OSError, AttributeError):
            continue
    raise RuntimeError(
        f"{name}: not found through libEGL.so.1, libOpenGL.so.0 or libGL.so.1; install the OpenGL "
        "libraries, on Debian: apt-get install libegl1 libgl1"
    )
