"""The Validity panel: budget, what topology forbids, a row per holonomy condition; current."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from PySide6.QtCore import QEvent, QSize, Qt, Signal
from PySide6.QtGui import QAction, QEnterEvent, QMouseEvent
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from crossview.gui.icons import verdict_icon
from crossview.session.mending import mendings
from crossview.session.session import Session
from crossview.session.state import SessionState
from crossview.view.colors import BAD, GOOD, UNSURE, WAITING, condition_color
from crossview.view.texts import degrees, signed
from solvers.remedies import Remedy

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


class ValidityPanel(QWidget):
    """Says whether the configuration is valid, by how much not, and what would mend it."""

    def __init__(
        self,
        session: Session,
        actions: Mapping[str, QAction],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._session = session
        self.make_valid, self.improve, self.snap, self.simplify = (
            _button(actions[name]) for name in ("make-valid", "improve", "snap", "simplify")
        )
        self.most = QSpinBox()
        self.most.setPrefix("to ")
        self.most.setAccessibleName("Singularities to simplify to")
        self.most.setToolTip("How many singularities Simplify leaves")
        self.most.setEnabled(self.simplify.isEnabled())
        actions["simplify"].enabledChanged.connect(self.most.setEnabled)
        self.budget, self.existence = VerdictRow(), VerdictRow()
        font = self.budget.text.font()
        font.setBold(True)
        for row in (self.budget, self.existence):
            row.text.setFont(font)
        self.note = QLabel()
        self.note.setWordWrap(True)
        self.note.setContentsMargins(30, 0, 8, 4)
        whole = QSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Minimum)
        whole.setHeightForWidth(True)
        self.note.setSizePolicy(whole)
        self.note.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        self._offers = QVBoxLayout()
        self._offers.setContentsMargins(30, 0, 8, 6)
        self._offers.setSpacing(4)
        self.buttons: list[QPushButton] = []
        self.rows: list[VerdictRow] = []
        self._list = QWidget()
        self._row_layout = QVBoxLayout(self._list)
        self._row_layout.setContentsMargins(0, 0, 0, 0)
        self._row_layout.setSpacing(0)
        self.free = QLabel("No loops to check: the index sum is enough.")
        self.free.setWordWrap(True)
        self.free.setContentsMargins(30, 3, 8, 3)
        self.free.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        self._row_layout.addWidget(self.free)
        self._row_layout.addStretch()
        self._scroll = scroll = QScrollArea()
        scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setWidget(self._list)
        scroll.viewport().setAutoFillBackground(False)
        self._list.setAutoFillBackground(False)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 4, 0, 4)
        layout.setSpacing(0)
        layout.addWidget(self.budget)
        layout.addWidget(self.existence)
        layout.addWidget(self.note)
        layout.addLayout(self._offers)
        layout.addWidget(scroll, 1)
        buttons = QGridLayout()
        buttons.setContentsMargins(30, 4, 8, 4)
        buttons.setSpacing(6)
        for column, button in enumerate((self.make_valid, self.improve, self.snap)):
            buttons.addWidget(button, 0, column)
            buttons.setColumnStretch(column, 1)
        buttons.addWidget(self.simplify, 1, 0, 1, 2)
        buttons.addWidget(self.most, 1, 2)
        layout.addLayout(buttons)
        layout.addStretch()
        self.show_state(None, session.state)

    def show_state(self, old: SessionState | None, new: SessionState) -> None:
        """Follow the window's state."""
        for number, row in enumerate(self.rows):
            row.pin(number == new.focus.pinned)
        seen = ("document", "trial", "field", "base", "solution", "moving")
        if old is not None and all(getattr(old, name) is getattr(new, name) for name in seen):
            return
        self._show_budget(new)
        if old is None or old.document is not new.document:
            self._suggest(new)
        if old is None or _offers(old) != _offers(new):
            self._show_offers(_offered(new))
        self._show_conditions(new)

    def _suggest(self, state: SessionState) -> None:
        """Suggest half of the singularities that there are, where their number has changed."""
        count = 0 if state.document is None else len(state.document.singularities)
        if self.most.maximum() != max(count - 1, 0):
            self.most.setRange(0, max(count - 1, 0))
            self.most.setValue(count // 2)

    def _show_budget(self, state: SessionState) -> None:
        budget = state.budget
        if budget is None:
            self.budget.show_verdict(WAITING, "Open a surface to begin", "")
            self.existence.hide()
            self.note.hide()
            return
        known = state.existence
        theorem = known.theorem if known is not None and budget.satisfied else None
        self.existence.show_verdict(BAD, "Impossible: no quad mesh has these", "")
        self.existence.setVisible(theorem is not None)
        self.budget.show_verdict(
            GOOD if budget.satisfied else BAD,
            f"Index sum {signed(budget.index_sum).lstrip('+')}"
            f" of {signed(budget.required).lstrip('+')}",
            ""
            if budget.satisfied
            else f"{signed(budget.missing)} missing"
            if budget.missing > 0
            else f"{signed(-budget.missing)} too many",
        )
        previewing = state.trial is not None and not state.trial.drag
        placed = "if placed here: click to place it" if budget.satisfied else "if placed here"
        text = placed if previewing else ""
        if theorem is not None:
            text = f"{theorem} {text}".rstrip()
        elif not budget.satisfied and not previewing:
            text = "No field until the indices add up."
        self.note.setText(text)
        self.note.setToolTip(text)
        self.note.setVisible(bool(text))

    def _show_offers(self, offers: tuple[Remedy, ...]) -> None:
        for button in self.buttons:
            self._offers.removeWidget(button)
            button.deleteLater()
        self.buttons = []
        for offer in offers:
            button = QPushButton(offer.label)
            button.clicked.connect(lambda _=False, offer=offer: self._session.carry_out(offer))
            self._offers.addWidget(button)
            self.buttons.append(button)

    def _show_conditions(self, state: SessionState) -> None:
        labels: tuple[str, ...] = ()
        if state.base is not None:
            labels = tuple(c.label for c in state.base.solver.holonomy.conditions)
        self.free.setVisible(state.base is not None and not labels)
        self._make_rows(len(labels))
        defects = state.defects
        for i, (row, label) in enumerate(zip(self.rows, labels, strict=True)):
            if defects is None:
                row.show_verdict(WAITING, label, "")
                continue
            defect = float(np.degrees(defects[i]))
            good = abs(defect) < state.tolerance
            bridged = not good and state.method != "isotropic"
            row.show_verdict(GOOD if good else UNSURE if bridged else BAD, label, degrees(defect))
            if bridged:
                row.text.setToolTip(f"{label}: not closed by itself, the method bridges it")

    def _make_rows(self, count: int) -> None:
        while len(self.rows) > count:
            row = self.rows.pop()
            self._row_layout.removeWidget(row)
            row.deleteLater()
        while len(self.rows) < count:
            number = len(self.rows)
            row = VerdictRow(condition_color(number))
            row.hovered.connect(
                lambda inside, number=number: self._session.pointer.point_out(
                    number if inside else None
                )
            )
            row.clicked.connect(lambda number=number: self._session.pointer.toggle_pin(number))
            self._row_layout.insertWidget(number, row)
            self.rows.append(row)
        # no higher than its rows, so that the buttons stand below what they mend
        self._scroll.setMaximumHeight(self._list.sizeHint().height())


def _offers(state: SessionState) -> tuple[int, int] | None:
    """Return what the remedies offered depend on; None: what the mouse carries is one itself."""
    trial, budget = state.trial, state.budget
    placing = trial is not None and not trial.drag and budget is not None and budget.satisfied
    return None if placing else (id(state.document), id(state.solution) if state.solved else 0)


def _offered(state: SessionState) -> tuple[Remedy, ...]:
    """Return what may be done; where the budget is met, about what the solution is known of."""
    if state.document is None or _offers(state) is None:
        return ()
    known = state.existence
    if known is None or not state.document.budget.satisfied:
        return mendings(state.document)
    return known.remedies


def _button(action: QAction) -> QPushButton:
    """Return a push button that follows an action."""
    button = QPushButton(action.text())
    button.setToolTip(action.toolTip())
    button.setEnabled(action.isEnabled())
    button.clicked.connect(action.trigger)
    action.enabledChanged.connect(button.setEnabled)
    return button
