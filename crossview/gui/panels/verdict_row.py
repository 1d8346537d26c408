"""A row of the Validity panel: a sign, what it is about, and a value."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QSize, Qt, Signal
from PySide6.QtGui import QEnterEvent, QMouseEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QWidget

from crossview.gui.icons import verdict_icon

DOT = QSize(14, 14)
"""Size of the sign that tells the verdict, in pixels. Chosen."""

SAMPLE = QSize(18, 3)
"""Of the line in the colour of a condition's loop, in pixels. Chosen."""


class VerdictRow(QFrame):
    """A sign, what it is about, and a value at the right.

    Parameters
    ----------
    line : str
        Colour of what belongs to the row in the scene, shown by a piece of line; empty: none.
    """

    hovered = Signal(bool)
    clicked = Signal()

    def __init__(self, line: str = "", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dot, self.text, self.value = QLabel(), QLabel(), QLabel()
        self.value.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.text.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.color = ""
        layout = QHBoxLayout(self)
        layout.setContentsMargins(8, 3, 8, 3)
        layout.setSpacing(8)
        layout.addWidget(self._dot)
        layout.addWidget(self.text, 1)
        if line:
            sample = QFrame()
            sample.setFixedSize(SAMPLE)
            sample.setStyleSheet(f"background: {line}")
            sample.setToolTip("Colour of its loop and guide lines in the scene")
            layout.addWidget(sample)
        layout.addWidget(self.value)

    def show_verdict(self, color: str, text: str, value: str) -> None:
        """Show a sign, a key of `SIGNS`, a text and a value."""
        if color != self.color:
            self.color = color
            self._dot.setPixmap(verdict_icon(color).pixmap(DOT))
        self.text.setText(text)
        self.text.setToolTip(text)
        self.value.setText(value)

    def pin(self, pinned: bool) -> None:
        """Show whether the guide keeps to this row."""
        font = self.text.font()
        font.setBold(pinned)
        self.text.setFont(font)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Tell of a click."""
        self.clicked.emit()
        super().mousePressEvent(event)

    def enterEvent(self, event: QEnterEvent) -> None:
        """Tell that the mouse is here."""
        self.setBackgroundRole(self.palette().ColorRole.AlternateBase)
        self.setAutoFillBackground(True)
        self.hovered.emit(True)
        super().enterEvent(event)

    def leaveEvent(self, event: QEvent) -> None:
        """Tell that the mouse has gone."""
        self.setAutoFillBackground(False)
        self.hovered.emit(False)
        super().leaveEvent(event)
