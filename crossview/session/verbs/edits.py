"""Verbs that change the document, by hand, and take changes back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from crossview.session.commands import (
    MAX_VALENCE,
    MIN_VALENCE,
    AddSingularities,
    ChangeTitle,
    ChangeValence,
    ChooseMethod,
    Command,
    LockSingularity,
    MoveSingularity,
    RemoveSingularities,
    Together,
    next_valence,
)
from crossview.session.document import Document
from crossview.session.history import History
from crossview.session.store import Store
from crossview.session.verbs.solving import Solving
from solvers.errors import CrossviewError
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
        """Give singularity `index` another valence; one that there is not is refused."""
        if valence == 4 or not MIN_VALENCE <= valence <= MAX_VALENCE:
            reason = "is regular" if valence == 4 else "is not offered"
            advice = f"choose from {MIN_VALENCE} to {MAX_VALENCE}, but 4"
            self._store.fail(CrossviewError(f"valence {valence} {reason}", "", advice), "edit")
        elif valence != self._valence(index):
            self.do(ChangeValence(index, valence))

    def step_valence(self, step: int, *indices: int) -> None:
        """Raise or lower valences by one, past 4, within the limits."""
        following = {i: next_valence(self._valence(i), step) for i in indices}
        changes = [ChangeValence(i, v) for i, v in following.items() if v != self._valence(i)]
        self._do_all(changes, f"change {len(changes)} valences")

    def move(self, places: Mapping[int, SurfacePoint]) -> None:
        """Put singularities to points of the shown surface, one step for all; not locked ones."""
        state = self._store.state
        free = {i: point for i, point in places.items() if not state.singularities[i].locked}
        self._do_all(
            [MoveSingularity(i, state.lifted(point)) for i, point in free.items()],
            f"move {len(free)} singularities",
        )

    def toggle_lock(self, *indices: int) -> None:
        """Lock singularities, or unlock them if all are locked."""
        lock = not all(self._store.state.singularities[i].locked for i in indices)
        word = "lock" if lock else "unlock"
        self._do_all(
            [LockSingularity(i, lock) for i in indices], f"{word} {len(indices)} singularities"
        )

    def remove(self, *indices: int) -> None:
        """Delete singularities."""
        self.do(RemoveSingularities(frozenset(indices)))

    def choose_method(self, method: str) -> None:
        """Solve by another method; the last result of each is kept."""
        document = self._store.state.document
        if document is not None and document.problem.method != method:
            self.do(ChooseMethod(method))

    def change_title(self, title: str) -> None:
        """Give the configuration another title, which figures and files carry."""
        document = self._store.state.document
        if document is not None and document.title != title:
            self.do(ChangeTitle(title))

    def _do_all(self, commands: Sequence[Command], name: str) -> None:
        """Make several changes one step; one alone keeps its name."""
        if commands:
            self.do(commands[0] if len(commands) == 1 else Together(tuple(commands), name))

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
