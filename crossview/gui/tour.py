"""A tour of one minute: what to do first, a step after the other, each done by the user."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QWidget

from crossview.session.state import SessionState

CASE = "annulus-near"
"""What the tour is of: nearly valid, so that there is something to mend."""


@dataclass(frozen=True)
class Step:
    """What to do, and when it is done."""

    text: str
    done: Callable[[SessionState], bool]


STEPS = (
    Step(
        "<b>Drag a coloured disc</b>, a singularity: the field follows. Ctrl+Z takes it back.",
        lambda state: state.trial is None and state.undo_name is not None,
    ),
    Step(
        "With one size of quads no field closes round the hole, see <i>Validity</i>: press "
        "<b>Make valid</b>.",
        lambda state: state.valid and state.solved,
    ),
    Step(
        "Press <b>Make quads</b>, at the upper right: the surface is filled along the field.",
        lambda state: state.made.quads is not None,
    ),
    Step(
        "Add singularities with <b>3</b>, <b>5</b> and a click. <b>Ctrl+Shift+P</b> finds every "
        "action, <b>F1</b> lists the keys.",
        lambda state: False,
    ),
)
"""The tour."""


class Tour(QFrame):
    """A bar over the scene with the step to do; hidden when there is none."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAutoFillBackground(True)
        self.text = QLabel()
        self.text.setWordWrap(True)
        self.onward, self.leave = QPushButton("Next"), QPushButton("End the tour")
        self.onward.clicked.connect(self._go_on)
        self.leave.clicked.connect(self.end)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(12, 8, 12, 8)
        layout.addWidget(self.text, 1)
        layout.addWidget(self.onward)
        layout.addWidget(self.leave)
        self._at: int | None = None
        self._waits = False
        self.hide()

    def start(self) -> None:
        """Begin as soon as the tour's case is open."""
        self._waits = True

    def end(self) -> None:
        """Take the bar away."""
        self._at, self._waits = None, False
        self.hide()

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state: begin, go on when a step is done, end with the case."""
        if old.document is not new.document and new.undo_name is None and new.redo_name is None:
            self.end() if not self._waits else self._show(0)
        elif self._at is not None and STEPS[self._at].done(new):
            self._go_on()

    def _go_on(self) -> None:
        if self._at is not None and self._at + 1 < len(STEPS):
            self._show(self._at + 1)

    def _show(self, at: int) -> None:
        self._at, self._waits = at, False
        self.text.setText(f"{at + 1} of {len(STEPS)}: {STEPS[at].text}")
        self.onward.setVisible(at + 1 < len(STEPS))
        self.show()
