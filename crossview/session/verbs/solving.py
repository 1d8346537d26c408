"""Keeps solution, kept factor and cut graph in step with the document, in the background."""

from __future__ import annotations

from collections.abc import Callable, Generator
from functools import partial
from typing import TypeVar

from crossview.session.background import Background
from crossview.session.live import LiveBase, LiveEdit, cut, prepare
from crossview.session.live_tracer import LiveTracer, Traced
from crossview.session.loop import Loop
from crossview.session.message import Message
from crossview.session.method_solver import MethodSolver
from crossview.session.shown import Solved
from crossview.session.store import Store
from crossview.view.texts import energy
from solvers.progress import Progress
from solvers.surface import IntArray

T = TypeVar("T")

MOST_KEPT = 1_000_000
"""Triangles of all solutions that are kept for undo. Chosen: with their factors about 2 GB."""

STARTING = "starting"
"""Stage of a job that has told of none yet."""

STILL = 0.15
"""How long the mouse is still before separatrices left out in a drag are traced, seconds."""


class Solving:
    """Runs jobs for a store and puts their results into its state.

    Parameters
    ----------
    store : Store
    loop : Loop
        The thread that results are put in on.
    """

    def __init__(self, store: Store, loop: Loop) -> None:
        self._store = store
        self._solver = MethodSolver()
        self._background = Background(loop, self._progressed)
        # what follows the mouse waits for nothing that takes a while to stop
        self._live = Background(loop)
        self._when_stopped: Callable[[], None] = self._say_stopped
        self._pursuits: list[Callable[[], bool]] = [self._cut]
        self._tracer = LiveTracer()
        self._kept: list[Solved] = []
        self._still = loop.timer(STILL, self._trace_live)

    @property
    def busy(self) -> bool:
        """Whether an answer is still awaited."""
        return self._background.busy or self._live.busy

    def run(
        self,
        job: Callable[[], Generator[Progress, None, T]],
        done: Callable[[T], None],
        fail: Callable[[Exception], None],
        stopped: Callable[[], None] | None = None,
        first: str = STARTING,
    ) -> None:
        """Run any job in place of what runs now; `stopped` is called if the user stops it.

        `first` is the stage until the job tells another.
        """
        self._when_stopped = stopped or self._say_stopped
        self._leave_live()
        self._background.submit(job, done, fail)
        # it can be stopped from now on, long before it tells of itself
        state = self._store.state.work_ended().unsaid("stop")
        self._store.update(state.progressed(Progress(first, 0.0)))

    def follow(self) -> None:
        """Drop what was asked before and bring the results in line with the present document.

        What was solved for this very document before is shown at once.
        """
        self._keep(self._store.state.last)
        self._background.forget()
        self._leave_live()
        self._store.update(self._store.state.work_ended().unsaid("solve", "stop"))
        document, base = self._store.state.document, self._store.state.base
        if document is None:
            return
        kept = next((one for one in self._kept if one.solution.problem is document.problem), None)
        if kept is not None:
            self._show(kept)
        elif document.budget.satisfied:
            self.solve()
        elif base is None:
            self.run(partial(prepare, document), self._show_base, self._failed)

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
        if self._background.busy:
            self._background.forget()
        self._run_live(partial(self._tracer.follow, edit, traced))

    def pursue_also(self, pursuit: Callable[[], bool]) -> None:
        """Let `pursuit` start something, and say whether it did, when there is time for it."""
        self._pursuits.append(pursuit)

    def pursue(self) -> None:
        """Start one thing that is wanted and not there yet; each calls again when it is done."""
        if not self.busy:  # else it is asked again when the answer has come
            any(pursuit() for pursuit in self._pursuits)

    def stop(self) -> None:
        """Stop at the user's wish; what is shown stays."""
        if self.busy:
            self._background.forget()
            self._leave_live()
            self._when_stopped()

    def close(self) -> None:
        """End the background threads."""
        self._still.stop()
        self._live.close()
        self._background.close()

    def restore(self) -> None:
        """Show the present document's own field again, after a job that has shown others."""
        self._store.update(self._store.state.put_back())
        self.resume()

    def _progressed(self, progress: Progress | None) -> None:
        self._store.update(self._store.state.progressed(progress))

    def _show_base(self, base: LiveBase) -> None:
        self._store.update(self._store.state.base_prepared(base))

    def _show(self, solved: Solved) -> None:
        self._store.update(self._store.state.solution_found(solved))
        self.pursue()

    def _keep(self, solved: Solved | None) -> None:
        """Keep a solution for undo, the newest first, as many as memory should bear."""
        if solved is None:
            return
        others = [one for one in self._kept if one.solution is not solved.solution]
        self._kept, triangles = [], 0
        for one in (solved, *others):
            triangles += len(one.base.surface.faces)
            if triangles <= MOST_KEPT or not self._kept:
                self._kept.append(one)

    def _cut(self) -> bool:
        """Compute the cut graph when its layer is visible and it is not there yet."""
        state, shown = self._store.state, self._store.state.shown
        wanted = state.layers["cut"].visible
        if not wanted or not isinstance(shown, Solved) or shown.cut_graph is not None:
            return False
        solution = shown.solution

        def show(edges: IntArray) -> None:
            self._store.update(self._store.state.cut_along(solution, edges))
            self.pursue()

        self.run(partial(cut, solution), show, self._failed)
        return True

    def _run_live(self, job: Callable[[], Generator[Progress, None, Traced]]) -> None:
        self._still.stop()
        self._live.submit(job, self._show_live, lambda error: None)

    def _leave_live(self) -> None:
        """Show no more of what follows the mouse."""
        self._still.stop()
        self._live.forget()

    def _show_live(self, traced: Traced) -> None:
        self._store.update(self._store.state.field_tried(traced))
        if traced.separatrices is None and self._store.state.layers["separatrices"].visible:
            self._still.start()

    def _trace_live(self) -> None:
        """Trace what was left out for speed, now that the mouse is still."""
        state = self._store.state
        if state.trial is not None and state.field is not None and not self.busy:
            self._run_live(partial(self._tracer.catch_up, state.field))

    def _failed(self, error: Exception) -> None:
        self._store.update(self._store.state.no_solution())
        self._store.fail(error, "solve")

    def _keep_iterate(self) -> None:
        """Make the last iterate of a stopped solve its result, and say that it is no more."""
        iterating = self._store.state.iterating
        if iterating is None:
            self._say_stopped()
            return

        def show(solved: Solved) -> None:
            self._show(solved)
            reached = energy(solved.solution.field.energy)
            text = f"Stopped: the last iterate is kept, not converged (E = {reached})"
            message = Message(text, "solve", "info", stopped=True)
            self._store.update(self._store.state.said(message))

        self.run(partial(self._solver.keep, iterating.step), show, self._failed)

    def _say_stopped(self) -> None:
        text = "Stopped; what was there is kept"
        message = Message(text, "stop", "info", stopped=True)
        self._store.update(self._store.state.said(message))
