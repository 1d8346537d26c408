"""What was done, said and waited for in a session, a line each."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime

from crossview.session.state import SessionState
from crossview.session.store import Store

MOST = 1000
"""Lines that are kept. Chosen."""

LONG = 0.5
"""Seconds from which on work is told. Chosen."""


@dataclass(frozen=True)
class Entry:
    """A line: when, of what kind (done, error, warning, info or time), and what."""

    when: datetime
    kind: str
    text: str

    def __str__(self) -> str:
        """Return the line."""
        return f"{self.when:%H:%M:%S}  {self.kind:<7}  {self.text}"


class Log:
    """Follows a store.

    Parameters
    ----------
    store : Store
    """

    def __init__(self, store: Store) -> None:
        self.entries: deque[Entry] = deque(maxlen=MOST)
        self.added: list[Callable[[Entry], object]] = []
        """Told of each new line."""
        self._started: float | None = None
        self._stage = ""
        store.observers.append(self._follow)

    def _follow(self, old: SessionState, new: SessionState) -> None:
        if new.document is not old.document and new.document is not None:
            self._add("done", _step(old, new))
        if new.message is not old.message and new.message is not None:
            below = f": {new.message.below}" if new.message.below else ""
            self._add(new.message.severity, new.message.text + below)
        if new.progress is old.progress:
            return
        if new.progress is not None:
            self._stage = new.progress.stage
            self._started = time.monotonic() if self._started is None else self._started
        elif self._started is not None:
            spent, self._started = time.monotonic() - self._started, None
            if spent >= LONG:
                self._add("time", f"{self._stage}: ready after {spent:.1f} s")

    def _add(self, kind: str, text: str) -> None:
        entry = Entry(datetime.now(), kind, text)
        self.entries.append(entry)
        for tell in tuple(self.added):
            tell(entry)


def _step(old: SessionState, new: SessionState) -> str:
    """Return what has led from one document to another."""
    if new.undo_name is None and new.redo_name is None:
        return f"open {new.document.name}" if new.document else ""
    if old.redo_name != new.redo_name and new.redo_name is not None:
        undone = old.undo_name == new.redo_name
        return f"undo {new.redo_name}" if undone else f"redo {new.undo_name}"
    if old.redo_name is not None and old.redo_name == new.undo_name:
        return f"redo {new.undo_name}"
    return str(new.undo_name)
