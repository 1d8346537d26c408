"""Can this machine draw? Asked before VTK is, because VTK would crash."""

from __future__ import annotations

import ctypes
import os
import sys
from functools import cache

from solvers.errors import CrossviewError

OFF_SCREEN = {"libEGL.so.1": "libegl1", "libEGL_mesa.so.0": "libgl1-mesa-dri"}
"""Libraries that drawing without a screen needs, and Debian's packages of them."""

ON_SCREEN = {"libGL.so.1": "libgl1", "libX11.so.6": "libx11-6"}
"""Likewise, in a window."""

_EGL_PLATFORM_DEVICE = 0x313F
"""From EGL_EXT_platform_device: `EGL_PLATFORM_DEVICE_EXT`."""


class RenderingError(CrossviewError):
    """What drawing needs is missing on the machine."""


def ensure_rendering() -> None:
    """Make sure that VTK can draw here; call it before the first plotter.

    Without a display, VTK is told to draw off screen through EGL.

    Raises
    ------
    RenderingError
        System libraries are missing; names the command that installs them.
    """
    if not sys.platform.startswith("linux"):
        return
    if os.environ.get("DISPLAY"):
        require({**ON_SCREEN, **OFF_SCREEN})
        return
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    require(OFF_SCREEN)
    if not _egl_starts():
        raise _missing(["a working OpenGL driver"], list(OFF_SCREEN.values()))


def require(packages: dict[str, str]) -> None:
    """Raise unless every library loads; `packages` maps each to the package that holds it.

    Raises
    ------
    RenderingError
        Names what is missing and the command that installs it.
    """
    missing = [library for library in packages if not _loads(library)]
    # Off screen, another vendor's EGL driver may stand in for Mesa's: then EGL starts.
    if missing == ["libEGL_mesa.so.0"] and _egl_starts():
        return
    if missing:
        raise _missing(missing, [packages[library] for library in missing])


def _missing(what: list[str], packages: list[str]) -> RenderingError:
    return RenderingError(
        f"cannot draw, {' and '.join(what)} not found",
        "system libraries",
        "sudo apt-get install -y --no-install-recommends " + " ".join(packages),
    )


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


@cache
def _egl_starts() -> bool:
    """Return whether EGL initialises on one of its devices, as VTK will ask of it."""
    try:
        egl = ctypes.CDLL("libEGL.so.1")
    except OSError:
        return False
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    addresses = [egl.eglGetProcAddress(name) for name in _ENTRY_POINTS]
    if not all(addresses):
        return False
    query_devices = ctypes.CFUNCTYPE(
        ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.POINTER(ctypes.c_int)
    )(addresses[0])
    platform_display = ctypes.CFUNCTYPE(
        ctypes.c_void_p, ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p
    )(addresses[1])
    egl.eglInitialize.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
    devices = (ctypes.c_void_p * 16)()
    count = ctypes.c_int(0)
    if not query_devices(16, ctypes.cast(devices, ctypes.c_void_p), ctypes.byref(count)):
        return False
    displays = (
        platform_display(_EGL_PLATFORM_DEVICE, devices[i], None) for i in range(count.value)
    )
    return any(display and egl.eglInitialize(display, None, None) for display in displays)


_ENTRY_POINTS = (b"eglQueryDevicesEXT", b"eglGetPlatformDisplayEXT")
"""Functions of EGL that it takes to draw without a screen."""


def software_renderer() -> bool:
    """Return whether OpenGL runs on the processor; multi-sampling is then not worth its time."""
    drawn_by = renderer_name().lower()
    return any(name in drawn_by for name in ("llvmpipe", "softpipe", "swrast", "swiftshader"))


_TOLD = ("OpenGL renderer", "OpenGL version")
"""Lines of VTK's report on a window that name what draws."""


@cache
def renderer_name() -> str:
    """Return what draws, as OpenGL tells it: a graphics card or a program, and a version.

    Opens a hidden window of a few pixels, once.
    """
    ensure_rendering()
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    window = vtkRenderWindow()
    window.SetShowWindow(False)
    window.SetUseOffScreenBuffers(True)
    window.SetSize(8, 8)
    window.Render()
    report = window.ReportCapabilities()
    window.Finalize()
    told = dict(line.split(" string: ", 1) for line in report.splitlines() if " string: " in line)
    return ", ".join(told[name].strip() for name in _TOLD if name in told)
