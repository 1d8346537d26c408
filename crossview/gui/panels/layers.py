"""The Layers panel: what colours the surface, an eye per layer, the settings of one of them."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QScrollArea,
    QStackedWidget,
    QWidget,
)

from crossview.gui.panels.layer_list import LayerList
from crossview.gui.panels.layer_settings import LayerEditor
from crossview.gui.panels.scrolling import scrolled
from crossview.scene import LAYERS
from crossview.session.session import Session
from crossview.session.state import SessionState
from crossview.view.scalars import SURFACE_SCALARS

SCALAR_KINDS = tuple(kind for kind in LAYERS if kind.name in SURFACE_SCALARS)
"""Layers of which one at a time colours the surface."""

LISTED = tuple(kind for kind in LAYERS if kind.name not in SURFACE_SCALARS)
"""The other layers."""


class LayersPanel(QScrollArea):
    """The settings below are those of what was last chosen or shown above."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self.scalar = QComboBox()
        self.scalar.setAccessibleName("Colour by")
        self.scalar.addItem("Nothing", "")
        for kind in SCALAR_KINDS:
            self.scalar.addItem(kind.label, kind.name)
            self.scalar.setItemData(self.scalar.count() - 1, kind.tip, Qt.ItemDataRole.ToolTipRole)
        self.scalar.activated.connect(self._color_by)
        self.scalar.installEventFilter(self)
        self.list = LayerList(LISTED)
        self.list.toggled.connect(session.looks.toggle_layer)
        self.list.currentRowChanged.connect(lambda _: self._show_settings(self.list.current))
        self.of = QLabel()
        self.of.setContentsMargins(10, 0, 10, 0)
        self.of.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        self.settings = QStackedWidget()
        self.editors = {kind.name: LayerEditor(kind, session) for kind in LAYERS}
        for editor in self.editors.values():
            self.settings.addWidget(editor)
        top = QHBoxLayout()
        top.setContentsMargins(10, 0, 10, 0)
        top.setSpacing(8)
        top.addWidget(QLabel("Colour by"))
        top.addWidget(self.scalar, 1)
        layout = scrolled(self)
        layout.setContentsMargins(0, 4, 0, 4)
        layout.setSpacing(4)
        layout.addLayout(top)
        layout.addWidget(self.list)
        layout.addWidget(self.of)
        layout.addWidget(self.settings)
        layout.addStretch()
        self.show_state(None, session.state)
        self._show_settings("H")

    def show_state(self, old: SessionState | None, new: SessionState) -> None:
        """Follow the window's state."""
        if old is not None and old.layers is new.layers and old.made is new.made:
            return
        shown = next((n for n in SURFACE_SCALARS if new.layers[n].visible), "")
        self.scalar.setCurrentIndex(self.scalar.findData(shown))
        for kind in LISTED:
            self.list.show_layer(kind.name, new.layers[kind.name].visible, kind.name in new.covered)
        for kind in LAYERS:
            self.editors[kind.name].show_settings(new.layers[kind.name])
            appeared = old is not None and not old.layers[kind.name].visible
            if appeared and new.layers[kind.name].visible:
                self._show_settings(kind.name)  # they are at hand

    def show_limits(self, name: str, limits: tuple[float, float]) -> None:
        """Say which range a scalar is drawn with."""
        self.editors[name].show_limits(limits)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Show the settings of the scalar when its box is gone to."""
        if event.type() == QEvent.Type.FocusIn:
            self._show_settings(self.scalar.currentData())
        return super().eventFilter(watched, event)

    def _color_by(self) -> None:
        self._session.looks.color_by(self.scalar.currentData())
        self._show_settings(self.scalar.currentData())

    def _show_settings(self, name: str) -> None:
        if not name:
            return
        self.list.select(name)
        self.of.setText(next(kind.label for kind in LAYERS if kind.name == name))
        self.settings.setCurrentWidget(self.editors[name])
