"""Keeps near misses in step with what is solved, beside all other work."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace
from functools import partial

from crossview.session.background import Background
from crossview.session.document import Document
from crossview.session.loop import Loop
from crossview.session.state import SessionState
from crossview.session.store import Store
from crossview.workflow import configurations
from crossview.workflow.layout import SOON
from solvers.errors import CrossviewError
from solvers.layouts import NearMisses
from solvers.progress import Progress


class NearMissFinder:
    """Looks for near misses of each valid configuration that is solved; the latest wins.

    Parameters
    ----------
    store : Store
    loop : Loop
        The thread that answers come on.
    """

    def __init__(self, store: Store, loop: Loop) -> None:
        self._store = store
        self._background = Background(loop)
        self._subject: Document | None = None
        store.observers.append(self._follow)

    @property
    def busy(self) -> bool:
        """Whether an answer is still awaited."""
        return self._background.busy

    def close(self) -> None:
        """End the background thread."""
        self._background.close()

    def _follow(self, _: SessionState, state: SessionState) -> None:
        """Bring them in line with the state."""
        subject = _subject(state)
        if subject is self._subject:
            return
        self._subject = subject
        self._background.forget()
        self._show(None)
        if subject is not None:
            job = partial(_found, subject)
            self._background.submit(job, self._show, lambda e: self._store.fail(e, "guide"))

    def _show(self, found: NearMisses | None) -> None:
        self._store.update(replace(self._store.state, near_misses=found))


def _subject(state: SessionState) -> Document | None:
    """Return the configuration to look at, if there is to be any."""
    document = state.document
    idle = state.solved and state.moving is None and state.trial is None
    if document is None or not idle or not state.layers["guide"].visible or not state.valid:
        return None
    return document if document.surface.n_faces <= SOON else None


def _found(document: Document) -> Generator[Progress, None, NearMisses | None]:
    """Return the near misses; None where nothing may move, or connections do not hold."""
    try:
        return (yield from configurations.near_misses(document.problem))
    except CrossviewError:
        return None
