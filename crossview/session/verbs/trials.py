"""What would happen: the add tool's preview and the drag, while the mouse moves."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from crossview.session.commands import MoveSingularity, Together
from crossview.session.guide_curves import Guidance
from crossview.session.hand import Trial
from crossview.session.verbs.group import VerbGroup
from solvers.surface import SurfacePoint


class Trials(VerbGroup):
    """Tries singularities out on the kept factor; only `drop` changes the document."""

    _guidance: Guidance | None = None

    def preview(self, point: SurfacePoint | None) -> None:
        """Show what a click of the add tool at `point` of the shown surface would do."""
        self._store.update(self._state.previewed(point))

    def start_drag(self, index: int) -> bool:
        """Take hold of singularity `index`; False when it is locked."""
        self._store.update(self._state.taken_hold(index))
        state, trial = self._state, self._held
        self._guidance = None
        if trial is None or state.document is None:
            return False
        if trial.edit is not None and state.document.budget.satisfied:
            self._guidance = Guidance(trial.edit, index)
        return True

    def drag_to(self, point: SurfacePoint, keep: bool = False) -> None:
        """Move the held singularity to `point` of the shown surface; the field follows.

        Parameters
        ----------
        point : SurfacePoint
        keep : bool
            Keep it on the guide line of the condition that is followed, else of the worst one.
        """
        if self._held is None:
            return
        if keep and self._guidance is not None:
            point = self._guidance.kept(self._state.focus.followed, point)
        self._store.update(self._state.dragged_to(point))
        trial = self._held
        if trial is not None and trial.edit is not None and self._state.field is not None:
            self._solving.try_out(trial.edit)

    def drop(self, others: Mapping[int, SurfacePoint] = MappingProxyType({})) -> None:
        """Let go: the whole drag becomes one step, and the refined field is solved.

        Parameters
        ----------
        others : mapping of int to SurfacePoint
            Singularities that come along, and where they come to on the shown surface.
        """
        trial, state = self._held, self._state
        if trial is None:
            return
        moved = [MoveSingularity(trial.index, trial.held.point)]
        moved += [
            MoveSingularity(i, state.lifted(point))
            for i, point in others.items()
            if not state.singularities[i].locked
        ]
        self._store.update(state.let_go())
        name = f"move {len(moved)} singularities"
        self._do(moved[0] if len(moved) == 1 else Together(tuple(moved), name))

    def cancel(self) -> None:
        """Let go and put it back."""
        if self._held is not None:
            self._store.update(self._state.let_go())
            self._solving.follow()

    @property
    def _held(self) -> Trial | None:
        trial = self._state.trial
        return trial if trial is not None and trial.drag else None
