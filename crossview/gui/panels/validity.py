"""The Validity panel: budget, what topology forbids, a row per holonomy condition; current."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QFrame,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from crossview.gui.panels.better_places import BetterPlaces
from crossview.gui.panels.verdict_row import VerdictRow
from crossview.session.mending import mendings
from crossview.session.session import Session
from crossview.session.state import SessionState
from crossview.view.colors import BAD, GOOD, UNSURE, WAITING, condition_color
from crossview.view.texts import degrees, signed
from solvers.remedies import Remedy


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
        self.places = BetterPlaces(actions)
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
        layout.addWidget(self.places)
        layout.addStretch()
        self.show_state(None, session.state)

    def show_state(self, old: SessionState | None, new: SessionState) -> None:
        """Follow the window's state."""
        for number, row in enumerate(self.rows):
            row.pin(number == new.focus.pinned)
        self.places.show_state(old, new)
        seen = ("document", "trial", "field", "base", "solution", "moving")
        if old is not None and all(getattr(old, name) is getattr(new, name) for name in seen):
            return
        self._show_budget(new)
        if old is None or _offers(old) != _offers(new):
            self._show_offers(_offered(new))
        self._show_conditions(new)

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
            row.show()  # else it has no height until events are dealt with
            self.rows.append(row)
        # no higher than its rows, so that the buttons stand below what they mend
        self._scroll.setMaximumHeight(self._list.sizeHint().height())
        self._scroll.setMinimumHeight(self.rows[0].sizeHint().height() if self.rows else 0)


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
