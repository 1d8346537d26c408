"""What groups of verbs share."""

from __future__ import annotations

from collections.abc import Callable

from crossview.session.commands import Command
from crossview.session.state import SessionState
from crossview.session.store import Store
from crossview.session.verbs.solving import Solving


class VerbGroup:
    """Verbs over one state, with the background that follows it and the history it is undone by.

    Parameters
    ----------
    store : Store
    solving : Solving
    do : callable
        Makes a command one step of the history.
    """

    def __init__(self, store: Store, solving: Solving, do: Callable[[Command], None]) -> None:
        self._store = store
        self._solving = solving
        self._do = do

    @property
    def _state(self) -> SessionState:
        return self._store.state
