"""Verbs that keep the index sum, or complete it, each one step of the history."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from crossview.session.commands import Command
from crossview.session.document import Document
from crossview.session.rearrangements import (
    add_pair,
    add_pair_somewhere,
    distribute,
    merge,
    mirror,
    rotate,
    split_one,
)
from crossview.session.verbs.group import VerbGroup
from solvers.surface import SurfacePoint


class Pairs(VerbGroup):
    """Pairs added, singularities merged and split, configurations mirrored, turned, completed."""

    def add(self, point: SurfacePoint | None) -> None:
        """Add a pair around `point` of the shown surface; None: where there is most room."""
        state = self._state
        if state.document is None:
            return
        if point is not None:
            self._at_once(partial(add_pair, point=state.lifted(point)))
            return
        self._store.update(self._state.unsaid("edit"))
        job = partial(add_pair_somewhere, state.document)
        self._solving.run(job, self._do, self._failed)

    def merge(self) -> None:
        """Make one of the two selected singularities."""
        pair = self._state.focus.pair
        if pair is not None:
            self._at_once(partial(merge, one=pair[0], other=pair[1]))

    def split(self, index: int) -> None:
        """Make two of singularity `index`."""
        self._at_once(partial(split_one, which=index))

    def mirror(self, axis: int) -> None:
        """Mirror the configuration across x (0), y or z."""
        self._at_once(partial(mirror, axis=axis))

    def rotate(self, axis: int) -> None:
        """Turn the configuration by 90 degrees about x (0), y or z."""
        self._at_once(partial(rotate, axis=axis))

    def distribute(self) -> None:
        """Add what the index budget lacks."""
        document = self._state.document
        if document is not None:
            self._store.update(self._state.unsaid("edit"))
            self._solving.run(partial(distribute, document), self._do, self._failed)

    def _failed(self, error: Exception) -> None:
        self._store.fail(error, "edit")
        self._solving.resume()

    def _at_once(self, make: Callable[[Document], Command]) -> None:
        document = self._state.document
        if document is not None:
            self._store.attempt("edit", lambda: self._do(make(document)))
