"""What the mouse does in the viewport: place, drag, select, turn the wheel; else the camera."""

from __future__ import annotations

from enum import Enum, auto

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QToolTip

from crossview.gui.group import Group
from crossview.gui.picking import Pick
from crossview.gui.viewport import Viewport
from crossview.session.hand import SelectTool
from crossview.session.session import Session
from solvers.surface import SurfacePoint

CLICK_REACH = 4.0
"""Pixels that the mouse may move between press and release of a click."""
NOTCH = 120
"""One notch of a wheel, from Qt: eighths of a degree."""


class _Grip(Enum):
    """What a pressed left button holds."""

    NOTHING = auto()
    CAMERA = auto()
    SINGULARITY = auto()
    DRAG = auto()
    BAND = auto()


class Mouse(QObject):
    """Event filter on a viewport's plotter.

    A press on a singularity takes hold of it in any mode; it becomes a drag once the mouse has
    moved as far as a click may not. All that is not taken here goes on to VTK's camera.
    """

    hovered = Signal(object)
    """Pick under the mouse, or None."""
    menu_wanted = Signal(object, QPoint)
    """Singularity number or None, and where on the screen."""
    edit_wanted = Signal(int)
    """A singularity was clicked twice."""

    def __init__(self, viewport: Viewport, session: Session) -> None:
        super().__init__(viewport)
        self.under_mouse: Pick | None = None
        self.under_menu: Pick | None = None
        self._viewport = viewport
        self._session = session
        self.group = Group(viewport, session)
        self._grip = _Grip.NOTHING
        self._held = -1
        self._pressed_at = QPointF()
        self._moved = False
        self._wheel = 0
        self._onwards = False  # whether Shift is held
        viewport.plotter.installEventFilter(self)

    def close(self) -> None:
        """Hear no more."""
        self._viewport.plotter.removeEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take an event, or leave it to the camera."""
        kind = event.type()
        if kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
            if isinstance(event, QKeyEvent) and kind == QEvent.Type.KeyPress:
                plain = not event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
                if plain and self.group.move(Qt.Key(event.key())):
                    return True
            event.ignore()  # VTK has keys of its own (q closes); the window's shortcuts are all
            return True
        if kind == QEvent.Type.Leave:
            self._hover(None)
        if isinstance(event, QWheelEvent):
            return self._wheeled(event)
        if isinstance(event, QMouseEvent):
            self._onwards = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
            return self._mouse(kind, event)
        return False

    def _mouse(self, kind: QEvent.Type, event: QMouseEvent) -> bool:
        if kind == QEvent.Type.MouseMove:
            return self._move(event)
        if kind in (QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonDblClick):
            return self._press(event)
        if kind == QEvent.Type.MouseButtonRelease:
            return self._release(event)
        return False

    def _press(self, event: QMouseEvent) -> bool:
        self._pressed_at, self._moved = event.position(), False
        if event.button() == Qt.MouseButton.LeftButton:
            measures = self._session.state.measure_tool is not None
            index = None if measures else self._viewport.singularity_at(event.position())
            if index is not None and event.type() == QEvent.Type.MouseButtonDblClick:
                self.edit_wanted.emit(index)
            self._grip = _Grip.CAMERA if index is None else _Grip.SINGULARITY
            self._held = -1 if index is None else index
            if index is None and event.modifiers() & Qt.KeyboardModifier.ControlModifier:
                self._grip = _Grip.BAND
                self.group.start_band(event.position())
        return self._grip in (_Grip.SINGULARITY, _Grip.BAND)

    def _move(self, event: QMouseEvent) -> bool:
        away = (event.position() - self._pressed_at).manhattanLength() >= CLICK_REACH
        self._moved |= away and bool(event.buttons())
        if self._grip is _Grip.SINGULARITY and self._moved:
            started = self._session.trials.start_drag(self._held)
            self._grip = _Grip.DRAG if started else _Grip.NOTHING
            if not started:
                self._refuse(event.globalPosition().toPoint())
        if self._grip is _Grip.BAND:
            self.group.stretch_band(event.position())
            return True
        if self._grip is _Grip.DRAG:
            pick = self._viewport.pick(event.position())
            if pick is not None:
                keep = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
                self._session.trials.drag_to(pick.point, keep)
            return True
        if not event.buttons():
            self._hover(event.position())
        elif self._grip is _Grip.CAMERA or event.buttons() != Qt.MouseButton.LeftButton:
            self._viewport.pass_on(event)
        return True

    def _refuse(self, place: QPoint) -> None:
        """Say at the mouse why what is held does not follow."""
        self._viewport.plotter.setCursor(Qt.CursorShape.ForbiddenCursor)
        self._session.pointer.select(self._held)
        text = f"Singularity {self._held + 1} is locked: L unlocks it"
        QToolTip.showText(place, text, self._viewport.plotter)

    def _release(self, event: QMouseEvent) -> bool:
        grip, self._grip = self._grip, _Grip.NOTHING
        if event.button() == Qt.MouseButton.RightButton:
            self._viewport.pass_on(event)
            if not self._moved:
                self._ask_menu(event.position(), event.globalPosition().toPoint())
            return True
        if event.button() != Qt.MouseButton.LeftButton:
            return False
        if grip is _Grip.DRAG:
            by = event.position() - self._pressed_at
            together = self.group.companions(self._held)
            self._session.trials.drop(self.group.displaced(by, together))
        elif grip is _Grip.BAND:
            self.group.end_band(event.position())
        elif grip is _Grip.SINGULARITY:
            both = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
            self._session.pointer.select(self._held, both)
        elif not self._moved:
            self._viewport.pass_on(event)
            self._click(event.position())
        else:
            return False
        return True

    def _click(self, place: QPointF) -> None:
        pick, state = self._viewport.pick(place), self._session.state
        if state.mark_tool is not None:
            if pick is not None:
                self._session.feature_marks.click(pick.point, self._onwards)
        elif state.measure_tool is not None:
            over = self._viewport.singularity_at(place)
            if over is not None:
                self._session.measuring.click(state.singularities[over].point)
            elif pick is not None:
                self._session.measuring.click(state.lifted(pick.point))
        elif pick is not None and state.added_valence is not None:
            self._session.edits.add(pick.point, state.added_valence)
        elif (near := self._near_miss_at(place)) is not None:
            self._session.moves.connect(near)
        else:
            self._session.pointer.select(None)

    def _near_miss_at(self, place: QPointF) -> tuple[int, int] | None:
        """Return the singularities that a click at a place would join, with the select tool."""
        state = self._session.state
        if state.near_misses is None or not isinstance(state.tool, SelectTool):
            return None
        number = self._viewport.near_miss_at(place)
        if number is None:
            return None
        one, other = state.near_misses.pairs[number].tolist()
        return one, other

    def _ask_menu(self, place: QPointF, global_place: QPoint) -> None:
        """Ask for the menu of what is under a place."""
        self.under_menu = self._viewport.pick(place)
        self.menu_wanted.emit(self._viewport.singularity_at(place), global_place)

    def _wheeled(self, event: QWheelEvent) -> bool:
        index = self._viewport.singularity_at(event.position())
        if index is None or self._grip is _Grip.DRAG:
            return self._viewport.pass_on(event)
        self._wheel += event.angleDelta().y()
        steps = int(self._wheel / NOTCH)
        self._wheel -= steps * NOTCH
        for _ in range(abs(steps)):
            self._session.edits.step_valence(1 if steps > 0 else -1, index)
        if steps:
            self._session.pointer.choose(index)
        return True

    def _hover(self, place: QPointF | None) -> None:
        """Read out what is under the mouse and show what a click would do there."""
        pick = None if place is None else self._viewport.pick(place)
        self.under_mouse = pick
        if place is not None:  # else a menu may have opened
            self.under_menu = None
        self.hovered.emit(pick)
        over = None if place is None else self._viewport.singularity_at(place)
        near = None if place is None or over is not None else self._near_miss_at(place)
        self._viewport.point_out(over is not None or near is not None)
        self._viewport.plotter.setToolTip("" if near is None else _offer(*near))
        self._session.pointer.hover(over)
        if self._session.state.mark_tool is not None:
            self._session.feature_marks.hover(None if pick is None else pick.point, self._onwards)
        if self._session.state.added_valence is not None:
            point: SurfacePoint | None = None if pick is None or over is not None else pick.point
            self._session.trials.preview(point)

    def let_go(self) -> bool:
        """End a drag, if there is one, and put the singularity back."""
        if self._grip is not _Grip.DRAG:
            return False
        self._grip = _Grip.NOTHING
        self._session.trials.cancel()
        return True


def _offer(one: int, other: int) -> str:
    """Return what is said of a near miss under the mouse."""
    return f"Nearly joins singularities {one + 1} and {other + 1}: a click does"
