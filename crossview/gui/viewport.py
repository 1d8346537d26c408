"""The 3D view: a held plotter, the scene, picking. Only this file knows the plotter's ways.

1. The QtInteractor is held, never subclassed, never told to render: `plotter.render()` draws at
   once and then once more when Qt paints. `update()` draws once, and many calls make one frame.
2. For the same reason VTK's own render on each camera move is off while it handles events.
3. Widget pixels are not device pixels: `_place` is the one conversion.
4. Its keys (q closes), its drops and its timer are switched off.
5. It tells VTK of a fine screen's dots per inch, by which VTK enlarges texts. The scene has done
   so already (pixel_ratio): `BASE_DPI` is put back before each frame.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QObject, QPointF, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import (
    QColor,
    QFocusEvent,
    QFont,
    QFontMetrics,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QVBoxLayout, QWidget
from pyvistaqt import QtInteractor

from crossview.gui.picking import Pick, Picker, Place
from crossview.scene import Camera, Scene, software_renderer
from crossview.scene.singularities import marker_radius
from crossview.session.hand import Focus, SelectTool
from crossview.session.held_ranges import HeldRanges
from crossview.session.pictures import scene_view
from crossview.session.session import Session
from crossview.session.state import SessionState
from crossview.view.colors import THEMES
from crossview.view.meshes import near_misses_of
from crossview.view.scalars import shown_scalar
from crossview.workflow.spots import Spot
from solvers.surface import SurfacePoint

LATE_MS = 120
"""How long a dragged singularity waits to be drawn together with its field."""
REST_MS = 300
"""How long nothing may move before a smooth picture is drawn on a software renderer."""
FRAME = 2
"""Width of the frame that shows the focus, in pixels. Chosen."""
TITLE_PIXELS, BESIDE_TITLE = 17, 130
"""Height of the title's letters; pixels beside it that the axes need."""
BASE_DPI = 72
"""At which VTK draws a point of text as a pixel."""

UNSEEN = {"focus", "message", "progress", "redo_name", "shown", "undo_name"}
"""Fields of the state of which the scene shows parts or nothing."""
REACH = 7.0
"""Pixels around a singularity that count as on it."""


class Viewport(QWidget):
    """Shows the state as a scene, and tells what is under a place of it."""

    frame_drawn = Signal(float)
    """Milliseconds that a frame took."""
    limits_drawn = Signal(str, object)
    """Name of the scalar that is drawn, and the limits of its colours."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._software = software_renderer()
        samples = 1 if self._software else 4
        self.plotter = QtInteractor(self, auto_update=False, multi_samples=samples)
        self.plotter.setAcceptDrops(False)
        self.plotter.setAccessibleName("Scene")
        self.plotter.installEventFilter(self)
        self._by_key = False  # whether the focus has come by one
        layout = QVBoxLayout(self)
        layout.setContentsMargins(FRAME, FRAME, FRAME, FRAME)
        layout.addWidget(self.plotter)
        self.scene = Scene(self.plotter, self.devicePixelRatioF())
        self.picker = Picker(self.plotter.renderer)
        self.held = HeldRanges()
        self._started = 0.0
        self._fitted: str | None = "auto"  # the preset view, until the user turns it
        self._late = self._timer(LATE_MS, self._draw)
        self._rest = self._timer(REST_MS, self._smooth)
        self._resting = False
        window = self.plotter.render_window
        self._observers = [
            window.AddObserver("StartEvent", self._frame_started),
            window.AddObserver("EndEvent", self._frame_ended),
        ]

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        dragging = new.trial is not None and new.trial.drag
        if _same_picture(old, new):
            return
        self.picker.aim(new.shown_surface, new.clip)
        # One frame for the dot and its field, unless the field takes too long: frames cost more.
        if dragging and new.field is not None and new.field is old.field:
            self._rest.stop()
            if not self._late.isActive():
                self._late.start()
            return
        self._late.stop()
        self._draw()

    def _draw(self) -> None:
        state = self._session.state
        self.held.follow(state)
        view = scene_view(state, self.held.ranges)
        if self.scene.show(replace(view, title=self._broken(view.title))):
            self._update()
        shown = shown_scalar(view)
        self.held.hold(state, shown, self.scene.limits)
        if shown:
            self.limits_drawn.emit(shown, self.scene.limits)

    def _update(self) -> None:
        """Ask for one frame, fast; a smooth one follows when nothing moves any more."""
        if self._software:
            self._resting = False
            self.scene.smooth(False)
            self._rest.start()
        self.plotter.update()

    def _smooth(self) -> None:
        self._resting = True
        self.scene.smooth(True)
        self.plotter.update()

    def _timer(self, milliseconds: int, run: Callable[[], None]) -> QTimer:
        timer = QTimer(self)
        timer.setSingleShot(True)
        timer.setInterval(milliseconds)
        timer.timeout.connect(run)
        return timer

    def _broken(self, title: str) -> str:
        """Return a title on two lines where one is too short, and cut where two are."""
        font = QFont()
        font.setPixelSize(TITLE_PIXELS)
        metrics, room = QFontMetrics(font), self.plotter.width() - BESIDE_TITLE
        words, first = title.split(" "), 1
        while first < len(words) and metrics.horizontalAdvance(" ".join(words[: first + 1])) < room:
            first += 1
        lines = " ".join(words[:first]), " ".join(words[first:])
        right = Qt.TextElideMode.ElideRight
        return "\n".join(metrics.elidedText(line, right, room) for line in lines if line)

    def look_from(self, camera: str) -> None:
        """Look from one of the scene's preset directions, filling the room there is.

        "auto" is a good side of the surface.
        """
        self._fitted = camera
        self.scene.fit(camera, all_texts=True)
        self._update()

    def look_with(self, camera: Camera) -> None:
        """Look with a camera as it is."""
        self._fitted = None
        self.scene.fit(camera)
        self._update()

    def look_at(self, spot: Spot, height: float) -> None:
        """Look at a place of the surface from above it, at so much from top to bottom."""
        place, normal = np.array(spot.place), np.array(spot.normal)
        self.look_with(self.scene.camera.facing(place, normal, height))

    def change_projection(self) -> None:
        """Show in perspective what is shown in parallel, or the other way round."""
        self.look_with(self.scene.camera.other_projection)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Show or take away the frame of the focus."""
        if isinstance(event, QFocusEvent):
            by_key = (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason)
            self._by_key = event.gotFocus() and event.reason() in by_key
            self.update()
        return super().eventFilter(watched, event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the frame about the scene: the focus, or nothing."""
        with QPainter(self) as painter:
            background = THEMES["dark" if self._session.state.dark else "white"].background
            color = self.palette().highlight().color() if self._by_key else QColor(background)
            painter.fillRect(self.rect(), color)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fill the new room, unless the user has chosen a view."""
        super().resizeEvent(event)
        if self._fitted is not None:
            self.look_from(self._fitted)
        self._draw()

    def pick(self, place: QPointF) -> Pick | None:
        """Return the point of the surface under a place of the widget."""
        return self.picker.pick(self._place(place))

    def singularity_at(self, place: QPointF) -> int | None:
        """Return the number of the singularity under a place of the widget."""
        positions, radius = self._discs()
        reach = REACH * self.devicePixelRatioF()
        return self.picker.nearest(self._place(place), positions, radius, reach)

    def near_miss_at(self, place: QPointF) -> int | None:
        """Return the number of the near miss that is drawn under a place of the widget."""
        found = self._session.state.near_misses
        if found is None:
            return None
        reach = REACH * self.devicePixelRatioF()
        return self.picker.curve(self._place(place), near_misses_of(found), reach)

    def singularities_in(self, area: QRectF) -> tuple[int, ...]:
        """Return the numbers of the singularities seen in an area of the widget."""
        low, high = self._place(area.bottomLeft()), self._place(area.topRight())
        return self.picker.within(low, high, *self._discs())

    def point_beside(self, index: int, by: QPointF) -> SurfacePoint | None:
        """Return the point of the shown surface that is seen beside a singularity, if any is."""
        document = self._session.state.document
        if document is None:
            return None
        ratio = self.devicePixelRatioF()
        position = document.surface.position(self._session.state.singularities[index].point)
        pick = self.picker.beside(position, (by.x() * ratio, -by.y() * ratio))
        return None if pick is None else pick.point

    def _discs(self) -> tuple[NDArray[np.float64], float]:
        """Return where the singularities are, (k, 3), those that are drawn, and their radius."""
        state = self._session.state
        document = state.document
        if document is None or not state.singularities or not state.layers["singularities"].visible:
            return np.empty((0, 3)), 0.0
        positions = np.asarray(document.surface.positions([s.point for s in state.singularities]))
        markers = scene_view(state).singularities
        size = state.layers["singularities"].size
        return positions, marker_radius(markers, document.surface.diagonal, size)

    def point_out(self, something: bool) -> None:
        """Show by the cursor whether something can be taken hold of or clicked."""
        hand = Qt.CursorShape.PointingHandCursor
        idle = isinstance(self._session.state.tool, SelectTool)
        plain = Qt.CursorShape.ArrowCursor if idle else Qt.CursorShape.CrossCursor
        self.plotter.setCursor(hand if something else plain)

    def pass_on(self, event: QEvent) -> bool:
        """Hand an event to VTK's camera without its extra frame; say that it is dealt with."""
        if isinstance(event, QWheelEvent) or event.type() == QEvent.Type.MouseMove:
            self._fitted = None
        interactor = self.plotter.iren.interactor
        interactor.EnableRenderOff()
        try:
            if isinstance(event, QWheelEvent):
                self.plotter.wheelEvent(event)
            elif isinstance(event, QMouseEvent):
                handlers = {
                    QEvent.Type.MouseMove: self.plotter.mouseMoveEvent,
                    QEvent.Type.MouseButtonRelease: self.plotter.mouseReleaseEvent,
                }
                handlers[event.type()](event)
        finally:
            interactor.EnableRenderOn()
        self._update()
        return True

    def close_plotter(self) -> None:
        """Free what VTK holds; the widget draws no more."""
        self._late.stop()
        self._rest.stop()
        for tag in self._observers:
            self.plotter.render_window.RemoveObserver(tag)
        self.scene.remove()
        self.plotter.close()

    def _place(self, place: QPointF) -> Place:
        ratio = self.plotter.devicePixelRatioF()
        return place.x() * ratio, (self.plotter.height() - 1.0 - place.y()) * ratio

    def _frame_started(self, *_: object) -> None:
        self.plotter.render_window.SetDPI(BASE_DPI)
        self._started = time.perf_counter()

    def _frame_ended(self, *_: object) -> None:
        if not self._resting:
            self.frame_drawn.emit(1000.0 * (time.perf_counter() - self._started))


def _same_picture(old: SessionState, new: SessionState) -> bool:
    """Whether only what the scene does not show differs."""
    names = [f.name for f in fields(new) if f.name not in UNSEEN]
    names += ["drawn", "moving", "start", "faulty", "pointed"]
    return _marked(old.focus) == _marked(new.focus) and all(
        getattr(old, name) is getattr(new, name) for name in names
    )


def _marked(focus: Focus) -> Focus:
    """Return what the scene shows of a focus."""
    return replace(focus, hovered=None, pinned=None)
