"""Preferences in force: the theme of a window and its scene, and what is as preferred at first."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QWidget

from crossview.gui.focus_frames import renew_frames
from crossview.gui.icons import renew_icons
from crossview.gui.preferences import Preferences, PreferencesDialog
from crossview.gui.theme import apply_theme


class Appearance(QObject):
    """Keeps a window as its user prefers; made before what stands in it.

    Parameters
    ----------
    window : QWidget
    """

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self._window = window
        self.preferences = Preferences.load()
        self.preferred: list[Callable[[Preferences], object]] = []
        """Told of preferences that come into force."""
        self.themed: list[Callable[[], object]] = []
        """Told that the theme may be another."""
        apply_theme(self.preferences.theme)
        QGuiApplication.styleHints().colorSchemeChanged.connect(self._follow_theme)

    def show_dialog(self) -> None:
        """Open the dialog of preferences."""
        dialog = PreferencesDialog(self.preferences, self.prefer, self._window)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.show()

    def prefer(self, preferences: Preferences) -> None:
        """Put preferences in force, and keep them."""
        preferences.keep()
        self.preferences = preferences
        apply_theme(preferences.theme)
        self._follow_theme()
        for tell in self.preferred:
            tell(preferences)

    def _follow_theme(self) -> None:
        renew_icons(self._window)
        renew_frames(self._window)
        for tell in self.themed:
            tell()
