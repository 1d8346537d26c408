"""Background work where only the latest request matters.

One worker thread runs one job at a time. A job is a generator that yields Progress and returns
its result. A newer request replaces a waiting one and stops the running one, at its next yield or
inside a factorisation; a job that has neither (one back-substitution of a drag) is left to finish,
so that a stream of requests still shows results instead of cancelling each other for ever.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Any

from solvers.interruption import Interrupted, Interruption
from solvers.progress import Progress

Job = Callable[[], Generator[Progress, None, Any]]


@dataclass(frozen=True)
class Progressed:
    """The job of this ticket is still at work."""

    ticket: int
    progress: Progress


@dataclass(frozen=True)
class Finished:
    """The job of this ticket returned."""

    ticket: int
    result: Any


@dataclass(frozen=True)
class Failed:
    """The job of this ticket raised."""

    ticket: int
    error: Exception


@dataclass(frozen=True)
class Stopped:
    """The job of this ticket was stopped before its end."""

    ticket: int


JobEvent = Progressed | Finished | Failed | Stopped


class LatestJobs:
    """Run the latest requested job off the caller's thread.

    Parameters
    ----------
    notify : callable
        Called with each JobEvent *on the worker thread*, in the order of the tickets.
    """

    def __init__(self, notify: Callable[[JobEvent], None]) -> None:
        self._notify = notify
        self._condition = threading.Condition()
        self._waiting: tuple[int, Job] | None = None
        self._running: tuple[int, Interruption] | None = None
        self._latest = 0
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="crossview-jobs", daemon=True)
        self._thread.start()

    @property
    def latest(self) -> int:
        """Ticket of the newest request."""
        return self._latest

    @property
    def busy(self) -> bool:
        """Whether a job runs or waits."""
        with self._condition:
            return self._waiting is not None or self._running is not None

    def submit(self, job: Job) -> int:
        """Request `job` in place of all earlier ones; return its ticket, larger than theirs."""
        with self._condition:
            if self._closed:
                raise RuntimeError("the job queue is closed")
            self._latest += 1
            self._interrupt()
            self._waiting = (self._latest, job)
            self._condition.notify_all()
            return self._latest

    def cancel(self) -> None:
        """Forget the waiting job and stop the running one as soon as it can be."""
        with self._condition:
            self._interrupt()
            self._waiting = None

    def close(self) -> None:
        """Cancel everything and end the thread."""
        with self._condition:
            self._closed = True
            self._condition.notify_all()
        self.cancel()
        self._thread.join()

    def _interrupt(self) -> None:
        if self._running is not None:
            self._running[1].ask()

    def _work(self) -> None:
        while (claimed := self._claim()) is not None:
            event = self._run(*claimed)
            with self._condition:
                self._running = None
            self._notify(event)

    def _claim(self) -> tuple[int, Job, Interruption] | None:
        with self._condition:
            self._condition.wait_for(lambda: self._closed or self._waiting is not None)
            if self._closed or self._waiting is None:
                return None
            (ticket, job), self._waiting = self._waiting, None
            self._running = ticket, Interruption()
            return ticket, job, self._running[1]

    def _run(self, ticket: int, job: Job, interruption: Interruption) -> JobEvent:
        try:
            with interruption.obeyed():
                steps = job()
                while True:
                    progress = next(steps)
                    if interruption.asked:
                        steps.close()
                        return Stopped(ticket)
                    self._notify(Progressed(ticket, progress))
        except StopIteration as end:
            return Finished(ticket, end.value)
        except Interrupted:
            return Stopped(ticket)
        except Exception as error:
            # Whatever went wrong belongs in the window's message bar; the worker must live on.
            return Failed(ticket, error)
