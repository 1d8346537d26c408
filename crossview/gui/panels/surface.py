"""The Surface panel: what is open, its counts, topology, quality and notes."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QEnterEvent
from PySide6.QtWidgets import QFormLayout, QLabel, QScrollArea, QWidget

from crossview.gui.panels.features import FeaturesBox
from crossview.gui.panels.scrolling import scrolled
from crossview.session.document import Document
from crossview.session.pictures import poor_faces
from crossview.session.session import Session
from crossview.session.state import SessionState
from crossview.view.texts import count
from solvers.surface import TriSurface


class Hovered(QLabel):
    """A label that tells when the mouse is over it."""

    hovered = Signal(bool)

    def enterEvent(self, event: QEnterEvent) -> None:
        """Tell that the mouse is here."""
        self.hovered.emit(True)
        super().enterEvent(event)

    def leaveEvent(self, event: QEvent) -> None:
        """Tell that the mouse has gone."""
        self.hovered.emit(False)
        super().leaveEvent(event)


class SurfacePanel(QScrollArea):
    """Shows the facts of the document's surface; scrolls where there are many notes."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.name = QLabel("Nothing open")
        self.name.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        font = self.name.font()
        font.setBold(True)
        self.name.setFont(font)
        self.counts, self.topology, self.quality = QLabel(), QLabel(), QLabel()
        self.problems = Hovered()
        self.problems.hovered.connect(session.looks.show_poor)
        self.features = FeaturesBox(session)
        self.notes = QLabel()
        self.notes.setWordWrap(True)
        form = QFormLayout()
        form.setContentsMargins(0, 0, 0, 0)
        form.setVerticalSpacing(4)
        form.setHorizontalSpacing(8)
        rows = (
            ("Size", self.counts),
            ("Topology", self.topology),
            ("Quality", self.quality),
            ("Problems", self.problems),
        )
        for title, label in rows:
            form.addRow(_faint(title), label)
        layout = scrolled(self)
        layout.addWidget(self.name)
        layout.addLayout(form)
        layout.addWidget(self.features)
        layout.addWidget(self.notes)
        layout.addStretch()
        self._form = form
        self._show(None)

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        if old.document is not new.document:
            self._show(new.document)
        self.features.show_state(old, new)

    def _show(self, document: Document | None) -> None:
        for row in range(self._form.rowCount()):
            self._form.setRowVisible(row, document is not None)
        self.features.setVisible(document is not None)
        self.notes.setVisible(document is not None and bool(document.problem.notes))
        if document is None:
            self.name.setText("Nothing open")
            return
        surface = document.surface
        self.name.setText(document.name)
        self.counts.setText(
            f"{count(surface.n_vertices, 'vertex', 'vertices')}, "
            f"{count(surface.n_faces, 'triangle')}"
        )
        self.topology.setText(_topology(surface))
        worst, mean = float(surface.triangle_quality.min()), float(surface.triangle_quality.mean())
        poor = len(poor_faces(surface))
        self.quality.setText(f"mean {mean:.2f}, worst {worst:.2g}")
        self.problems.setText(count(poor, "poor triangle") if poor else "none")
        self.quality.setToolTip("1 is an equilateral triangle, 0 a degenerate one")
        self.notes.setText("\n".join(f"\u2022 {note}" for note in document.problem.notes))


def _topology(surface: TriSurface) -> str:
    loops = len(surface.boundary_loops)
    edge = "closed" if loops == 0 else count(loops, "boundary", "boundaries")
    return f"genus {surface.genus}, {edge}"


def _faint(text: str) -> QLabel:
    label = QLabel(text)
    label.setForegroundRole(label.palette().ColorRole.PlaceholderText)
    return label
