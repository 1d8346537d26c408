"""Keeps solution, kept factor and cut graph in step with the document, in the background."""

from __future__ import annotations

from collections.abc import Callable, Generator
from functools import partial
from typing import Any, TypeVar

from PySide6.QtCore import QTimer

from crossview.gui.background import Background
from crossview.gui.state import Message
from crossview.gui.store import Store
from crossview.session.live import LiveBase, LiveEdit, cut, prepare
from crossview.session.meshes import Meshes
from crossview.session.methods import Iterate, MethodSolver, Solved
from crossview.session.moving import Moving
from crossview.session.tracing import LiveTracer, Traced
from crossview.view.texts import energy
from solvers.progress import Progress
from solvers.surface.triangulation import IntArray

T = TypeVar("T")

STILL_MS = 150
"""How long the mouse is still before separatrices left out in a drag are traced."""


class Solving:
    """Runs jobs for a store and puts their results into its state."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._solver = MethodSolver()
        self._background = Background(store)
        self._background.progressed.connect(self._progressed)
        self._background.stopped.connect(lambda: self._when_stopped())
        self._when_stopped: Callable[[], None] = self._say_stopped
        self._pursuits: list[Callable[[], bool]] = [self._cut]
        self._tracer = LiveTracer()
        self._still = QTimer(store)
        self._still.setSingleShot(True)
        self._still.setInterval(STILL_MS)
        self._still.timeout.connect(self._trace_live)

    @property
    def busy(self) -> bool:
        """Whether an answer is still awaited."""
        return self._background.busy

    def run(
        self,
        job: Callable[[], Generator[Progress, None, T]],
        done: Callable[[T], None],
        fail: Callable[[Exception], None],
        stopped: Callable[[], None] | None = None,
    ) -> None:
        """Run any job in place of what runs now; `stopped` is called if the user stops it."""
        self._still.stop()
        self._when_stopped = stopped or self._say_stopped
        self._store.clear_message("stop")
        self._store.set(iterate=None, moving=None)
        self._background.submit(job, done, fail)

    def follow(self) -> None:
        """Drop what was asked before and bring the results in line with the present document."""
        self._background.forget()
        self._store.set(iterate=None)
        self._store.clear_message("solve")
        self._store.clear_message("stop")
        document, base = self._store.state.document, self._store.state.base
        if document is None:
            return
        if document.budget.satisfied:
            self.solve()
        elif base is None:
            job = partial(prepare, document)
            self.run(job, lambda made: self._store.set(base=made), self._failed)

    def solve(self) -> None:
        """Solve the present document with refinement, if its index budget holds."""
        document = self._store.state.document
        if document is not None and document.budget.satisfied:
            job = partial(self._solver.solve, document.problem)
            self.run(job, self._show, self._failed, self._keep_iterate)

    def resume(self) -> None:
        """Go on with what another job has displaced."""
        if self._store.state.solved:
            self.pursue()
        else:
            self.follow()

    def try_out(self, edit: LiveEdit) -> None:
        """Show the field of an edit on the kept factor; one that has none yet shows none."""
        traced = self._store.state.layers["separatrices"].visible
        job = partial(self._tracer.follow, edit, traced)
        self.run(job, self._show_live, lambda error: None)

    def pursue_also(self, pursuit: Callable[[], bool]) -> None:
        """Let `pursuit` start something, and say whether it did, when there is time for it."""
        self._pursuits.append(pursuit)

    def pursue(self) -> None:
        """Start one thing that is wanted and not there yet; each calls again when it is done."""
        if not self.busy:  # else it is asked again when the answer has come
            any(pursuit() for pursuit in self._pursuits)

    def stop(self) -> None:
        """Stop; what is shown stays."""
        self._background.stop()

    def close(self) -> None:
        """End the background thread."""
        self._still.stop()
        self._background.close()

    def restore(self) -> None:
        """Show the present document's own field again, after a job that has shown others."""
        state = self._store.state
        if state.solution is not None and state.solved:
            base = state.base or LiveBase.from_solution(state.solution)
            self._store.set(field=state.solution.field, base=base, cut_graph=None)
            self.pursue()
        else:
            self._store.set(field=None, cut_graph=None)
            self.follow()

    def _progressed(self, progress: Progress | None) -> None:
        changes: dict[str, Any] = {"progress": progress}
        if progress is None:
            changes["moving"] = None
        elif isinstance(progress, Iterate):
            changes |= {"iterate": progress, "start": progress.start}
            if progress.field is not None:
                changes |= {"field": progress.field, "base": progress.base, "cut_graph": None}
        elif isinstance(progress, Moving):
            changes["moving"] = progress
            if progress.field is not None:
                changes |= {"field": progress.field, "cut_graph": None}
                base = self._store.state.base
                if base is not None and base.surface is not progress.field.surface:
                    changes["base"] = None  # the field is of the surface before refinement
        self._store.set(**changes)

    def _show(self, solved: Solved) -> None:
        self._store.clear_message("solve")
        solution = solved.solution
        self._store.set(
            solution=solution,
            base=LiveBase.from_solution(solution),
            field=solution.field,
            start=solved.start,
            iterate=None,
            cut_graph=None,
        )
        self.pursue()

    def _cut(self) -> bool:
        """Compute the cut graph when its layer is visible and it is not there yet."""
        state = self._store.state
        solution = state.solution
        if solution is None or state.cut_graph is not None or not state.layers["cut"].visible:
            return False

        def show(edges: IntArray) -> None:
            self._store.set(cut_graph=edges)
            self.pursue()

        self.run(partial(cut, solution), show, self._failed)
        return True

    def _show_live(self, traced: Traced) -> None:
        changes: dict[str, Any] = {"field": traced.field, "cut_graph": None}
        if traced.separatrices is not None:
            changes["meshes"] = Meshes(traced.field, traced.separatrices)
        self._store.set(**changes)
        if traced.separatrices is None and self._store.state.layers["separatrices"].visible:
            self._still.start()

    def _trace_live(self) -> None:
        """Trace what was left out for speed, now that the mouse is still."""
        state = self._store.state
        if state.trial is not None and state.field is not None and not self.busy:
            self.run(
                partial(self._tracer.catch_up, state.field),
                self._show_live,
                lambda error: None,
            )

    def _failed(self, error: Exception) -> None:
        self._store.set(solution=None, field=None, start=None, iterate=None, cut_graph=None)
        self._store.fail(error, "solve")

    def _keep_iterate(self) -> None:
        """Make the last iterate of a stopped solve its result, and say that it is no more."""
        iterate = self._store.state.iterate
        if iterate is None:
            self._say_stopped()
            return

        def show(solved: Solved) -> None:
            self._show(solved)
            reached = energy(solved.solution.field.energy)
            text = f"Stopped: the last iterate is kept, not converged (E = {reached})"
            self._store.set(message=Message(text, "solve", "info", stopped=True))

        self.run(partial(self._solver.keep, iterate.step), show, self._failed)

    def _say_stopped(self) -> None:
        text = "Stopped; what was there is kept"
        self._store.set(message=Message(text, "stop", "info", stopped=True))
