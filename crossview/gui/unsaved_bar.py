"""The offer to restore what was not saved when a window ended without closing."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from crossview.gui.recovery import Unsaved, unsaved


class UnsavedBar(QFrame):
    """A row for each copy, with buttons to restore and to discard it; hidden without any."""

    restore = Signal(object)
    """The `Unsaved` to be opened."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAutoFillBackground(True)
        self._layout = QVBoxLayout(self)
        self._layout.setContentsMargins(12, 4, 12, 4)
        self._layout.setSpacing(0)
        self._rows: list[QWidget] = []
        self.hide()

    def look(self) -> None:
        """Offer what there is."""
        for row in self._rows:
            row.deleteLater()
        self._rows = [self._row(one) for one in unsaved()]
        for row in self._rows:
            self._layout.addWidget(row)
        self.setVisible(bool(self._rows))

    def _row(self, one: Unsaved) -> QWidget:
        row = QWidget()
        row.setToolTip(one.source)
        restore, discard = QPushButton("Restore"), QPushButton("Discard")
        restore.setAccessibleName(f"Restore {one.words}")
        discard.setAccessibleName(f"Discard {one.words}")
        restore.clicked.connect(lambda: self.restore.emit(one))
        discard.clicked.connect(lambda: self._discard(one))
        layout = QHBoxLayout(row)
        layout.setContentsMargins(0, 4, 0, 4)
        layout.addWidget(QLabel(f"Not saved when crossview last ended: {one.words}"), 1)
        layout.addWidget(restore)
        layout.addWidget(discard)
        return row

    def _discard(self, one: Unsaved) -> None:
        one.forget()
        self.look()
