"""Verbs that change the document, by hand, and take changes back."""

from __future__ import annotations

from dataclasses import replace

from crossview.session.commands import (
    AddSingularities,
    ChangeValence,
    ChooseMethod,
    Command,
    LockSingularity,
    RemoveSingularities,
    next_valence,
)
from crossview.session.document import Document
from crossview.session.history import History
from crossview.session.store import Store
from crossview.session.verbs.solving import Solving
from solvers.singularities import Singularity
from solvers.surface import SurfacePoint


class Edits:
    """Keeps the history; each verb is one step of it, and a new solve follows.

    Parameters
    ----------
    store : Store
    solving : Solving
    """

    def __init__(self, store: Store, solving: Solving) -> None:
        self._store = store
        self._solving = solving
        self._history = History()

    def open(self, document: Document, kept: bool = True) -> None:
        """Make another document the present one; `kept`: a file holds it."""
        self._history.open(document)
        self._changed(document if kept else None)

    def keep(self) -> None:
        """Tell that a file holds the present document."""
        state = self._store.state
        self._store.update(replace(state, kept=state.document))

    def do(self, command: Command) -> None:
        """Make one undoable change."""
        self._history.do(command)
        self._changed(self._store.state.kept)

    def undo(self) -> None:
        """Take the last step back."""
        self._history.undo()
        self._changed(self._store.state.kept)

    def redo(self) -> None:
        """Make the last undone step again."""
        self._history.redo()
        self._changed(self._store.state.kept)

    def add(self, point: SurfacePoint, valence: int) -> None:
        """Add a singularity at `point` of the shown surface and select it."""
        state = self._store.state
        if state.document is not None:
            added = Singularity(state.lifted(point), valence)
            self.do(AddSingularities((added,)))
            newest = len(state.document.singularities)
            self._store.update(self._store.state.selecting(newest))

    def change_valence(self, index: int, valence: int) -> None:
        """Give singularity `index` another valence; 4 is regular and not taken."""
        if valence not in (4, self._valence(index)):
            self.do(ChangeValence(index, valence))

    def step_valence(self, index: int, step: int) -> None:
        """Raise or lower the valence by one, past 4."""
        self.change_valence(index, next_valence(self._valence(index), step))

    def toggle_lock(self, index: int) -> None:
        """Lock singularity `index`, or unlock it."""
        self.do(LockSingularity(index, not self._store.state.singularities[index].locked))

    def remove(self, *indices: int) -> None:
        """Delete singularities."""
        self.do(RemoveSingularities(frozenset(indices)))

    def choose_method(self, method: str) -> None:
        """Solve by another method; the last result of each is kept."""
        document = self._store.state.document
        if document is not None and document.problem.method != method:
            self.do(ChooseMethod(method))

    def _valence(self, index: int) -> int:
        return self._store.state.singularities[index].valence

    def _changed(self, kept: Document | None) -> None:
        """Bring everything in line with the present document of the history."""
        present, state = self._history, self._store.state
        if present.document is None:  # nothing to undo
            return
        changed = state.document_changed(present.document, present.undo_name, present.redo_name)
        self._store.update(replace(changed, kept=kept))
        self._solving.follow()
