"""The docks: which panel stands where, and how large at first."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QLabel, QTabWidget, QWidget

if TYPE_CHECKING:
    from crossview.gui.main_window import MainWindow

LEFT, RIGHT = Qt.DockWidgetArea.LeftDockWidgetArea, Qt.DockWidgetArea.RightDockWidgetArea
LEFT_WIDTH, RIGHT_WIDTH = 316, 232
LEFT_LEAST, RIGHT_LEAST = 272, 208
TABS = ("Convergence", "Quads", "Export")
"""Docks that share one place, the first in front."""


def add_docks(window: MainWindow) -> dict[str, QDockWidget]:
    """Stand the panels of `window` in docks; return these by title."""
    places: tuple[tuple[str, QWidget, Qt.DockWidgetArea], ...] = (
        ("Surface", window.surface_panel, LEFT),
        ("Singularities", window.singularities_panel, LEFT),
        ("Validity", window.validity_panel, LEFT),
        ("Layers", window.layers_panel, RIGHT),
        ("Convergence", window.convergence_panel, RIGHT),
        ("Quads", window.quads_panel, RIGHT),
        ("Export", window.export_panel, RIGHT),
    )
    docks = {}
    for title, panel, area in places:
        dock = QDockWidget(title, window)
        dock.setObjectName(title)
        panel.setAutoFillBackground(True)
        panel.setBackgroundRole(panel.palette().ColorRole.Base)
        panel.setMinimumWidth(LEFT_LEAST if area == LEFT else RIGHT_LEAST)
        dock.setWidget(panel)
        dock.setTitleBarWidget(QWidget() if title in TABS else _title_bar(title))
        window.addDockWidget(area, dock)
        docks[title] = dock
    window.setTabPosition(RIGHT, QTabWidget.TabPosition.North)
    for title, following in pairwise(TABS):
        window.tabifyDockWidget(docks[title], docks[following])
    docks[TABS[0]].raise_()
    return docks


def size_docks(window: MainWindow) -> None:
    """Give the docks of a shown window their first sizes: what has little to say, little room."""
    docks, height = window.docks, window.centre.height()
    window.resizeDocks(
        [docks["Surface"], docks["Layers"]], [LEFT_WIDTH, RIGHT_WIDTH], Qt.Orientation.Horizontal
    )
    for column, shares in (
        (("Surface", "Singularities", "Validity"), (0.27, 0.39, 0.34)),
        (("Layers", "Convergence"), (0.52, 0.48)),
    ):
        window.resizeDocks(
            [docks[title] for title in column],
            [round(height * share) for share in shares],
            Qt.Orientation.Vertical,
        )


def _title_bar(title: str) -> QLabel:
    """Return a calm title; it is still what a dock is dragged by."""
    label = QLabel(title)
    label.setContentsMargins(8, 5, 8, 5)
    font = label.font()
    font.setBold(True)
    label.setFont(font)
    label.setForegroundRole(label.palette().ColorRole.PlaceholderText)
    return label
