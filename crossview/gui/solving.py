"""Keeps solution, kept factor and cut graph in step with the document, in the background."""

from __future__ import annotations

from collections.abc import Callable, Generator
from functools import partial
from typing import TypeVar

from crossview.gui.background import Background
from crossview.gui.state import Message
from crossview.gui.store import Store
from crossview.pipeline import Pipeline, Solution
from crossview.session.live import LiveBase, LiveEdit, cut, prepare, solve
from solvers.crossfield import CrossField
from solvers.progress import Progress

T = TypeVar("T")


class Solving:
    """Runs jobs for a store and puts their results into its state."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._pipeline = Pipeline()
        self._background = Background(store)
        self._background.progressed.connect(lambda progress: store.set(progress=progress))
        self._background.stopped.connect(self._stopped)

    @property
    def busy(self) -> bool:
        """Whether an answer is still awaited."""
        return self._background.busy

    def run(
        self,
        job: Callable[[], Generator[Progress, None, T]],
        done: Callable[[T], None],
        fail: Callable[[Exception], None],
    ) -> None:
        """Run any job in place of what runs now."""
        self._background.submit(job, done, fail)

    def follow(self) -> None:
        """Drop what was asked before and bring the results in line with the present document."""
        self._background.forget()
        self._store.clear_message("solve")
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
            self.run(partial(solve, self._pipeline, document.problem), self._show, self._failed)

    def resume(self) -> None:
        """Go on with what another job has displaced."""
        if not self._store.state.solved:
            self.follow()

    def try_out(self, edit: LiveEdit) -> None:
        """Show the field of an edit on the kept factor; one that has none yet shows none."""
        self.run(edit.solve, self._show_live, lambda error: None)

    def cut_if_wanted(self) -> None:
        """Compute the cut graph when its layer is visible and it is not there yet."""
        state = self._store.state
        solution = state.solution
        if solution is None or state.cut_graph is not None or not state.layers["cut"].visible:
            return
        if not self.busy:  # else it is asked again when the solution has come
            self.run(
                partial(cut, solution),
                lambda edges: self._store.set(cut_graph=edges),
                self._failed,
            )

    def stop(self) -> None:
        """Stop; what is shown stays."""
        self._background.stop()

    def close(self) -> None:
        """End the background thread."""
        self._background.close()

    def _show(self, solution: Solution) -> None:
        self._store.clear_message("solve")
        base = LiveBase.from_solution(solution)
        self._store.set(solution=solution, base=base, field=solution.field, cut_graph=None)
        self.cut_if_wanted()

    def _show_live(self, field: CrossField) -> None:
        self._store.set(field=field, cut_graph=None)

    def _failed(self, error: Exception) -> None:
        self._store.set(solution=None, field=None, cut_graph=None)
        self._store.fail(error, "solve")

    def _stopped(self) -> None:
        self._store.set(message=Message("Stopped; what was there is kept", "solve", "info"))
