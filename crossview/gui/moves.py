"""Verbs that place all singularities anew in the background, each one step of the history."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import replace
from functools import partial

from crossview.gui.solving import Solving
from crossview.gui.store import Store
from crossview.session.commands import Command
from crossview.session.message import Message
from crossview.session.moving import move_to_validity, place_natural
from solvers.progress import Progress


class Moves:
    """Moves singularities to validity, or to where they appear by themselves.

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

    def make_valid(self) -> None:
        """Move the unlocked singularities to where the holonomy defects vanish."""
        state = self._store.state
        if state.document is None:
            return
        self._run(partial(move_to_validity, state.document, state.base))

    def place_natural(self, method: str) -> None:
        """Replace the singularities by those of a smooth cross-field."""
        state = self._store.state
        if state.document is not None:
            alignment = "curvature" if state.along_curvature else "smoothness"
            # on their way there are none
            self._store.update(state.focused(replace(state.focus, selected=None, partner=None)))
            self._run(partial(place_natural, state.document, method, alignment))

    def _run(self, job: Callable[[], Generator[Progress, None, Command]]) -> None:
        def failed(error: Exception) -> None:
            self._solving.restore()
            self._store.fail(error, "edit")

        def stopped() -> None:
            self._solving.restore()
            text = "Stopped; nothing was changed"
            message = Message(text, "edit", "info", stopped=True)
            self._store.update(self._store.state.said(message))

        self._store.update(self._store.state.unsaid("edit"))
        self._solving.run(job, self._do, failed, stopped)
