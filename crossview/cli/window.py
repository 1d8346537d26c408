"""The command without a name: open the window."""

from __future__ import annotations

import ctypes
import os
import sys
from importlib.util import find_spec
from typing import Annotated

from cyclopts import Parameter

from solvers.errors import CrossviewError


def window(
    file: str | None = None,
    /,
    *,
    install_desktop: Annotated[bool, Parameter(negative="", show_default=False)] = False,
) -> int:
    """Impose singularities on a surface, solve its cross-field, and see whether it is valid.

    Opens the window; the commands do the same without one.

    Parameters
    ----------
    file
        A surface, a case, or the name of a gallery case.
    install_desktop
        Open no window; put the program among the applications of the desktop (Linux), with its
        icon and case files named NAME.crossview.json.
    """
    if install_desktop:
        from crossview.cli.desktop import install_desktop as install

        install()
        return 0
    if file is not None:
        from crossview.cases.gallery import find_case

        find_case(file)  # what is not there is told here, not by an empty window
    require_qt(file)
    require_display(file)
    from crossview.gui.app import run  # Qt is loaded only for the window

    return run(file)


def require_qt(file: str | None) -> None:
    """Refuse where crossview is installed without what only the window needs.

    Raises
    ------
    CrossviewError
        PySide6 or pyvistaqt is missing.
    """
    missing = [name for name in ("PySide6", "pyvistaqt") if find_spec(name) is None]
    if missing:
        raise CrossviewError(
            f"the window needs {' and '.join(missing)}",
            "not installed",
            f"pip install {' '.join(missing)}, or draw without a window: "
            f"crossview render {file or 'CASE'} -o figure.png",
        )


def require_display(file: str | None) -> None:
    """Refuse where there is no screen to open a window on.

    Raises
    ------
    CrossviewError
        No display is named, or the X server that is does not answer.
    """
    if not sys.platform.startswith("linux"):
        return
    if os.environ.get("WAYLAND_DISPLAY") or os.environ.get("QT_QPA_PLATFORM"):
        return
    display = os.environ.get("DISPLAY")
    if display and _answers():
        return
    raise CrossviewError(
        "no display to open the window on",
        f"DISPLAY={display}" if display else "DISPLAY is not set",
        f"crossview render {file or 'CASE'} -o figure.png draws without one",
    )


def _answers() -> bool:
    """Whether the X server answers; Qt would end the process if it does not."""
    try:
        xcb = ctypes.CDLL("libxcb.so.1")
    except OSError:
        return True  # left to Qt, which names the libraries it misses
    xcb.xcb_connect.restype = ctypes.c_void_p
    xcb.xcb_connection_has_error.argtypes = [ctypes.c_void_p]
    xcb.xcb_disconnect.argtypes = [ctypes.c_void_p]
    connection = xcb.xcb_connect(None, None)
    failed = bool(xcb.xcb_connection_has_error(connection))
    xcb.xcb_disconnect(connection)
    return not failed
