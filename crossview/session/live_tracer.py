"""Separatrices while the mouse moves: as often as leaves the field its time."""

from __future__ import annotations

import time
from collections.abc import Generator
from dataclasses import dataclass

from crossview.session.live import LiveEdit
from solvers.fields import CrossField
from solvers.layouts import Separatrices, field_separatrices
from solvers.progress import Progress

LONGEST = 1.5
"""Length at which a curve is given up, in square roots of the surface's area."""

QUICK = 0.05
"""Seconds of work that tracing may take while something moves."""

PAUSES = 2.0
"""Between two tracings passes so many times the time that one has taken."""


@dataclass(frozen=True, eq=False)
class Traced:
    """A field of a drag and its separatrices, None where they were left out for speed."""

    field: CrossField
    separatrices: Separatrices | None


class LiveTracer:
    """Traces fields of a drag, one after the other, all on one thread."""

    def __init__(self) -> None:
        self._work = 0.0
        self._seconds = 0.0
        self._ended = 0.0

    @property
    def ready(self) -> bool:
        """Whether tracing now would not hold up what moves."""
        rested = time.monotonic() - self._ended >= PAUSES * self._seconds
        return self._work <= QUICK and rested

    def follow(self, edit: LiveEdit, wanted: bool) -> Generator[Progress, None, Traced]:
        """Solve an edit; trace it if that is wanted and there is time."""
        field = yield from edit.solve()
        return self._traced(field) if wanted and self.ready else Traced(field, None)

    def catch_up(self, field: CrossField) -> Generator[Progress, None, Traced]:
        """Trace a field that was left out."""
        yield from ()
        return self._traced(field)

    def _traced(self, field: CrossField) -> Traced:
        # work, unlike time, is the same whatever else the machine does
        start, work = time.monotonic(), time.thread_time()
        found = field_separatrices(field, LONGEST)
        self._ended, self._work = time.monotonic(), time.thread_time() - work
        self._seconds = self._ended - start
        return Traced(field, found)
