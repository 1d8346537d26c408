"""Labels of panels: faint titles, and texts in which places are links."""

from __future__ import annotations

from html import escape

from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QLabel


class LinkLabel(QLabel):
    """A text that wraps, can be copied, and whose links are reached by mouse and keyboard."""

    def __init__(self) -> None:
        super().__init__()
        self.setTextFormat(Qt.TextFormat.RichText)
        self.setWordWrap(True)
        flags = Qt.TextInteractionFlag
        self.setTextInteractionFlags(
            flags.TextSelectableByMouse
            | flags.LinksAccessibleByMouse
            | flags.LinksAccessibleByKeyboard
        )

    def paintEvent(self, event: QPaintEvent) -> None:
        """Frame the text while it has the focus."""
        super().paintEvent(event)
        if self.hasFocus():
            with QPainter(self) as painter:
                painter.setPen(self.palette().highlight().color())
                painter.drawRect(self.rect().adjusted(0, 0, -1, -1))


def link(text: str, target: str) -> str:
    """A text that is a link."""
    return f'<a href="{escape(target)}">{escape(text)}</a>'


def faint(text: str) -> QLabel:
    """The title of a row."""
    label = QLabel(text)
    label.setForegroundRole(label.palette().ColorRole.PlaceholderText)
    return label
