"""A session without a window: its loop is a plain queue that a test turns by hand."""

import queue
import time
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from crossview.session.opening import Opening
from crossview.session.session import Session
from crossview.session.state import SessionState
from solvers.surface import FloatArray, SurfacePoint

PATIENCE = 60.0
T = TypeVar("T")


def known(value: T | None) -> T:
    """A value that is there."""
    assert value is not None
    return value


class QueueTimer:
    """Puts a job into the queue of a loop when it is due."""

    def __init__(self, loop: "QueueLoop", seconds: float, job: Callable[[], None]) -> None:
        self._loop, self._seconds, self._job = loop, seconds, job
        self._due: float | None = None

    def start(self) -> None:
        self._due = time.monotonic() + self._seconds

    def stop(self) -> None:
        self._due = None

    @property
    def running(self) -> bool:
        return self._due is not None

    def look(self) -> None:
        if self._due is not None and time.monotonic() >= self._due:
            self._due = None
            self._loop.call(self._job)


class QueueLoop:
    def __init__(self) -> None:
        self._jobs: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self.timers: list[QueueTimer] = []

    def call(self, job: Callable[[], None]) -> None:
        self._jobs.put(job)

    def timer(self, seconds: float, job: Callable[[], None]) -> QueueTimer:
        self.timers.append(QueueTimer(self, seconds, job))
        return self.timers[-1]

    def turn(self) -> None:
        """Do what has been asked for, at most one thing, waiting a moment for it."""
        for timer in self.timers:
            timer.look()
        try:
            job = self._jobs.get(timeout=0.005)
        except queue.Empty:
            return
        job()


class Headless:
    """A session and how a test waits for it."""

    def __init__(self) -> None:
        self.loop = QueueLoop()
        self.session = Session(self.loop)
        self.seen: list[SessionState] = []
        self.session.observers.append(lambda old, new: self.seen.append(new))

    @property
    def state(self) -> SessionState:
        return self.session.state

    def wait(self, wanted: Callable[[], bool] = lambda: True) -> None:
        """Turn the loop until the session is idle and `wanted` holds."""
        end = time.monotonic() + PATIENCE
        while True:
            self.loop.turn()
            if not self.session.busy and wanted():
                return
            assert time.monotonic() < end, f"still waiting; message: {self.state.message}"

    def open(self, target: str) -> None:
        self.session.open(Opening(target))
        self.wait()

    def once(self, wanted: Callable[[SessionState], bool], do: Callable[[], None]) -> None:
        """Do something at the first state that is wanted."""

        def look(old: SessionState, new: SessionState) -> None:
            if wanted(new):
                self.session.observers.remove(look)
                do()

        self.session.observers.append(look)

    def on_surface(self, *xyz: float) -> SurfacePoint:
        """The point of the shown surface nearest to a place."""
        return known(self.state.shown_surface).closest_point(np.array(xyz))

    def position(self, index: int) -> FloatArray:
        surface = known(self.state.document).surface
        return surface.position(self.state.singularities[index].point)
