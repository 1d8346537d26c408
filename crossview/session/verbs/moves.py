"""Verbs that place all singularities anew in the background, each one step of the history."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import replace
from functools import partial
from typing import TypeVar

import numpy as np

from crossview.session.commands import Command, GiveUpConnections
from crossview.session.message import Message, NaturalBy
from crossview.session.verbs.group import VerbGroup
from crossview.session.verbs.solving import STARTING
from crossview.session.waypoints import (
    NATURAL_LABELS,
    Waypoint,
    connect,
    improve_sizes,
    improved_to,
    merge_to_fewer,
    move_to_validity,
    place_natural,
    snap_separatrices,
)
from crossview.workflow.configurations import crowded
from solvers.errors import counted
from solvers.fields import NATURAL_METHODS
from solvers.layouts import Snapped
from solvers.progress import Progress, relayed
from solvers.validity import Improved

T = TypeVar("T")

Joining = Generator[Progress, None, tuple[Command, Snapped]]


class Moves(VerbGroup):
    """Moves singularities to validity, or to where they appear by themselves."""

    def make_valid(self) -> None:
        """Move the unlocked singularities to where the holonomy defects vanish."""
        state = self._state
        if state.document is None:
            return
        self._run(
            partial(move_to_validity, state.document, state.base), self._do, self._say_unchanged
        )

    def improve(self) -> None:
        """Move the unlocked singularities to where sizes are most even; stopped, where they are."""
        document = self._state.document
        if document is None:
            return

        def done(found: tuple[Command, Improved]) -> None:
            command, end = found
            if end.singularities == end.start:
                self._solving.restore()
                self._say("Sizes are as even as these singularities let them be")
                return
            self._do(command)
            self._say(
                f"Sizes are more even: variance of H {end.before.variance:.3g} before, "
                f"{end.sizes.variance:.3g} now"
            )

        passed: list[Waypoint] = []

        def keep(step: Progress) -> Progress:
            if isinstance(step, Waypoint):
                passed.append(step)
            return step

        def stopped() -> None:
            if passed:
                self._do(improved_to(document, passed[-1].singularities))
            else:
                self._say_unchanged()

        way = partial(improve_sizes, document, self._state.base)
        self._run(lambda: relayed(way(), keep), done, stopped)

    def snap(self) -> None:
        """Move the unlocked singularities until separatrices meet what they nearly meet."""
        self._join(snap_separatrices)

    def connect(self, pair: tuple[int, int]) -> None:
        """Move the unlocked singularities until a separatrix joins two of them."""
        self._join(partial(connect, pair=pair))

    def _join(self, way: Callable[..., Joining]) -> None:
        document, base = self._state.document, self._state.base
        if document is None:
            return

        def done(found: tuple[Command, Snapped]) -> None:
            command, end = found
            before, after = (
                document.surface.positions([s.point for s in placed])
                for placed in (document.singularities, end.singularities)
            )
            farthest = float(np.linalg.norm(after - before, axis=1).max())
            self._do(command)
            self._say(
                f"{counted(len(end.connections), 'connection')} between singularities, "
                f"which moved by up to {farthest:.3g}"
            )

        self._run(partial(way, document, base), done, self._say_unchanged)

    def let_connections_go(self) -> None:
        """Keep none of the selected singularities joined; without any selected, none at all."""
        state = self._state
        self._do(GiveUpConnections(frozenset(state.focus.all or range(len(state.singularities)))))

    def simplify(self, most: int) -> None:
        """Merge unlocked singularities until `most` are left, and make those valid."""
        document = self._state.document
        if document is None:
            return

        def done(command: Command) -> None:
            self._do(command)
            before, after = len(document.singularities), len(self._state.singularities)
            self._say(f"{before} singularities before, {after} now, every loop closed")

        # on their way there are other ones
        self._store.update(self._state.focused(self._state.focus.on(None)))
        fewer = partial(merge_to_fewer, document, self._state.base, most)
        self._run(fewer, done, self._say_unchanged)

    def place_natural(self, method: str) -> None:
        """Replace the singularities by those of a smooth cross-field."""
        state = self._state
        if state.document is not None:
            alignment = "curvature" if state.along_curvature else "smoothness"

            def done(command: Command) -> None:
                self._do(command)
                self._say_crowded(method)

            # on their way there are none
            self._store.update(state.focused(state.focus.on(None)))
            place = partial(
                place_natural, state.document, method, alignment, fewest=state.fewest_natural
            )
            self._run(place, done, self._say_unchanged, f"preparing {NATURAL_LABELS[method]}")

    def toggle_along_curvature(self) -> None:
        """Draw the crosses of natural singularities towards the directions of curvature, or not."""
        self._store.update(replace(self._state, along_curvature=not self._state.along_curvature))

    def toggle_fewest_natural(self) -> None:
        """Leave as few natural singularities as the index budget allows, or all."""
        fewest = not self._state.fewest_natural
        self._store.update(replace(self._state, fewest_natural=fewest))

    def _run(
        self,
        job: Callable[[], Generator[Progress, None, T]],
        done: Callable[[T], None],
        stopped: Callable[[], None],
        first: str = STARTING,
    ) -> None:
        def failed(error: Exception) -> None:
            self._solving.restore()
            self._store.fail(error, "edit")

        self._store.update(self._state.unsaid("edit"))
        self._solving.run(job, done, failed, stopped, first)

    def _say_crowded(self, method: str) -> None:
        """Say which singularities are where they are by chance, and offer a method without."""
        document, other = self._state.document, NATURAL_METHODS[0]
        if document is None or not (count := crowded(document.problem)):
            return
        message = Message(
            f"{count} singularities are as near to another as edges are long",
            "edit",
            "warning",
            f"a finer surface would place them otherwise; {NATURAL_LABELS[other]} keeps them apart",
            remedies=() if method == other else (NaturalBy(f"use {NATURAL_LABELS[other]}", other),),
        )
        self._store.update(self._state.said(message))

    def _say(self, text: str) -> None:
        self._store.update(self._state.said(Message(text, "edit", "info")))

    def _say_unchanged(self) -> None:
        self._solving.restore()
        text = "Stopped; nothing was changed"
        message = Message(text, "edit", "info", stopped=True)
        self._store.update(self._state.said(message))
