"""The background jobs of `jobs`, answered on the session's own thread."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from crossview.session.jobs import Failed, Finished, Job, JobEvent, LatestJobs, Progressed
from crossview.session.loop import Loop
from solvers.progress import Progress

Done = Callable[[Any], None]
Fail = Callable[[Exception], None]


class Background:
    """Runs the latest job and calls back on the thread of a loop.

    Answers older than the last `forget` are dropped; those of a stream come in order.

    Parameters
    ----------
    loop : Loop
    report : callable, optional
        Called with the Progress of the latest job, with None when nothing is left to do.
    """

    def __init__(
        self, loop: Loop, report: Callable[[Progress | None], None] = lambda _: None
    ) -> None:
        self._jobs = LatestJobs(lambda event: loop.call(partial(self._receive, event)))
        self._report = report
        self._callbacks: dict[int, tuple[Done, Fail]] = {}
        self._oldest = 0

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
        self._drop()
        self._report(None)

    def close(self) -> None:
        """Stop, end the thread, and answer no more."""
        self._jobs.close()
        self._drop()

    def _drop(self) -> None:
        self._oldest = self._jobs.latest + 1
        self._callbacks.clear()

    def _receive(self, event: JobEvent) -> None:
        if event.ticket < self._oldest:
            return
        if isinstance(event, Progressed):
            if event.ticket == self._jobs.latest:
                self._report(event.progress)
            return
        # Older requests were replaced while they waited: no answer will come for them.
        for ticket in [t for t in self._callbacks if t < event.ticket]:
            del self._callbacks[ticket]
        done, fail = self._callbacks.pop(event.ticket, (None, None))
        if not self._callbacks:
            self._report(None)
        if isinstance(event, Finished) and done is not None:
            done(event.result)
        elif isinstance(event, Failed) and fail is not None:
            fail(event.error)
