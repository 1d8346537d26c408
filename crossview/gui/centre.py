"""What stands in the middle of the window."""

from __future__ import annotations

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QStackedWidget, QVBoxLayout, QWidget

from crossview.gui.empty_state import EmptyState
from crossview.gui.message_bar import MessageBar
from crossview.gui.tour import Tour
from crossview.gui.unsaved_bar import UnsavedBar
from crossview.gui.viewport import Viewport
from crossview.session.session import Session
from crossview.session.state import SessionState


class Centre(QWidget):
    """The offer to restore and the tour, below them the empty state or the viewport.

    The message bar floats.
    """

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.empty = EmptyState()
        self.viewport = Viewport(session)
        self.stack = QStackedWidget()
        self.stack.addWidget(self.empty)
        self.stack.addWidget(self.viewport)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        self.unsaved, self.tour = UnsavedBar(), Tour()
        layout.setSpacing(0)
        layout.addWidget(self.unsaved)
        layout.addWidget(self.tour)
        layout.addWidget(self.stack, 1)
        self.message_bar = MessageBar(session, self)

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        nothing = new.document is None and new.faulty is None
        self.stack.setCurrentWidget(self.empty if nothing else self.viewport)
        self.tour.show_state(old, new)
        self.viewport.show_state(old, new)
        self.message_bar.show_state(old, new)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the bar in its place."""
        super().resizeEvent(event)
        self.message_bar.place()
