"""The real window for tests: fixtures, and how a user's hand and eye are played.

A test that uses `window` fails when it leaves a thread, a running timer, a top-level widget or a
render window behind.
"""

import gc
import os
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, QSettings, Qt, QTimer
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from vtkmodules.vtkRenderingCore import vtkRenderWindow

from crossview.gui.app import application
from crossview.gui.main_window import MainWindow
from crossview.scene import ensure_rendering
from crossview.session.state import SessionState
from crossview.view.colors import rgb

PATIENCE = 60.0
NO_KEYS = Qt.KeyboardModifier.NoModifier
NEEDS_DISPLAY = sys.platform.startswith("linux") and not os.environ.get("DISPLAY")


class Hand:
    """Uses a window as a user does: through its widgets, with mouse and keys."""

    def __init__(self, window: MainWindow) -> None:
        self.window = window
        self.canvas = window.viewport.plotter

    @property
    def state(self) -> SessionState:
        return self.window.state

    def wait(self, wanted: Callable[[], bool] = lambda: True) -> None:
        """Let the window work until it is idle and `wanted` holds."""
        end = time.monotonic() + PATIENCE
        while True:
            QApplication.processEvents()
            if not self._busy and wanted():
                break
            assert time.monotonic() < end, f"still waiting; message: {self.state.message}"
            time.sleep(0.002)
        QApplication.processEvents()

    @property
    def _busy(self) -> bool:
        return self.window.session.busy or self.window.files.busy

    @property
    def said(self) -> str:
        """What the message says."""
        message = self.state.message
        assert message is not None
        return ": ".join(part for part in (message.text, message.below) if part)

    def open(self, target: str | Path) -> None:
        """Open something; changes that are not saved are given up without a question."""
        if self.state.document is not None:
            self.window.session.edits.keep()
        self.window.files.open(str(target))
        self.wait()

    def key(
        self, key: Qt.Key, modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier
    ) -> None:
        QTest.keyClick(self.canvas, key, modifiers)
        QApplication.processEvents()

    def trigger(self, name: str) -> None:
        self.window.actions_table.by_name[name].trigger()
        self.wait()

    def place(self, xyz: Iterable[float]) -> QPointF:
        """Where a point of space is in the viewport."""
        renderer = self.canvas.renderer
        renderer.SetWorldPoint(*map(float, xyz), 1.0)
        renderer.WorldToDisplay()
        x, y, _ = renderer.GetDisplayPoint()
        ratio = self.canvas.devicePixelRatioF()
        return QPointF(x / ratio, self.canvas.height() - 1.0 - y / ratio)

    def place_of(self, index: int) -> QPointF:
        """Where a singularity is in the viewport."""
        surface = self.state.document.surface
        return self.place(surface.position(self.state.singularities[index].point))

    def press(
        self,
        place: QPointF,
        button: Qt.MouseButton = Qt.MouseButton.LeftButton,
        keys: Qt.KeyboardModifier = NO_KEYS,
    ) -> None:
        self._send(QEvent.Type.MouseButtonPress, place, button, button, keys)

    def move(
        self,
        place: QPointF,
        held: Qt.MouseButton = Qt.MouseButton.NoButton,
        keys: Qt.KeyboardModifier = NO_KEYS,
    ) -> None:
        self._send(QEvent.Type.MouseMove, place, Qt.MouseButton.NoButton, held, keys)

    def release(
        self,
        place: QPointF,
        button: Qt.MouseButton = Qt.MouseButton.LeftButton,
        keys: Qt.KeyboardModifier = NO_KEYS,
    ) -> None:
        self._send(QEvent.Type.MouseButtonRelease, place, button, Qt.MouseButton.NoButton, keys)

    def click(
        self,
        place: QPointF,
        button: Qt.MouseButton = Qt.MouseButton.LeftButton,
        keys: Qt.KeyboardModifier = NO_KEYS,
    ) -> None:
        self.move(place)
        self.press(place, button, keys)
        self.release(place, button, keys)

    def drag(
        self, start: QPointF, end: QPointF, steps: int = 8, keys: Qt.KeyboardModifier = NO_KEYS
    ) -> None:
        """Press, move in steps and stay held; `release` lets go."""
        self.press(start, keys=keys)
        for step in range(1, steps + 1):
            self.move(start + (end - start) * (step / steps), Qt.MouseButton.LeftButton, keys)

    def wheel(self, place: QPointF, notches: int) -> None:
        event = QWheelEvent(
            place,
            QPointF(self.canvas.mapToGlobal(place.toPoint())),
            place.toPoint() * 0,
            place.toPoint() * 0 + _vertical(120 * notches),
            Qt.MouseButton.NoButton,
            Qt.KeyboardModifier.NoModifier,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(self.canvas, event)
        QApplication.processEvents()

    def picture(self) -> np.ndarray:
        """What the viewport shows, (height, width, 3) uint8, in the colours that are drawn.

        Whether it has rested for long enough to be smoothed does not matter.
        """
        QApplication.processEvents()
        self.window.viewport.scene.smooth(False)
        image = self.canvas.grabFramebuffer().convertToFormat(
            self.canvas.grabFramebuffer().Format.Format_RGB888
        )
        rows = np.frombuffer(image.constBits(), np.uint8).reshape(
            image.height(), image.bytesPerLine()
        )
        return rows[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).copy()

    def shows(
        self, color: str, place: QPointF | None = None, reach: int = 4, *, line: bool = False
    ) -> bool:
        """Whether the picture has the colour (name) anywhere, or as a patch at a place of it.

        A line of the colour that passes the place counts only where one is looked for.
        """
        reach = round(reach * self.canvas.devicePixelRatioF())
        found = count_color(self.picture(), color, self._pixel(place), reach)
        return found > (0 if place is None or line else 0.4 * (2 * reach + 1) ** 2)

    def _pixel(self, place: QPointF | None) -> tuple[int, int] | None:
        if place is None:
            return None
        ratio = self.canvas.devicePixelRatioF()
        return round(place.x() * ratio), round(place.y() * ratio)

    def _send(
        self,
        kind: QEvent.Type,
        place: QPointF,
        button: Qt.MouseButton,
        held: Qt.MouseButton,
        keys: Qt.KeyboardModifier = NO_KEYS,
    ) -> None:
        spot = QPointF(self.canvas.mapToGlobal(place.toPoint()))
        QApplication.sendEvent(self.canvas, QMouseEvent(kind, place, spot, button, held, keys))
        QApplication.processEvents()


def _vertical(angle: int) -> QPoint:
    return QPoint(0, angle)


def count_color(
    picture: np.ndarray, color: str, pixel: tuple[int, int] | None = None, reach: int = 4
) -> int:
    """How many pixels have a colour, of a patch around `pixel` (x, y) or of all."""
    if pixel is not None:
        x, y = pixel
        picture = picture[max(y - reach, 0) : y + reach + 1, max(x - reach, 0) : x + reach + 1]
    wanted = np.round(255 * np.array(rgb(color)))
    return int((np.abs(picture[..., :3].astype(int) - wanted).max(axis=-1) <= 6).sum())


@pytest.fixture(scope="session")
def app() -> QApplication:
    if NEEDS_DISPLAY:
        pytest.skip("no display: run under xvfb-run, as make test does")
    ensure_rendering()
    return application()


@pytest.fixture
def settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the user's settings and unsaved work out of the tests."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    QSettings.setDefaultFormat(QSettings.Format.IniFormat)
    QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, str(tmp_path / "ini"))


@pytest.fixture
def nothing_left(app: QApplication) -> Iterator[None]:
    """Fail when a test leaves something behind."""
    gc.collect()
    gc.freeze()  # what there is already need not be looked through
    before = {id(thing) for thing in living(app)}
    yield
    app.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    app.processEvents()
    gc.collect()
    app.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    left = [thing for thing in living(app) if id(thing) not in before]
    assert not left, f"left behind: {left}"


def living(app: QApplication) -> list[object]:
    """Threads, running timers, top-level widgets and render windows."""
    things: list[object] = [*threading.enumerate(), *app.topLevelWidgets()]
    for thing in gc.get_objects():
        if isinstance(thing, vtkRenderWindow) or (isinstance(thing, QTimer) and _runs(thing)):
            things.append(thing)
    return things


def _runs(timer: QTimer) -> bool:
    try:
        return timer.isActive()
    except RuntimeError:  # its C++ half is gone already
        return False


@pytest.fixture
def window(app: QApplication, settings: None, nothing_left: None) -> Iterator[MainWindow]:
    """A shown window, empty."""
    made = MainWindow()
    made.resize(1280, 800)
    made.show()
    made.activateWindow()
    assert QTest.qWaitForWindowActive(made)  # else no shortcut is heard
    yield made
    made.session.edits.keep()  # else it asks
    made.close()
    made.deleteLater()


@pytest.fixture
def hand(window: MainWindow) -> Hand:
    return Hand(window)
