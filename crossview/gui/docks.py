"""The docks: which panel stands where, and how large at first."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QLabel, QWidget

if TYPE_CHECKING:
    from crossview.gui.main_window import MainWindow

LEFT, RIGHT = Qt.DockWidgetArea.LeftDockWidgetArea, Qt.DockWidgetArea.RightDockWidgetArea
LEFT_WIDTH, RIGHT_WIDTH = 288, 232


def add_docks(window: MainWindow) -> dict[str, QDockWidget]:
    """Stand the panels of `window` in docks; return these by title."""
    places: tuple[tuple[str, QWidget, Qt.DockWidgetArea, int], ...] = (
        ("Surface", window.surface_panel, LEFT, 150),
        ("Singularities", window.singularities_panel, LEFT, 300),
        ("Validity", window.validity_panel, LEFT, 230),
        ("Layers", window.layers_panel, RIGHT, 440),
        ("Export", window.export_panel, RIGHT, 200),
    )
    docks = {}
    for title, panel, area, _ in places:
        dock = QDockWidget(title, window)
        dock.setObjectName(title)
        panel.setAutoFillBackground(True)
        panel.setBackgroundRole(panel.palette().ColorRole.Base)
        dock.setWidget(panel)
        dock.setTitleBarWidget(_title_bar(title))
        window.addDockWidget(area, dock)
        docks[title] = dock
    window.resizeDocks(
        [docks[title] for title, *_ in places],
        [height for *_, height in places],
        Qt.Orientation.Vertical,
    )
    window.resizeDocks(
        [docks["Surface"], docks["Layers"]], [LEFT_WIDTH, RIGHT_WIDTH], Qt.Orientation.Horizontal
    )
    return docks


def _title_bar(title: str) -> QLabel:
    """Return a calm title; it is still what a dock is dragged by."""
    label = QLabel(title)
    label.setContentsMargins(8, 5, 8, 5)
    font = label.font()
    font.setBold(True)
    label.setFont(font)
    label.setForegroundRole(label.palette().ColorRole.PlaceholderText)
    return label
