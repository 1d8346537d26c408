"""Features in the Surface panel: sharp edges by angle, edges marked by hand."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QLocale, QTimer
from PySide6.QtWidgets import (
    QCheckBox,
    QDoubleSpinBox,
    QHBoxLayout,
    QLabel,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from crossview.session.session import Session
from crossview.session.state import SessionState
from crossview.view.texts import count, degrees
from crossview.workflow.solution import Solution

USUAL_ANGLE = 40.0
"""Degrees that sharp edges bend by, if nothing else is said. Chosen."""

STILL_MS = 600
"""How long the angle must stay before it is taken."""


class FeaturesBox(QWidget):
    """An angle that is shown as it changes and taken when it rests, and buttons."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self.sharp = QCheckBox("Features over")
        self.sharp.setToolTip("Crosses follow edges over which the surface bends by more than this")
        self.angle = QDoubleSpinBox()
        self.angle.setLocale(QLocale.c())
        self.angle.setRange(1.0, 180.0)
        self.angle.setDecimals(0)
        self.angle.setSuffix("\u00b0")
        self.angle.setValue(USUAL_ANGLE)
        self.mark, self.clear = QToolButton(), QToolButton()
        self.mark.setText("Mark")
        self.mark.setCheckable(True)
        self.mark.setToolTip(
            "A click marks an edge or no longer; with Shift the path from the last click"
        )
        self.clear.setText("Clear")
        self.clear.setToolTip("No features any more")
        self.mark.setEnabled(False)
        self.clear.setEnabled(False)
        self.angle.setAccessibleName("Angle that features bend by, degrees")
        self.found = QLabel()
        self.found.setWordWrap(True)
        self._still = QTimer(self)
        self._still.setSingleShot(True)
        self._still.setInterval(STILL_MS)
        self._still.timeout.connect(session.feature_marks.accept)
        self.sharp.toggled.connect(self._toggled)
        self.angle.valueChanged.connect(self._try)
        self.mark.clicked.connect(lambda: session.feature_marks.take_tool())
        self.clear.clicked.connect(lambda: session.feature_marks.clear())
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        line = QHBoxLayout()
        line.setSpacing(4)
        for widget in (self.sharp, self.angle, self.mark, self.clear):
            line.addWidget(widget)
        line.addStretch()
        layout.addLayout(line)
        layout.addWidget(self.found)

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        self.mark.setChecked(new.mark_tool is not None)
        self.mark.setEnabled(new.document is not None)
        seen = ("document", "feature_trial", "field", "base", "mark_tool")
        if all(getattr(old, name) is getattr(new, name) for name in seen):
            return
        features = new.features
        self.clear.setEnabled(features is not None and len(features) > 0)
        self.found.setText(_found(new))
        if new.document is None or new.feature_trial is not None:
            return
        if old.document is not new.document:
            self._still.stop()
            chosen = new.document.problem.marking.dihedral_degrees
            for widget in (self.sharp, self.angle):
                widget.blockSignals(True)
            self.sharp.setChecked(chosen is not None)
            if chosen is not None:
                self.angle.setValue(chosen)
            for widget in (self.sharp, self.angle):
                widget.blockSignals(False)

    def _toggled(self, on: bool) -> None:
        self._still.stop()
        self._session.feature_marks.try_angle(self.angle.value() if on else None)
        self._session.feature_marks.accept()

    def _try(self, angle: float) -> None:
        if self.sharp.isChecked():
            self._session.feature_marks.try_angle(angle)
            self._still.start()


def _found(state: SessionState) -> str:
    if state.document is None:
        return ""
    trial = state.feature_trial
    features = state.document.problem.features if trial is None else trial.features
    if not len(features):
        hint = "click edges to mark them; Shift: the path from the last click"
        angle = None if trial is None else trial.marking.dihedral_degrees
        if trial is None:
            angle = state.document.problem.marking.dihedral_degrees
        none = "" if angle is None else f"No edge bends by more than {angle:g}\u00b0"
        return hint.capitalize() if state.mark_tool is not None else none
    text = f"{count(len(features), 'edge')} in {count(len(features.curves), 'curve')}"
    field = state.field_along_features
    if trial is None and field is not None:
        off = float(np.degrees(np.abs(field.feature_misalignment).max(initial=0.0)))
        text += f", off by up to {degrees(off)}" if off > state.tolerance else ", followed"
    if trial is None and (released := _released(state)):
        text += f"; released {released}"
    if trial is None and (forced := _forced(state)):
        text += f"; singularities do not fit at {count(forced, 'vertex', 'vertices')}"
    return text


def _released(state: SessionState) -> str:
    """Return how many curves the field shown does not follow, and why; empty if there are none."""
    solution = _shown(state)
    if solution is None:
        return ""
    return ", ".join(
        f"{count(len(features.curves), 'curve')}, {reason}"
        for reason, features in solution.released_for.items()
    )


def _forced(state: SessionState) -> int:
    """Return at how many vertices the field shown must turn a corner that no angle asks for."""
    solution = _shown(state)
    if solution is None or solution.integrated is None:
        return 0
    return len(solution.integrated.aligned.forced_corners)


def _shown(state: SessionState) -> Solution | None:
    """Return the solution whose field is shown."""
    solution = state.solution
    return solution if solution is not None and state.field is solution.field else None
