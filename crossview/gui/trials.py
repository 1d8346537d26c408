"""What would happen: the add tool's preview and the drag, while the mouse moves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from crossview.gui.solving import Solving
from crossview.gui.state import Trial
from crossview.gui.store import Store
from crossview.session.commands import Command, MoveSingularity
from crossview.session.document import Document
from crossview.session.guiding import Guidance
from crossview.session.live import LiveEdit
from solvers.singularities.budget import Singularity
from solvers.surface.points import SurfacePoint


class Trials:
    """Tries singularities out on the kept factor; only `drop` changes the document.

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
        self._guidance: Guidance | None = None

    def preview(self, point: SurfacePoint | None) -> None:
        """Show what a click of the add tool at `point` of the shown surface would do."""
        state = self._store.state
        document, valence, surface = state.document, state.tool, state.shown_surface
        if point is None or document is None or valence is None or surface is None:
            self._store.set(trial=None)
            return
        added = Singularity(state.lifted(point), valence)
        edit = self._live_edit(document)
        if edit is not None:
            edit = edit.added(Singularity(point, valence))
        singularities = (*document.singularities, added)
        trial = Trial(singularities, len(singularities) - 1, point, surface, edit, drag=False)
        self._store.set(trial=trial)

    def start_drag(self, index: int) -> bool:
        """Take hold of singularity `index`; False when it is locked."""
        state = self._store.state
        document, surface = state.document, state.shown_surface
        if document is None or surface is None or document.singularities[index].locked:
            return False
        point = document.singularities[index].point
        placed = point if state.base is None else state.base.locate(point)
        edit = self._live_edit(document)
        self._guidance = None
        if edit is not None and document.budget.satisfied:
            self._guidance = Guidance(edit, index)
        trial = Trial(document.singularities, index, placed, surface, edit, drag=True)
        self._store.set(trial=trial, selected=index)
        return True

    def drag_to(self, point: SurfacePoint, keep: bool = False) -> None:
        """Move the held singularity to `point` of the shown surface; the field follows.

        Parameters
        ----------
        point : SurfacePoint
        keep : bool
            Keep it on the guide line of the condition that is followed, else of the worst one.
        """
        state = self._store.state
        trial = state.trial
        if trial is None or not trial.drag:
            return
        if keep and self._guidance is not None:
            point = self._guidance.kept(state.followed, point)
        moved = list(trial.singularities)
        moved[trial.index] = replace(moved[trial.index], point=state.lifted(point))
        edit = None if trial.edit is None else trial.edit.moved(trial.index, point)
        trial = replace(trial, singularities=tuple(moved), placed=point, edit=edit)
        self._store.set(trial=trial)
        if edit is not None and state.field is not None:
            self._solving.try_out(edit)

    def drop(self) -> None:
        """Let go: the whole drag becomes one step, and the refined field is solved."""
        trial = self._store.state.trial
        if trial is not None and trial.drag:
            self._store.set(trial=None)
            self._do(MoveSingularity(trial.index, trial.singularities[trial.index].point))

    def cancel(self) -> None:
        """Let go and put it back."""
        trial = self._store.state.trial
        if trial is not None and trial.drag:
            self._store.set(trial=None)
            self._solving.follow()

    def _live_edit(self, document: Document) -> LiveEdit | None:
        base = self._store.state.base
        return None if base is None else LiveEdit.start(document, base)
