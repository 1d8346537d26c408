"""The toolbar's button that solves, and stops what takes long."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QToolButton

from crossview.gui.status import PATIENCE_MS
from crossview.session.state import SessionState


class SolveButton(QToolButton):
    """Solves; while something runs for longer than a blink, it stops that.

    Parameters
    ----------
    solve, stop : QAction
    """

    def __init__(self, solve: QAction, stop: QAction) -> None:
        super().__init__()
        self._solve, self._stop = solve, stop
        self.setAutoRaise(True)
        self.setIconSize(QSize(20, 20))
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self._patience = QTimer(self)
        self._patience.setSingleShot(True)
        self._patience.setInterval(PATIENCE_MS)
        self._patience.timeout.connect(lambda: self._offer(stop))
        widths = []
        for action in (stop, solve):
            self._offer(action)
            widths.append(self.sizeHint().width())
        self.setMinimumWidth(max(widths))  # nothing beside it jumps

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        if new.progress is None:
            self._patience.stop()
            self._offer(self._solve)
        elif self.defaultAction() is not self._stop and not self._patience.isActive():
            self._patience.start()

    def _offer(self, action: QAction) -> None:
        for before in self.actions():  # two of them would be a menu
            self.removeAction(before)
        self.setDefaultAction(action)
