"""The docks: which panel stands where, and how large at first."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QLabel, QMainWindow, QScrollArea, QTabWidget, QWidget

LEFT, RIGHT = Qt.DockWidgetArea.LeftDockWidgetArea, Qt.DockWidgetArea.RightDockWidgetArea
"""Where panels are docked."""

BOTTOM = Qt.DockWidgetArea.BottomDockWidgetArea
"""Where those are that are hidden at first."""

LEFT_WIDTH, RIGHT_WIDTH = 316, 248
"""Widths of both sides at first, in pixels. Chosen."""

LEFT_LEAST, RIGHT_LEAST = 286, 246
"""Least widths of panels on both sides, in pixels. Chosen: all words are read beside a bar."""

LEFT_COLUMN = ("Surface", "Singularities", "Validity")
"""Panels on the left, from the top; the others are on the right."""

HIDDEN = ("Log",)
"""Panels that are at the bottom, once they are wanted."""

TABS = ("Convergence", "Quads", "Export")
"""Docks that share one place, the first in front."""


def add_docks(window: QMainWindow, panels: Mapping[str, QWidget]) -> dict[str, QDockWidget]:
    """Stand panels, given by title from the top left down, in docks; return these by title."""
    docks = {}
    for title, panel in panels.items():
        area = BOTTOM if title in HIDDEN else LEFT if title in LEFT_COLUMN else RIGHT
        dock = QDockWidget(title, window)
        dock.setObjectName(title)
        panel.setAutoFillBackground(True)
        panel.setBackgroundRole(panel.palette().ColorRole.Base)
        panel.setMinimumWidth(LEFT_LEAST if area == LEFT else RIGHT_LEAST)
        dock.setWidget(panel)
        dock.setTitleBarWidget(QWidget() if title in TABS else _title_bar(title))
        window.addDockWidget(area, dock)
        dock.setVisible(title not in HIDDEN)
        docks[title] = dock
    window.setTabPosition(RIGHT, QTabWidget.TabPosition.North)
    for title, following in pairwise(TABS):
        window.tabifyDockWidget(docks[title], docks[following])
    docks[TABS[0]].raise_()
    return docks


def size_docks(window: QMainWindow, docks: Mapping[str, QDockWidget]) -> None:
    """Give the docks of a shown window their first sizes: what has little to say, little room."""
    middle = window.centralWidget() or window
    height = middle.height()
    window.resizeDocks(
        [docks["Surface"], docks["Layers"]], [LEFT_WIDTH, RIGHT_WIDTH], Qt.Orientation.Horizontal
    )
    for column, shares in (
        (LEFT_COLUMN, (0.27, 0.39, 0.34)),
        (("Layers", "Convergence"), (0.56, 0.44)),
    ):
        window.resizeDocks(
            [docks[title] for title in column],
            [round(height * share) for share in shares],
            Qt.Orientation.Vertical,
        )


def show_focused(_: QWidget | None, widget: QWidget | None) -> None:
    """Bring to the front, and into view, what the focus has come to."""
    around = widget
    while widget is not None and around is not None:
        if isinstance(around, QDockWidget) and around.visibleRegion().isEmpty():
            around.raise_()
        if isinstance(around, QScrollArea):
            around.ensureWidgetVisible(widget, 0, 0)
        around = around.parentWidget()


def _title_bar(title: str) -> QLabel:
    """Return a calm title; it is still what a dock is dragged by."""
    label = QLabel(title)
    label.setContentsMargins(8, 5, 8, 5)
    font = label.font()
    font.setBold(True)
    label.setFont(font)
    label.setForegroundRole(label.palette().ColorRole.PlaceholderText)
    return label
