"""The toolbar's choice of the valence that the tool "n" places."""

from __future__ import annotations

from PySide6.QtCore import QLocale
from PySide6.QtWidgets import QSpinBox

from crossview.session.commands import MAX_VALENCE, MIN_VALENCE
from crossview.session.session import Session


class ValenceBox(QSpinBox):
    """Chooses any valence; the tool, when it is in hand, carries it at once."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.setLocale(QLocale.c())
        self.setRange(MIN_VALENCE, MAX_VALENCE)
        self.setValue(session.state.any_valence)
        self.setToolTip("Valence that the tool n places")
        self.setAccessibleName("Valence that the tool n places")
        self.valueChanged.connect(session.pointer.choose_valence)
