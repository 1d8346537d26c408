"""The Quads panel: how fine they are to be, and what has come of it."""

from __future__ import annotations

import contextlib
from html import escape

from PySide6.QtCore import QLocale, Qt, Signal
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

from crossview.gui.icons import put_icon, verdict_icon
from crossview.gui.panels.histogram import Histogram
from crossview.gui.panels.links import LinkLabel, faint, link
from crossview.gui.panels.quad_facts import ROWS, quad_facts
from crossview.gui.panels.quad_sizes import QuadSizes
from crossview.gui.panels.scrolling import scrolled
from crossview.gui.panels.verdict_row import DOT
from crossview.session.state import SessionState
from crossview.view.colors import BAD, GOOD
from crossview.view.texts import MINUS
from crossview.workflow.quads import DEFAULT_QUADS, MeshOptions
from crossview.workflow.spots import GOOD as GOOD_QUAD
from crossview.workflow.spots import Spot
from solvers.errors import CrossviewError
from solvers.quads import MAX_CHORD, MAX_SIZE_RATIO, MOST_QUADS
from solvers.surface import TriSurface

COUNT, LENGTH = range(2)
"""Rows of the box that says what is asked for."""

QUALITY, LENGTHS = range(2)
"""Rows of the box that says what the histogram counts."""

AROUND = 8.0
"""How much is seen around a quad, in its longest side. Chosen."""

NOTHING = "No quads yet."
"""Said before there are quads."""

STALE = "The quads were of an earlier state and are gone; make them again."
"""Said where an edit took them away."""


class QuadsPanel(QScrollArea):
    """Edits `MeshOptions`, makes quads and says what they are like."""

    look_wanted = Signal(Spot, float)
    """A place of the surface to look at, and how much around it."""

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
        self.unit.setAccessibleName("What is given")
        self.count_box.setAccessibleName("Quads")
        self.length_box.setAccessibleName("Edge length")
        self.boxes = QStackedWidget()
        for box in (self.count_box, self.length_box):
            box.setLocale(QLocale.c())
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
        self.chord_box.setAccessibleName("Distance of edges from bends, percent")
        self.chord_box.setToolTip(
            "How far an edge may be from the boundary or feature it follows, in radii of its bend"
        )
        self.ratio_box = QDoubleSpinBox()
        self.ratio_box.setDecimals(1)
        self.ratio_box.setRange(1.1, 100.0)
        self.ratio_box.setSingleStep(0.5)
        self.ratio_box.setValue(MAX_SIZE_RATIO)
        self.ratio_box.setSuffix(" × mean")
        self.ratio_box.setLocale(QLocale.c())
        self.ratio_box.setAccessibleName("Size ratio: edges along an arc, in the mean edge")
        self.ratio_box.setToolTip(
            "How much longer than the mean edge of all those along an arc of the layout may be, "
            "as far as the number of quads allows"
        )
        self.button = QPushButton(make.text())
        put_icon(self.button, "mesh")
        self.button.setToolTip(make.toolTip())
        self.button.clicked.connect(make.trigger)
        self.button.setEnabled(make.isEnabled())
        make.enabledChanged.connect(self.button.setEnabled)
        self.allow_inverted = QCheckBox("Allow inverted")
        self.allow_inverted.setToolTip("Save the quads although some are inverted")
        self.save_button = QToolButton()
        self.save_button.setDefaultAction(save)
        self._dot, self.said = QLabel(), LinkLabel()
        self._dot.setObjectName("dot")
        self.said.linkActivated.connect(self._look_at_fault)
        self.facts: dict[str, QLabel] = {}
        self.worst = LinkLabel()
        self.worst.setToolTip("Scaled Jacobians of the worst quads; click to look there")
        self.worst.linkActivated.connect(self._look_at_quad)
        self.sizes = QuadSizes()
        self.sizes.look_wanted.connect(self.look_wanted)
        self.histogram, self.measure = Histogram(), QComboBox()
        self.measure.addItems(["Scaled Jacobian", "Edge lengths"])
        self.measure.setToolTip("What the histogram counts")
        self.measure.currentIndexChanged.connect(self._count)
        self._shown = SessionState()
        for changed in (self.count_box.valueChanged, self.length_box.valueChanged):
            changed.connect(self._expect)
        self.unit.currentIndexChanged.connect(self._expect)
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
            max_size_ratio=self.ratio_box.value(),
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
        made, self._shown = state.made, state
        quads = made.quads if state.solution is not None else None
        for part in (self._form, self.measure, self.histogram, self._dot, self.save_button):
            part.setVisible(quads is not None)
        self._expect()
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
        place = "" if certificate.right else certificate.faults[0].where
        self.said.setText(_with_link(facts.verdict, place))
        for title, text in facts.rows.items():
            self.facts[title].setText(text)
        worst = [link(f"{quad.quality:.2f}", str(i)) for i, quad in enumerate(made.worst)]
        self.worst.setText(", ".join(worst).replace("-", MINUS) or f"none below {GOOD_QUAD}")
        self._count()

    def _count(self) -> None:
        """Fill the histogram."""
        quads = self._shown.made.quads
        if quads is None:
            return
        if self.measure.currentIndex() == QUALITY:
            self.histogram.show_quality(quads.scaled_jacobian)
        else:
            self.histogram.show_lengths(quads.edge_lengths)

    def _expect(self) -> None:
        """Say what to expect of the options, until there are quads."""
        state = self._shown
        if state.document is None or state.solution is None or state.made.quads is not None:
            self.sizes.hide()
            return
        number = None
        with contextlib.suppress(CrossviewError):  # making the quads tells it
            number = self.options.number_on(state.document.surface)
        self.sizes.show_sizes(state.made, number)

    def _look_at_quad(self, number: str) -> None:
        quad = self._shown.made.worst[int(number)]
        self.look_wanted.emit(quad.spot, AROUND * quad.edge)

    def _look_at_fault(self) -> None:
        made = self._shown.made
        if made.gravest is not None and made.certificate is not None:
            edge = made.certificate.measures["mean_edge"]
            self.look_wanted.emit(made.gravest, AROUND * edge)

    def _lay_out(self) -> None:
        layout = scrolled(self)
        wanted = QHBoxLayout()
        wanted.setSpacing(6)
        wanted.addWidget(self.unit)
        wanted.addWidget(self.boxes, 1)
        layout.addLayout(wanted)
        for name, box in (("Off bends", self.chord_box), ("Size ratio", self.ratio_box)):
            box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
            bound = QHBoxLayout()
            bound.setSpacing(6)
            bound.addWidget(QLabel(name))
            bound.addWidget(box, 1)
            layout.addLayout(bound)
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
            form.addRow(faint(title), self.facts[title])
        form.addRow(faint("Worst"), self.worst)
        layout.addWidget(self.sizes)
        layout.addWidget(self.measure)
        layout.addWidget(self.histogram)
        layout.addWidget(self._form)
        layout.addWidget(self.allow_inverted)
        layout.addWidget(self.save_button)
        layout.addStretch(1)


def _with_link(text: str, place: str) -> str:
    """A text in which a place, if there is one, is a link."""
    before, found, after = text.partition(place) if place else (text, "", "")
    return escape(before) + (link(found, "place") if found else "") + escape(after)
