"""The Layers panel: an eye per layer and, below, the settings of the selected one."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFrame,
    QListWidget,
    QListWidgetItem,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from crossview.gui.icons import icon
from crossview.gui.panels.layer_settings import LayerEditor
from crossview.scene import LAYERS
from crossview.session.session import Session
from crossview.session.state import SessionState

ROW, LEAST_ROWS = 24, 5
"""Height of a row in pixels, and rows that are always seen. Chosen."""


class LayersPanel(QWidget):
    """List of layers; a click on the eye shows or hides, a click on the name selects."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self.list = QListWidget()
        self.list.setAccessibleName("Layers")
        self.list.installEventFilter(self)
        self.list.setFrameShape(QFrame.Shape.NoFrame)
        self.list.setIconSize(QSize(18, 18))
        self.list.setUniformItemSizes(True)
        self.list.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.settings = QStackedWidget()
        self.editors: dict[str, LayerEditor] = {}
        for kind in LAYERS:
            item = QListWidgetItem(kind.label)
            item.setSizeHint(QSize(0, ROW))
            self.list.addItem(item)
            self.editors[kind.name] = LayerEditor(kind, session)
            self.settings.addWidget(self.editors[kind.name])
        self.list.setMinimumHeight(LEAST_ROWS * ROW)
        self.list.setMaximumHeight(ROW * len(LAYERS) + 4)
        self.list.currentRowChanged.connect(self.settings.setCurrentIndex)
        self.list.itemPressed.connect(self._pressed)
        self.list.setCurrentRow(1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 4, 0, 4)
        layout.setSpacing(4)
        layout.addWidget(self.list, 3)
        layout.addWidget(self.settings, 1)
        self.show_state(None, session.state)

    def show_state(self, old: SessionState | None, new: SessionState) -> None:
        """Follow the window's state."""
        if old is not None and old.layers is new.layers:
            return
        for row, kind in enumerate(LAYERS):
            visible = new.layers[kind.name].visible
            self.list.item(row).setIcon(icon("eye" if visible else "eye-off"))
            self.editors[kind.name].show_settings(new.layers[kind.name])
            if visible and old is not None and not old.layers[kind.name].visible:
                self.list.setCurrentRow(row)  # its settings are at hand

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Let Space do what a click on the eye does."""
        space = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Space
        if event.type() == QEvent.Type.KeyPress and space:
            self._session.looks.toggle_layer(LAYERS[self.list.currentRow()].name)
            return True
        return super().eventFilter(watched, event)

    def _pressed(self, item: QListWidgetItem) -> None:
        place = self.list.viewport().mapFromGlobal(self.list.cursor().pos())
        if place.x() < 28:
            self._session.looks.toggle_layer(LAYERS[self.list.row(item)].name)
