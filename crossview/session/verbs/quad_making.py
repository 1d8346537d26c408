"""Keeps separatrices and layout in step with the field, and makes quads when asked."""

from __future__ import annotations

from functools import partial

from crossview.session.meshes import Meshes, lay_out, make_quads, trace
from crossview.session.state import SessionState
from crossview.session.store import Store
from crossview.session.verbs.solving import Solving
from crossview.view.values import Elements
from crossview.workflow.quads import MeshOptions
from solvers.fields import CrossField
from solvers.layouts import LayoutError
from solvers.surface import TriSurface

KEPT = 4
"""Fields whose meshes are kept: one for each method."""


class QuadMaking:
    """Makes in the background what is shown of separatrices, layout and quads.

    Parameters
    ----------
    store : Store
    solving : Solving
        Calls `pursue` whenever it has nothing else to do.
    """

    def __init__(self, store: Store, solving: Solving) -> None:
        self._store = store
        self._solving = solving
        self._kept: list[Meshes] = []
        self._next: MeshOptions | None = None
        self._told: LayoutError | None = None
        solving.pursue_also(self.pursue)
        store.observers.append(self._forget)

    def make(self, options: MeshOptions) -> None:
        """Make the quads of the present solution; one that is still to come is waited for."""
        state = self._store.state
        self._store.update(state.unsaid("mesh"))
        if not state.solved or state.solution is None or state.field is not state.solution.field:
            self._next = options
            self._solving.resume()
            return
        self._next = None
        made = self._made(state.solution.field)
        job = partial(make_quads, state.solution, made, options)
        self._solving.run(job, partial(self._show_quads, options), self._failed)

    def wait_for(self, options: MeshOptions) -> None:
        """Make quads of the solution that is to come."""
        self._next = options

    def pursue(self) -> bool:
        """Start what is wanted next and not there yet; return whether there was any."""
        state = self._store.state
        solution = state.solution
        if solution is None or state.field is not solution.field:
            return False
        made = self._made(solution.field)
        if made is not state.meshes:
            self._store.update(self._store.state.meshes_made(made))
        if self._next is not None and state.solved:
            self.make(self._next)
            return True
        layers = state.layers
        curves = layers["separatrices"].visible or layers["marks"].visible
        if curves and not made.settled:
            self._solving.run(partial(trace, solution, made), self._show, self._failed)
            return True
        if made.trouble is not None:
            if layers["layout"].visible and made.trouble is not self._told:
                self._refuse(made.trouble, None)
        elif made.layout is None and layers["layout"].visible:
            self._solving.run(partial(lay_out, solution, made), self._show, self._failed)
            return True
        return False

    def _made(self, field: CrossField) -> Meshes:
        """Return what there is of a field."""
        shown = self._store.state.meshes
        if shown.of is field:
            return shown
        return next((made for made in self._kept if made.of is field), Meshes(field))

    def _show(self, made: Meshes) -> None:
        self._kept = [made, *(kept for kept in self._kept if kept.of is not made.of)][:KEPT]
        self._store.update(self._store.state.meshes_made(made))
        self._solving.pursue()

    def _show_quads(self, options: MeshOptions, made: Meshes) -> None:
        if made.trouble is not None:
            self._refuse(made.trouble, options)
        else:
            self._store.update(self._store.state.with_layer_shown("quads"))
        self._show(made)

    def _refuse(self, trouble: LayoutError, options: MeshOptions | None) -> None:
        """Say why there is no layout, where, and what may be done."""
        self._told = trouble
        pointed = Elements(faces=trouble.faces) if len(trouble.faces) else None
        cause = "layout" if options is None else "mesh"
        self._store.fail(trouble, cause, options, pointed)

    def _failed(self, error: Exception) -> None:
        self._store.fail(error, "mesh")

    def _forget(self, old: SessionState, new: SessionState) -> None:
        """Wait no longer for a solution that fails to come, nor be silent on what is new."""
        hidden = old.layers["layout"].visible and not new.layers["layout"].visible
        if hidden or new.field is not old.field:
            self._told = None
        said = new.message
        failed = said is not None and (said.severity == "error" or said.stopped)
        if (failed and said is not old.message) or _surface(new) is not _surface(old):
            self._next = None


def _surface(state: SessionState) -> TriSurface | None:
    return None if state.document is None else state.document.surface
