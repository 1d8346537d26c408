"""The toolbar's choice of method."""

from __future__ import annotations

from PySide6.QtWidgets import QComboBox

from crossview.cases.model import METHODS
from crossview.session.commands import METHOD_LABELS
from crossview.session.session import Session
from crossview.session.state import SessionState


class MethodBox(QComboBox):
    """Shows and chooses the method of the document."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        for method in METHODS:
            self.addItem(METHOD_LABELS[method], method)
        self.setToolTip("Method: how the field is made; keys 1, 2, 3 of the keypad")
        self.setAccessibleName("Method")
        self.setEnabled(False)
        self.activated.connect(lambda row: session.edits.choose_method(METHODS[row]))

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        if old.document is not new.document:
            self.setCurrentIndex(METHODS.index(new.method))
            self.setEnabled(new.document is not None)
