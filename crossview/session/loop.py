"""The thread that a session lives on, as the session sees it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol


class Timer(Protocol):
    """Does something once, a while after it was last started."""

    def start(self) -> None:
        """Start, or start again from the beginning."""

    def stop(self) -> None:
        """Do nothing after all."""


class Loop(Protocol):
    """Does one thing after the other on one thread: a window's events, or a test's queue."""

    def call(self, job: Callable[[], None]) -> None:
        """Do something soon, in the order of the calls, which may come from any thread."""

    def timer(self, seconds: float, job: Callable[[], None]) -> Timer:
        """Return a timer, not started."""
