"""The list of layers: an eye each, in two columns, so that all are seen at once."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPalette, QResizeEvent
from PySide6.QtWidgets import QApplication, QListView, QListWidget, QListWidgetItem

from crossview.gui.focus_frames import frame_focus
from crossview.gui.icons import icon
from crossview.view.scene_view import LayerKind

ROW, EYE, COLUMNS = 22, 24, 2
"""Height of a row and width of its eye, in pixels, and columns of rows. Chosen."""

SLACK = 4
"""Pixels that rows need besides their own to stand in one column."""


class LayerList(QListWidget):
    """A click on an eye, or Space, shows or hides; a click on a name selects."""

    toggled = Signal(str)
    """Name of the layer whose eye was clicked."""

    def __init__(self, kinds: tuple[LayerKind, ...]) -> None:
        super().__init__()
        self._kinds = kinds
        self.setAccessibleName("Layers")
        frame_focus(self)
        self.setIconSize(QSize(16, 16))
        self.setFlow(QListView.Flow.TopToBottom)
        self.setWrapping(True)
        self.setResizeMode(QListView.ResizeMode.Adjust)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFixedHeight(ROW * -(-len(kinds) // COLUMNS) + SLACK)
        for kind in kinds:
            item = QListWidgetItem(kind.label)
            item.setToolTip(kind.tip)
            self.addItem(item)

    @property
    def current(self) -> str:
        """Name of the layer that is selected; empty: none."""
        row = self.currentRow()
        return "" if row < 0 else self._kinds[row].name

    def select(self, name: str) -> None:
        """Select a layer; one that is not in the list: none."""
        names = [kind.name for kind in self._kinds]
        self.setCurrentRow(names.index(name) if name in names else -1)

    def show_layer(self, name: str, visible: bool, covered: bool) -> None:
        """Open or shut an eye; pale: open, and nothing of it seen under what covers it."""
        item = self.item([kind.name for kind in self._kinds].index(name))
        role = QPalette.ColorRole.PlaceholderText if covered else QPalette.ColorRole.Text
        item.setIcon(icon("eye" if visible else "eye-off"))
        item.setForeground(QApplication.palette().color(role))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Share the width among the columns."""
        self.setGridSize(QSize(self.viewport().width() // COLUMNS, ROW))
        super().resizeEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Let Space do what a click on the eye does."""
        if event.key() == Qt.Key.Key_Space and self.current:
            self.toggled.emit(self.current)
        else:
            super().keyPressEvent(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Toggle what is under an eye."""
        super().mousePressEvent(event)
        item = self.itemAt(event.position().toPoint())
        if item is not None and event.position().x() - self.visualItemRect(item).x() < EYE:
            self.toggled.emit(self._kinds[self.row(item)].name)
