"""The Quads panel: how fine they are to be, and what has come of it."""

from __future__ import annotations

from PySide6.QtCore import QLocale, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QSpinBox,
    QStackedWidget,
    QToolButton,
    QWidget,
)

from crossview.gui.icons import verdict_icon
from crossview.gui.panels.histogram import Histogram
from crossview.gui.panels.quad_facts import ROWS, quad_facts
from crossview.gui.panels.scrolling import scrolled
from crossview.gui.panels.validity import DOT
from crossview.session.state import SessionState
from crossview.view.colors import BAD, GOOD
from crossview.workflow.quads import DEFAULT_QUADS, MeshOptions
from solvers.quads import MAX_CHORD, MOST_QUADS
from solvers.surface import TriSurface

COUNT, LENGTH = range(2)
"""Rows of the box that says what is asked for."""

NOTHING = "No quads yet."
"""Said before there are quads."""

STALE = "The quads were of an earlier state and are gone; make them again."
"""Said where an edit took them away."""


class QuadsPanel(QScrollArea):
    """Edits `MeshOptions`, makes quads and says what they are like."""

    def __init__(self, make: QAction, save: QAction, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.unit = QComboBox()
        self.unit.addItems(["Quads", "Edge length"])
        self.unit.setToolTip("What is given: about how many quads, or how long their edges are")
        self.count_box = QSpinBox()
        self.count_box.setRange(1, MOST_QUADS)
        self.count_box.setSingleStep(500)
        self.count_box.setValue(DEFAULT_QUADS)
        self.length_box = QDoubleSpinBox()
        self.length_box.setDecimals(4)
        self.length_box.setRange(1e-4, 1e6)
        self.length_box.setToolTip("Mean length of the quads' edges, in units of the surface")
        self.boxes = QStackedWidget()
        for box in (self.count_box, self.length_box):
            box.setLocale(QLocale.c())
            box.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
            # as wide as there is room: what the widest number needs is more than a dock has
            box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
            self.boxes.addWidget(box)
        self.boxes.setMaximumHeight(self.count_box.sizeHint().height())
        self.unit.currentIndexChanged.connect(self.boxes.setCurrentIndex)
        self.smooth = QCheckBox("Smooth")
        self.smooth.setToolTip("Let the vertices slide on the surface to better quads")
        self.smooth.setChecked(True)
        self.chord_box = QDoubleSpinBox()
        self.chord_box.setDecimals(2)
        self.chord_box.setRange(0.01, 100.0)
        self.chord_box.setValue(100.0 * MAX_CHORD)
        self.chord_box.setSuffix(" %")
        self.chord_box.setLocale(QLocale.c())
        self.chord_box.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.chord_box.setToolTip(
            "How far an edge may be from the boundary or feature it follows, in radii of its bend"
        )
        self.button = QPushButton(make.icon(), make.text())
        self.button.setToolTip(make.toolTip())
        self.button.clicked.connect(make.trigger)
        self.button.setEnabled(make.isEnabled())
        make.enabledChanged.connect(self.button.setEnabled)
        self.allow_inverted = QCheckBox("Allow inverted")
        self.allow_inverted.setToolTip("Save the quads although some are inverted")
        self.save_button = QToolButton()
        self.save_button.setDefaultAction(save)
        self._dot, self.said = QLabel(), QLabel(NOTHING)
        self._dot.setObjectName("dot")
        self.said.setWordWrap(True)
        self.said.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.facts: dict[str, QLabel] = {}
        self.histogram = Histogram()
        self._filled: TriSurface | None = None
        self._lay_out()
        self._show(SessionState())

    @property
    def options(self) -> MeshOptions:
        """What the boxes say."""
        by_count = self.unit.currentIndex() == COUNT
        return MeshOptions(
            edge_length=None if by_count else self.length_box.value(),
            target_quads=self.count_box.value() if by_count else None,
            smooth=self.smooth.isChecked(),
            max_chord=self.chord_box.value() / 100.0,
        )

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        before = None if old.document is None else old.document.surface
        if new.document is not None and new.document.surface is not before:
            self._suggest(new.document.surface)
        if old.made is not new.made or old.solution is not new.solution:
            self._show(new)

    def _suggest(self, surface: TriSurface) -> None:
        """Set the edge length to that of as many quads as are wanted on a new surface."""
        length = (surface.area / self.count_box.value()) ** 0.5
        self.length_box.setSingleStep(float(f"{length / 10.0:.1g}"))
        self.length_box.setValue(length)

    def _show(self, state: SessionState) -> None:
        made = state.made
        quads = made.quads if state.solution is not None else None
        self._form.setVisible(quads is not None)
        self.histogram.setVisible(quads is not None)
        self._dot.setVisible(quads is not None)
        self.save_button.setVisible(quads is not None)
        certificate = made.certificate
        spoiled = quads is not None and certificate is not None and certificate.inverted > 0
        self.allow_inverted.setVisible(spoiled)
        if quads is None or made.layout is None or state.solution is None or certificate is None:
            surface = None if state.document is None else state.document.surface
            gone = surface is not None and surface is self._filled
            self.said.setText(STALE if gone else NOTHING)
            return
        self._filled = state.solution.problem.surface
        facts = quad_facts(made.layout, quads, state.solution, certificate)
        self._dot.setPixmap(verdict_icon(GOOD if facts.good else BAD).pixmap(DOT))
        self.said.setText(facts.verdict)
        for title, text in facts.rows.items():
            self.facts[title].setText(text)
        self.histogram.show_values(quads.scaled_jacobian)

    def _lay_out(self) -> None:
        layout = scrolled(self)
        wanted = QHBoxLayout()
        wanted.setSpacing(6)
        wanted.addWidget(self.unit)
        wanted.addWidget(self.boxes, 1)
        layout.addLayout(wanted)
        bends = QHBoxLayout()
        bends.setSpacing(6)
        bends.addWidget(QLabel("Off bends"))
        bends.addWidget(self.chord_box, 1)
        layout.addLayout(bends)
        layout.addWidget(self.smooth)
        layout.addWidget(self.button)
        said = QHBoxLayout()
        said.setSpacing(8)
        said.addWidget(self._dot, 0, Qt.AlignmentFlag.AlignTop)
        said.addWidget(self.said, 1)
        layout.addLayout(said)
        self._form = QWidget()
        form = QFormLayout(self._form)
        form.setContentsMargins(0, 0, 0, 0)
        form.setVerticalSpacing(3)
        form.setHorizontalSpacing(6)
        for title in ROWS:
            self.facts[title] = QLabel()
            self.facts[title].setWordWrap(True)
            self.facts[title].setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            form.addRow(_faint(title), self.facts[title])
        layout.addWidget(self._form)
        layout.addWidget(self.histogram)
        layout.addWidget(self.allow_inverted)
        layout.addWidget(self.save_button)
        layout.addStretch(1)


def _faint(text: str) -> QLabel:
    label = QLabel(text)
    label.setForegroundRole(label.palette().ColorRole.PlaceholderText)
    return label
