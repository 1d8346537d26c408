"""Where window and docks stand, kept in the user's settings from one session to the next."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QByteArray, QSettings

from crossview.gui.docks import size_docks

if TYPE_CHECKING:
    from crossview.gui.main_window import MainWindow

GEOMETRY, DOCKS = "window/geometry", "window/docks"
VERSION = 1
"""To be raised when docks come or go: an older arrangement is then forgotten."""


class Arrangement:
    """The arrangement of a window's docks, once it is shown.

    Parameters
    ----------
    window : MainWindow
        With its docks; takes the size and place it had last.
    """

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self._first = window.saveState(VERSION)
        self._shown = False
        geometry = QSettings().value(GEOMETRY)
        if isinstance(geometry, QByteArray):
            window.restoreGeometry(geometry)

    def show(self) -> None:
        """Arrange the docks of a window that has just got its size; once."""
        if self._shown:
            return
        self._shown = True
        size_docks(self._window)
        docks = QSettings().value(DOCKS)
        if isinstance(docks, QByteArray):
            self._window.restoreState(docks, VERSION)

    def keep(self) -> None:
        """Remember the arrangement for the next session."""
        if self._shown:
            settings = QSettings()
            settings.setValue(GEOMETRY, self._window.saveGeometry())
            settings.setValue(DOCKS, self._window.saveState(VERSION))

    def reset(self) -> None:
        """Put the docks back to where they stand at first."""
        self._window.restoreState(self._first, VERSION)
        size_docks(self._window)
