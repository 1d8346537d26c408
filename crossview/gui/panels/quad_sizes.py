"""What the field says of the quads' edges before there are any."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFormLayout, QWidget

from crossview.gui.panels.links import LinkLabel, faint, link
from crossview.session.meshes import Meshes
from crossview.view.texts import grouped
from crossview.workflow.spots import Spot

EXTREME = 30.0
"""Largest edge over the least from which sizes are called extreme. Chosen: the largest quads then
cut off what the least ones follow."""

AROUND = 24.0
"""How much is seen around an extreme, in edges there. Chosen."""


class QuadSizes(QWidget):
    """The least possible number, the least and the largest edge, and where they are."""

    look_wanted = Signal(Spot, float)
    """A place to look at, and how much around it."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.fewest, self.edges = LinkLabel(), LinkLabel()
        self.fewest.setToolTip("About the least number of quads that this layout can have")
        self.edges.setToolTip(
            "Least and largest edge that the field asks for, and their ratio; click to look there"
        )
        self.edges.linkActivated.connect(self._look)
        form = QFormLayout(self)
        form.setContentsMargins(0, 0, 0, 0)
        form.setVerticalSpacing(3)
        form.setHorizontalSpacing(6)
        form.addRow(faint("Least"), self.fewest)
        form.addRow(faint("Edges"), self.edges)
        self._made, self._quads = Meshes(), 1.0

    def show_sizes(self, made: Meshes, quads: int | None) -> None:
        """Show what is known of so many quads; None: the wanted edges are impossible."""
        self.setVisible(made.expected is not None)
        if made.expected is None:
            return
        self._made, self._quads = made, float(quads or 1)
        self.fewest.setText("not known" if made.fewest is None else grouped(made.fewest) + " quads")
        ends = made.expected.edges(self._quads)
        least, largest = (link(f"{edge:.3g}", str(i)) for i, edge in enumerate(ends))
        ratio = f"1 : {made.expected.ratio:.3g}"
        if made.expected.ratio > EXTREME:
            ratio += ", extreme"
        said = "longer than the surface" if quads is None else f"{least} to {largest}<br>{ratio}"
        self.edges.setText(said)

    def _look(self, which: str) -> None:
        expected = self._made.expected
        if expected is not None:
            spot = (expected.at_least, expected.at_largest)[int(which)]
            self.look_wanted.emit(spot, AROUND * expected.edges(self._quads)[int(which)])
