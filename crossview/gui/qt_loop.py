"""The window's events as the loop that a session lives on."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, Qt, QTimer, Signal


class QtLoop(QObject):
    """Does what is asked for from any thread on the one that owns it, as `session.loop.Loop`."""

    _asked = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._asked.connect(self._run, Qt.ConnectionType.QueuedConnection)

    def call(self, job: Callable[[], None]) -> None:
        """Do something soon, in the order of the calls, which may come from any thread."""
        self._asked.emit(job)

    def timer(self, seconds: float, job: Callable[[], None]) -> QTimer:
        """Return a timer, not started."""
        timer = QTimer(self)
        timer.setSingleShot(True)
        timer.setInterval(round(1000.0 * seconds))
        timer.timeout.connect(job)
        return timer

    def _run(self, job: Callable[[], None]) -> None:
        job()
