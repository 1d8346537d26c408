"""Verbs that place all singularities anew in the background, each one step of the history."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import replace
from functools import partial

from crossview.session.commands import Command
from crossview.session.message import Message
from crossview.session.verbs.group import VerbGroup
from crossview.session.waypoints import move_to_validity, place_natural
from solvers.progress import Progress


class Moves(VerbGroup):
    """Moves singularities to validity, or to where they appear by themselves."""

    def make_valid(self) -> None:
        """Move the unlocked singularities to where the holonomy defects vanish."""
        state = self._state
        if state.document is None:
            return
        self._run(partial(move_to_validity, state.document, state.base))

    def place_natural(self, method: str) -> None:
        """Replace the singularities by those of a smooth cross-field."""
        state = self._state
        if state.document is not None:
            alignment = "curvature" if state.along_curvature else "smoothness"
            # on their way there are none
            self._store.update(state.focused(replace(state.focus, selected=None, partner=None)))
            place = partial(
                place_natural, state.document, method, alignment, fewest=state.fewest_natural
            )
            self._run(place)

    def toggle_along_curvature(self) -> None:
        """Draw the crosses of natural singularities towards the directions of curvature, or not."""
        self._store.update(replace(self._state, along_curvature=not self._state.along_curvature))

    def toggle_fewest_natural(self) -> None:
        """Leave as few natural singularities as the index budget allows, or all."""
        fewest = not self._state.fewest_natural
        self._store.update(replace(self._state, fewest_natural=fewest))

    def _run(self, job: Callable[[], Generator[Progress, None, Command]]) -> None:
        def failed(error: Exception) -> None:
            self._solving.restore()
            self._store.fail(error, "edit")

        def stopped() -> None:
            self._solving.restore()
            text = "Stopped; nothing was changed"
            message = Message(text, "edit", "info", stopped=True)
            self._store.update(self._state.said(message))

        self._store.update(self._state.unsaid("edit"))
        self._solving.run(job, self._do, failed, stopped)
