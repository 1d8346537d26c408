"""The Convergence panel: E by iteration, the verdict, and what the field is like."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QHBoxLayout, QLabel, QScrollArea, QToolButton, QWidget

from crossview.gui.icons import verdict_icon
from crossview.gui.panels.energy_plot import EnergyPlot
from crossview.gui.panels.scrolling import scrolled
from crossview.gui.panels.verdict_row import DOT
from crossview.session.state import SessionState
from crossview.view.colors import BAD, GOOD, UNSURE, WAITING
from crossview.view.texts import aspect, energies
from crossview.workflow.pipeline import Solution
from solvers.fields import Convergence

COLORS = {"valid": GOOD, "stretched": UNSURE, "not found": UNSURE, "impossible": BAD}
"""Of verdicts."""

NONE = Convergence()
"""Of fields without iterations."""

STOPPED = "Not converged: this is the last iterate before it was stopped."
"""Said of a field whose iteration was stopped."""

NO_ITERATIONS = {
    "isotropic": "Isotropic: solved at once, no iterations",
    "aligned": "Theta imposed: solved at once, no iterations",
}
"""Said of methods that have none."""


class ConvergencePanel(QScrollArea):
    """Follows a solve as it runs and says how it ended."""

    def __init__(self, compare: QAction, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.plot = EnergyPlot()
        self._dot = QLabel()
        self.verdict, self.facts = QLabel(), QLabel()
        for label in (self.verdict, self.facts):
            label.setWordWrap(True)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.facts.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        self.button = QToolButton()
        self.button.setDefaultAction(compare)
        self.color = ""
        said = QHBoxLayout()
        said.setSpacing(8)
        said.addWidget(self._dot, 0, Qt.AlignmentFlag.AlignTop)
        said.addWidget(self.verdict, 1)
        layout = scrolled(self)
        layout.setContentsMargins(10, 4, 10, 8)
        layout.setSpacing(6)
        layout.addLayout(said)
        layout.addWidget(self.facts)
        layout.addWidget(self.plot, 1)
        layout.addWidget(self.button)
        self._say(WAITING, "Nothing is solved yet.", "")

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        seen = ("document", "solution", "iterating", "trial", "field")
        if all(getattr(old, name) is getattr(new, name) for name in seen):
            return
        solution = new.solution
        if new.iterating is not None:
            so_far = new.iterating.step.so_far.convergence
            self.plot.show_convergence(so_far)
            self._say(WAITING, "Solving…", energies(so_far.energies))
        elif solution is None:
            self.plot.show_convergence(NONE)
            self.plot.empty_text = "No iterations yet"
            self._say(WAITING, "Nothing is solved yet.", "")
        elif new.trial is not None and new.trial.drag:
            self._say(WAITING, "Follows the mouse; solved when it is let go.", "")
        elif new.solved and new.field is solution.field:
            self._show_solution(solution)
        else:
            self._say(WAITING, "Changed: not solved yet.", "")

    def _show_solution(self, solution: Solution) -> None:
        field, verdict = solution.field, solution.verdict
        iterated = solution.problem.method not in NO_ITERATIONS
        so_far = field.convergence.energies if iterated else (field.energy,)
        self.plot.empty_text = NO_ITERATIONS.get(solution.problem.method, "No iterations")
        self.plot.show_convergence(field.convergence if iterated else NONE)
        said = str(verdict) if field.convergence.converged else f"{STOPPED} {verdict}"
        quads = verdict.status in ("valid", "stretched")
        facts = [aspect(field.max_log_aspect)] if quads else []
        if solution.integrated is not None:
            facts.insert(0, energies(so_far))
        self._say(COLORS[verdict.status], said, "\n".join(facts))

    def _say(self, color: str, verdict: str, facts: str) -> None:
        self._show_dot(color)
        self.verdict.setText(verdict)
        self.facts.setText(facts)
        self.facts.setVisible(bool(facts))

    def _show_dot(self, color: str) -> None:
        if color != self.color:
            self.color = color
            self._dot.setPixmap(verdict_icon(color).pixmap(DOT))
