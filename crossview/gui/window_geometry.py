"""Where window and docks stand, kept in the user's settings from one session to the next."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QByteArray, QSettings
from PySide6.QtWidgets import QDockWidget, QMainWindow

from crossview.gui.docks import size_docks

GEOMETRY, DOCKS = "window/geometry", "window/docks"
"""Where settings keep the place of the window, and that of its panels."""

VERSION = 2
"""To be raised when docks come or go: what was kept of others is then forgotten."""


class WindowGeometry:
    """Size and place of a window and its docks, once it is shown.

    Parameters
    ----------
    window : QMainWindow
        Takes the size and place it had last.
    docks : mapping of str to QDockWidget
        By title, as `add_docks` made them.
    """

    def __init__(self, window: QMainWindow, docks: Mapping[str, QDockWidget]) -> None:
        self._window = window
        self._docks = docks
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
        size_docks(self._window, self._docks)
        docks = QSettings().value(DOCKS)
        if isinstance(docks, QByteArray):
            self._window.restoreState(docks, VERSION)

    def keep(self) -> None:
        """Remember where all stands for the next session."""
        if self._shown:
            settings = QSettings()
            settings.setValue(GEOMETRY, self._window.saveGeometry())
            settings.setValue(DOCKS, self._window.saveState(VERSION))

    def reset(self) -> None:
        """Put the docks back to where they stand at first."""
        self._window.restoreState(self._first, VERSION)
        size_docks(self._window, self._docks)
