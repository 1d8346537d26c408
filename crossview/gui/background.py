"""The background jobs of `session.jobs`, reported as Qt signals on the GUI thread."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject, Qt, Signal

from crossview.session.jobs import Failed, Finished, Job, JobEvent, LatestJobs, Progressed
from solvers.progress import Progress

Done = Callable[[Any], None]
Fail = Callable[[Exception], None]


class Background(QObject):
    """Runs the latest job and calls back on the thread that owns it.

    Answers older than the last `forget` are dropped; those of a stream come in order.
    """

    progressed = Signal(object)
    """Progress, or None when nothing is left to do."""
    stopped = Signal()
    """A job was stopped by the user, not by a newer one."""
    _event = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._jobs = LatestJobs(self._event.emit)
        self._callbacks: dict[int, tuple[Done, Fail]] = {}
        self._oldest = 0
        self._event.connect(self._receive, Qt.ConnectionType.QueuedConnection)

    @property
    def busy(self) -> bool:
        """Whether an answer is still awaited."""
        return bool(self._callbacks)

    def submit(self, job: Job, done: Done, fail: Fail) -> None:
        """Run `job` after superseding what waits; then call `done(result)` or `fail(error)`."""
        ticket = self._jobs.submit(job)
        self._callbacks[ticket] = (done, fail)

    def forget(self) -> None:
        """Stop what runs and drop every answer that has not arrived."""
        self._jobs.cancel()
        self._oldest = self._jobs.latest + 1
        self._callbacks.clear()
        self.progressed.emit(None)

    def stop(self) -> None:
        """Stop at the user's wish and say so."""
        if self.busy:
            self.forget()
            self.stopped.emit()

    def close(self) -> None:
        """Stop and end the thread."""
        self._jobs.close()
        self._callbacks.clear()

    def _receive(self, event: JobEvent) -> None:
        if event.ticket < self._oldest:
            return
        if isinstance(event, Progressed):
            self._report(event.ticket, event.progress)
            return
        # Older requests were replaced while they waited: no answer will come for them.
        for ticket in [t for t in self._callbacks if t < event.ticket]:
            del self._callbacks[ticket]
        done, fail = self._callbacks.pop(event.ticket, (None, None))
        if not self._callbacks:
            self.progressed.emit(None)
        if isinstance(event, Finished) and done is not None:
            done(event.result)
        elif isinstance(event, Failed) and fail is not None:
            fail(event.error)

    def _report(self, ticket: int, progress: Progress) -> None:
        if ticket == self._jobs.latest:
            self.progressed.emit(progress)
