"""Stopping a computation inside a step of it: one thread asks, what runs on another is told.

A computation stops by itself where it yields `solvers.progress.Progress`. Between two of these a
library may work for seconds; one that can be stopped is told to, as soon as somebody asks.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar


class Interrupted(Exception):
    """A computation was stopped in the middle of a step."""


class Interruption:
    """What one thread asks for and others are told of.

    Examples
    --------
    >>> from solvers.algebra import factorized, stiffness
    >>> from solvers.interruption import Interrupted, Interruption
    >>> from solvers.primitives import disk
    >>> matrix = stiffness(disk(edge_length=0.25).triangulation)[1:, 1:]
    >>> interruption = Interruption()
    >>> interruption.ask()
    >>> try:
    ...     with interruption.obeyed():
    ...         factorized(matrix)
    ... except Interrupted:
    ...     print("stopped")
    stopped
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._asked = False
        self._stops: list[Callable[[], None]] = []

    @property
    def asked(self) -> bool:
        """Whether anybody has asked."""
        return self._asked

    def ask(self) -> None:
        """Have what runs under this stop, from any thread; what starts later stops at once."""
        with self._lock:
            self._asked = True
            for stop in self._stops:
                stop()

    @contextmanager
    def obeyed(self) -> Iterator[None]:
        """Let what runs inside, on this thread, be stopped by this."""
        token = _PRESENT.set(self)
        try:
            yield
        finally:
            _PRESENT.reset(token)

    @contextmanager
    def telling(self, stop: Callable[[], None]) -> Iterator[None]:
        """Have `stop` called as soon as anybody asks, at once if somebody has."""
        with self._lock:
            self._stops.append(stop)
            if self._asked:
                stop()
        try:
            yield
        finally:
            with self._lock:
                self._stops.remove(stop)


_PRESENT: ContextVar[Interruption] = ContextVar("interruption")
"""What the work of each thread obeys."""


def interruption() -> Interruption:
    """Return what stops the work of this thread, one that nobody asks where there is none."""
    return _PRESENT.get(None) or Interruption()
