"""The status bar: what is under the mouse, what the background does, how long a frame takes."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QTimer
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QLabel, QProgressBar, QStatusBar, QToolButton

from crossview.gui.picking import Pick
from crossview.session.method_solver import MethodStep
from crossview.session.session import Session
from crossview.session.state import SessionState
from crossview.view.texts import energy, hover
from solvers.progress import Progress

PATIENCE_MS = 250
"""How long a computation takes before its progress is shown, milliseconds.

Chosen: a bar that flickers says less than none.
"""


class Status:
    """Fills a status bar.

    Parameters
    ----------
    bar : QStatusBar
    session : Session
    stop : QAction
        Stops what the background does.
    """

    def __init__(self, bar: QStatusBar, session: Session, stop: QAction) -> None:
        self._session = session
        self._pick: Pick | None = None
        self.hover, self.stage, self.frame = QLabel(), QLabel(), QLabel()
        self.bar = QProgressBar()
        self.bar.setRange(0, 100)
        self.bar.setTextVisible(False)
        self.bar.setFixedSize(140, 10)
        self.stop = QToolButton()
        self.stop.setDefaultAction(stop)
        self.stop.setAutoRaise(True)
        self.frame.setMinimumWidth(90)
        bar.setSizeGripEnabled(False)
        bar.addWidget(self.hover, 1)
        for widget in (self.stage, self.bar, self.stop, self.frame):
            bar.addPermanentWidget(widget)
        # work that ends at once shows nothing: a bar that flickers says less than none
        self._patience = QTimer(bar)
        self._patience.setSingleShot(True)
        self._patience.setInterval(PATIENCE_MS)
        self._patience.timeout.connect(lambda: self._show_bar(True))
        self._show_bar(False)

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state; what is read out is of the field that is shown."""
        if old.shown_surface is not new.shown_surface:
            self.show_hover(None)
        elif old.field is not new.field or old.stale is not new.stale:
            self.show_hover(self._pick)
        if old.progress is not new.progress:
            self._show_progress(new.progress)

    def _show_progress(self, progress: Progress | None) -> None:
        if progress is None:
            self._patience.stop()
            self._show_bar(False)
            return
        self.stage.setText(_stage(progress))
        self.bar.setValue(round(100 * progress.fraction))
        if not self._patience.isActive() and self.bar.isHidden():
            self._patience.start()

    def _show_bar(self, shown: bool) -> None:
        for widget in (self.stage, self.bar, self.stop):
            widget.setVisible(shown)

    def show_hover(self, pick: Pick | None) -> None:
        """Read out the field at the place under the mouse."""
        self._pick = pick
        state = self._session.state
        field = None if state.stale else state.field
        if pick is None:
            self.hover.setText("")
            return
        height = None
        if field is not None and field.surface is state.shown_surface:
            corners = field.H[field.surface.faces[pick.point.face]]
            height = float(np.dot(corners, pick.point.barycentric))
        self.hover.setText(hover(height, pick.point.face))

    def show_frame(self, milliseconds: float) -> None:
        """Say how long a frame took."""
        self.frame.setText(f"{milliseconds:.0f} ms/frame")


def _stage(progress: Progress) -> str:
    if not isinstance(progress, MethodStep):
        return progress.stage
    so_far = progress.step.energies
    return f"{progress.stage} {len(so_far) - 1}  E = {energy(so_far[-1])}"
