"""Starting the window."""

from __future__ import annotations

import signal
import sys

from PySide6.QtWidgets import QApplication

from crossview.gui.docks import show_focused
from crossview.gui.icons import icon
from crossview.gui.main_window import MainWindow
from crossview.scene import ensure_rendering


def application() -> QApplication:
    """Return the application, made and named on first call."""
    present = QApplication.instance()
    app = present if isinstance(present, QApplication) else QApplication(sys.argv[:1])
    app.setOrganizationName("crossview")
    app.setApplicationName("crossview")
    app.setDesktopFileName("crossview")
    app.setWindowIcon(icon("crossview"))
    if app is not present:
        app.focusChanged.connect(show_focused)
    return app


def run(path: str | None) -> int:
    """Open the window, on `path` (a file, gallery case or built-in surface) if there is one.

    Returns
    -------
    int
        The process's exit status.

    Raises
    ------
    RenderingError
        The machine lacks what drawing needs.
    """
    ensure_rendering()
    app = application()
    for kind in (signal.SIGINT, signal.SIGTERM):  # they end the window too
        signal.signal(kind, signal.SIG_DFL)
    window = MainWindow()
    sys.excepthook = lambda kind, error, trace: window.session.fail(error, "unexpected")
    window.show()
    window.centre.unsaved.look()
    if path is not None:
        window.files.open(path)
    return app.exec()
