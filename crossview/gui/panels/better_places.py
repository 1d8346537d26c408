"""What places singularities better, below how coarse the layout is that they have made."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from crossview.gui.panels.verdict_row import VerdictRow
from crossview.session.state import SessionState
from crossview.view.colors import GOOD, UNSURE, WAITING
from crossview.workflow.coarseness import Coarseness
from solvers.errors import counted


class BetterPlaces(QWidget):
    """Patches and T-junctions of the last layout, and buttons that may make them fewer."""

    def __init__(self, actions: Mapping[str, QAction], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.coarseness = VerdictRow()
        self.make_valid, self.improve, self.snap, self.simplify = (
            _button(actions[name]) for name in ("make-valid", "improve", "snap", "simplify")
        )
        self.connections = QLabel()
        self.let_go = _button(actions["let-connections-go"])
        self.let_go.setText("Let go")
        self._kept = QWidget()
        kept = QHBoxLayout(self._kept)
        kept.setContentsMargins(30, 0, 8, 0)
        kept.addWidget(self.connections, 1)
        kept.addWidget(self.let_go)
        self.most = QSpinBox()
        self.most.setPrefix("to ")
        self.most.setAccessibleName("Singularities to simplify to")
        self.most.setToolTip("How many singularities Simplify leaves")
        self.most.setEnabled(self.simplify.isEnabled())
        actions["simplify"].enabledChanged.connect(self.most.setEnabled)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.coarseness)
        layout.addWidget(self._kept)
        buttons = QGridLayout()
        buttons.setContentsMargins(30, 4, 8, 4)
        buttons.setSpacing(6)
        for column, button in enumerate((self.make_valid, self.improve, self.snap)):
            buttons.addWidget(button, 0, column)
            buttons.setColumnStretch(column, 1)
        buttons.addWidget(self.simplify, 1, 0, 1, 2)
        buttons.addWidget(self.most, 1, 2)
        layout.addLayout(buttons)

    def show_state(self, old: SessionState | None, new: SessionState) -> None:
        """Follow the window's state."""
        if old is None or old.document is not new.document:
            self._suggest(new)
            self._show_connections(new)
        self._show_coarseness(new)

    def _suggest(self, state: SessionState) -> None:
        """Suggest half of the singularities that there are, or the fewest that may be left."""
        document = state.document
        count = 0 if document is None else len(document.singularities)
        fewest = 0 if document is None else document.fewest
        if (self.most.minimum(), self.most.maximum()) != (fewest, max(count - 1, fewest)):
            self.most.setRange(fewest, max(count - 1, fewest))
            self.most.setValue(count // 2)

    def _show_connections(self, state: SessionState) -> None:
        """Show how many are kept; nothing where there are none."""
        count = 0 if state.document is None else len(state.document.connections)
        self._kept.setVisible(count > 0)
        self.connections.setText(f"{counted(count, 'connection')} kept")

    def _show_coarseness(self, state: SessionState) -> None:
        """Show that of the last layout, which in a drag is of before it."""
        last = state.last
        self.coarseness.setVisible(last is not None)
        if last is None:
            return
        known = Coarseness.of(last.meshes.layout)
        if known is None:
            none = "No layout yet" if last.meshes.trouble is None else "No layout"
            self.coarseness.show_verdict(WAITING, none, "")
            return
        before = "" if state.field is last.field else "before"
        self.coarseness.show_verdict(UNSURE if known.t_junctions else GOOD, str(known), before)
        self.coarseness.text.setToolTip(f"{known} in the last layout: fewer are better")


def _button(action: QAction) -> QPushButton:
    """Return a push button that follows an action."""
    button = QPushButton(action.text())
    button.setToolTip(action.toolTip())
    button.setEnabled(action.isEnabled())
    button.clicked.connect(action.trigger)
    action.enabledChanged.connect(button.setEnabled)
    return button
