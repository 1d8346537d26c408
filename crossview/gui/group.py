"""Several singularities at once: a band selects them, arrow keys and drags move them together."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRect, QRectF, Qt
from PySide6.QtWidgets import QRubberBand

from crossview.gui.viewport import Viewport
from crossview.session.session import Session
from solvers.surface import SurfacePoint

STEP = 8.0
"""How far an arrow key moves what is selected, in pixels of the window. Chosen."""

ARROWS = {
    Qt.Key.Key_Left: QPointF(-STEP, 0.0),
    Qt.Key.Key_Right: QPointF(STEP, 0.0),
    Qt.Key.Key_Up: QPointF(0.0, -STEP),
    Qt.Key.Key_Down: QPointF(0.0, STEP),
}
"""Which way each moves it in the picture."""


class Group:
    """The selected singularities in a viewport.

    Parameters
    ----------
    viewport : Viewport
    session : Session
    """

    def __init__(self, viewport: Viewport, session: Session) -> None:
        self._viewport = viewport
        self._session = session
        self._corner = QPointF()
        self.band = QRubberBand(QRubberBand.Shape.Rectangle, viewport)

    def start_band(self, place: QPointF) -> None:
        """Begin a band at a place of the scene."""
        self._corner = place

    def stretch_band(self, place: QPointF) -> None:
        """Let it reach to another place."""
        area = QRect(self._corner.toPoint(), place.toPoint()).normalized()
        self.band.setGeometry(area.translated(self._viewport.plotter.pos()))
        self.band.show()

    def end_band(self, place: QPointF) -> None:
        """Select what is seen in it, too."""
        self.band.hide()
        area = QRectF(self._corner, place).normalized()
        self._session.pointer.select_also(self._viewport.singularities_in(area))

    def move(self, key: Qt.Key) -> bool:
        """Move what is selected as an arrow key says; False if there is nothing to move."""
        selected = self._session.state.focus.all
        if key not in ARROWS or not selected:
            return False
        self._session.edits.move(self.displaced(ARROWS[key], selected))
        return True

    def displaced(self, by: QPointF, indices: tuple[int, ...]) -> dict[int, SurfacePoint]:
        """Return where on the shown surface singularities come to by a move in the picture."""
        moved = {i: self._viewport.point_beside(i, by) for i in indices}
        return {i: point for i, point in moved.items() if point is not None}

    def companions(self, held: int) -> tuple[int, ...]:
        """Return which move with the one that is dragged."""
        selected = self._session.state.focus.all
        return tuple(i for i in selected if i != held) if held in selected else ()
