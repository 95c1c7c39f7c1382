"""Say whether OpenGL works here without a screen: exit 0 when it does, else name what is missing.

Standard library only: the set-up runs this before anything is installed. It walks the way that the
renderer takes: libEGL, a device, a display on it, an OpenGL context.
"""

from __future__ import annotations

import ctypes
import sys
from ctypes import POINTER, byref, c_char_p, c_int, c_uint, c_void_p

# EGL/egl.h and EGL/eglext.h (Khronos registry).
EGL_PLATFORM_DEVICE_EXT = 0x313F
EGL_OPENGL_API = 0x30A2
EGL_NONE = 0x3038
EGL_SURFACE_TYPE, EGL_PBUFFER_BIT = 0x3033, 0x0001
EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT = 0x3040, 0x0008


def main() -> int:
    """Print the first thing that fails; return the exit status."""
    try:
        ctypes.CDLL("libGL.so.1")
        egl = ctypes.CDLL("libEGL.so.1")
    except OSError as error:
        print(f"no OpenGL without a screen: {error}")
        return 1
    if not any(_makes_context(egl, device) for device in _devices(egl)):
        print("no OpenGL without a screen: EGL is there, but no device or driver gives a context")
        return 1
    return 0


def _devices(egl: ctypes.CDLL) -> list[int]:
    query_address = _address(egl, b"eglQueryDevicesEXT")
    if not query_address:
        return []
    query = ctypes.CFUNCTYPE(c_uint, c_int, POINTER(c_void_p), POINTER(c_int))(query_address)
    devices, count = (c_void_p * 32)(), c_int(0)
    query(32, devices, byref(count))
    return [device for device in devices[: count.value] if device]


def _makes_context(egl: ctypes.CDLL, device: int) -> bool:
    display_address = _address(egl, b"eglGetPlatformDisplayEXT")
    if not display_address:
        return False
    get_display = ctypes.CFUNCTYPE(c_void_p, c_uint, c_void_p, c_void_p)(display_address)
    display = c_void_p(get_display(EGL_PLATFORM_DEVICE_EXT, device, None))
    if not display.value or not egl.eglInitialize(display, None, None):
        return False
    wanted = (c_int * 5)(
        EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE
    )
    config, count = c_void_p(), c_int(0)
    egl.eglChooseConfig(display, wanted, byref(config), 1, byref(count))
    egl.eglBindAPI(EGL_OPENGL_API)
    egl.eglCreateContext.restype = c_void_p
    made = bool(count.value and egl.eglCreateContext(display, config, None, None))
    egl.eglTerminate(display)
    return made


def _address(egl: ctypes.CDLL, name: bytes) -> int | None:
    egl.eglGetProcAddress.restype = c_void_p
    egl.eglGetProcAddress.argtypes = [c_char_p]
    address: int | None = egl.eglGetProcAddress(name)
    return address


if __name__ == "__main__":
    sys.exit(main())
