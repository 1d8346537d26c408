"""Figures written by processes of their own, so that the window goes on meanwhile."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QObject, QProcess

from crossview.export.apart import ARGUMENTS, outcome
from solvers.errors import CrossviewError

CLOSING_MS = 60_000
"""How long a window that closes waits for its last figures, milliseconds. Chosen."""

Ended = Callable[[CrossviewError | None], None]
"""Told why a figure could not be written; None: it is."""


class FigureWriter(QObject):
    """Writes any number of figures at once."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._running: list[QProcess] = []

    @property
    def busy(self) -> bool:
        """Whether a figure is still being written."""
        return bool(self._running)

    def write(self, figure: bytes, ended: Ended) -> None:
        """Write a figure, as of `apart.packed`, and tell when that has ended."""
        process = QProcess(self)
        self._running.append(process)
        process.finished.connect(partial(self._finished, process, ended))
        process.errorOccurred.connect(partial(self._failed, process, ended))
        process.start(sys.executable, ARGUMENTS)
        process.write(figure)
        process.closeWriteChannel()

    def close(self) -> None:
        """Let the last figures be written."""
        for process in tuple(self._running):
            process.waitForFinished(CLOSING_MS)

    def _failed(self, process: QProcess, ended: Ended, error: QProcess.ProcessError) -> None:
        if error == QProcess.ProcessError.FailedToStart:  # any other ends it, too
            self._finished(process, ended)

    def _finished(self, process: QProcess, ended: Ended, *_: object) -> None:
        self._running.remove(process)
        process.deleteLater()
        answer = bytes(process.readAllStandardOutput().data())
        said = bytes(process.readAllStandardError().data()).decode(errors="replace").strip()
        if answer:
            ended(outcome(answer))
        else:
            last = said.splitlines()[-1] if said else process.errorString()
            ended(CrossviewError("the figure could not be drawn", last, "try a smaller one"))
