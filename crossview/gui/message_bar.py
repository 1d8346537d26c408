"""One line over the scene: errors and hints, with details to copy and what to do about it."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from crossview.gui.icons import colored_icon, put_icon
from crossview.session.message import Message
from crossview.session.session import Session
from crossview.session.state import SessionState
from crossview.view.colors import BAD
from solvers.remedies import Remedy

TINTS = {"error": BAD, "warning": "#b7791f", "info": "#2f6fde"}
"""Colours of messages."""

MOST_WIDTH, MARGIN = 720, 12
"""Of a message, and its distance from the edges, in pixels. Chosen."""


class MessageBar(QFrame):
    """Floats at the top of its parent; not modal; goes when the state's message goes."""

    def __init__(self, session: Session, parent: QWidget) -> None:
        super().__init__(parent)
        self._session = session
        self._over = parent
        self.setObjectName("message-bar")
        self.setAutoFillBackground(True)
        self.setBackgroundRole(self.palette().ColorRole.Base)
        self._icon = QLabel()
        self.text = QLabel()
        self.text.setWordWrap(True)
        self.text.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.text.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        font = self.text.font()
        font.setBold(True)
        self.text.setFont(font)
        self.below = QLabel()
        self.below.setWordWrap(True)
        self.below.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.below.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        self.details_button = QPushButton("Details")
        self.details_button.setCheckable(True)
        self.details_button.toggled.connect(self._show_details)
        self.copy_button = QToolButton()
        put_icon(self.copy_button, "copy")
        self.copy_button.setToolTip("Copy the details")
        self.copy_button.setAccessibleName("Copy the details")
        self.copy_button.setAutoRaise(True)
        self.copy_button.clicked.connect(self.copy)
        close = QToolButton()
        put_icon(close, "close")
        close.setToolTip("Dismiss")
        close.setAccessibleName("Dismiss")
        close.setAutoRaise(True)
        close.clicked.connect(lambda: self._session.dismiss())
        self.details = QPlainTextEdit()
        self.details.setReadOnly(True)
        self.details.setAccessibleName("Details")
        self.details.setFixedHeight(104)
        self.action_buttons: list[QPushButton] = []
        line = QHBoxLayout()
        line.setSpacing(8)
        top = Qt.AlignmentFlag.AlignTop
        line.addWidget(self._icon, 0, top)
        line.addWidget(self.text, 1)
        line.addWidget(close, 0, top)
        self._buttons = QHBoxLayout()
        self._buttons.setSpacing(6)
        self._buttons.addStretch()
        self._buttons.addWidget(self.details_button)
        self._buttons.addWidget(self.copy_button)
        self._layout = QVBoxLayout(self)
        self._layout.setContentsMargins(12, 8, 8, 8)
        self._layout.addLayout(line)
        second = QHBoxLayout()
        second.setContentsMargins(28, 0, 8, 0)  # below the text, beside the icon
        second.addWidget(self.below)
        self._layout.addLayout(second)
        self._layout.addLayout(self._buttons)
        self._layout.addWidget(self.details)
        self.hide()

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        if old.message is not new.message:
            self._show(new.message)

    def place(self) -> None:
        """Keep to the top of the parent, as wide as it needs to be."""
        width = min(MOST_WIDTH, self._over.width() - 2 * MARGIN)
        self._layout.activate()
        self.resize(width, self._layout.totalHeightForWidth(width))
        self.move((self._over.width() - width) // 2, MARGIN)

    def copy(self) -> None:
        """Copy text and details."""
        parts = (self.text.text(), self.below.text(), self.details.toPlainText())
        text = "\n\n".join(part for part in parts if part)
        QGuiApplication.clipboard().setText(text)

    def _show(self, message: Message | None) -> None:
        self.setVisible(message is not None)
        if message is None:
            return
        tint = TINTS[message.severity]
        self.setStyleSheet(
            f"#message-bar {{ background: palette(base); border: 1px solid {tint};"
            f" border-left: 4px solid {tint}; border-radius: 4px; }}"
        )
        self._icon.setPixmap(colored_icon(message.severity, tint).pixmap(QSize(20, 20)))
        self.text.setText(message.text[:1].upper() + message.text[1:])
        self.below.setText(message.below)
        self.below.setVisible(bool(message.below))
        self.details.setPlainText(message.details)
        self.details_button.setVisible(bool(message.details))
        self.copy_button.setVisible(bool(message.details))
        self.details_button.setChecked(False)
        self._show_details(False)
        for button in self.action_buttons:
            self._buttons.removeWidget(button)
            button.deleteLater()
        self.action_buttons = [self._button(message, remedy) for remedy in message.remedies]
        self.raise_()
        self.place()

    def _button(self, message: Message, remedy: Remedy) -> QPushButton:
        button = QPushButton(remedy.label)
        button.clicked.connect(lambda: self._session.carry_out(remedy, message.tried))
        self._buttons.insertWidget(self._buttons.count() - 3, button)
        return button

    def _show_details(self, shown: bool) -> None:
        self.details.setVisible(shown)
        self.place()
