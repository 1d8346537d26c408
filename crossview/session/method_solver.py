"""Solving by any method, with iterates that can be drawn as it goes."""

from __future__ import annotations

import time
from collections.abc import Generator
from dataclasses import dataclass

from crossview.session.live import LiveBase, with_directions
from crossview.session.shown import Solved
from crossview.view.meshes import triangles_of
from crossview.workflow.pipeline import Pipeline, Solution
from crossview.workflow.problem import Problem
from solvers.fields import AlignedField, CrossField, FieldStep, IntegratedField
from solvers.progress import Progress, relayed

DRAWN_EVERY = 0.2
"""Least time between two iterates that are drawn, seconds."""


@dataclass(frozen=True, eq=False)
class MethodStep(Progress):
    """An iteration of a method, perhaps with what is to be drawn.

    Parameters
    ----------
    stage, fraction
        As in `Progress`.
    step : FieldStep
        The iteration; nothing of its field has been computed if `field` is None.
    base : LiveBase
        What it is solved on.
    start : CrossField
        The field before the first iteration.
    field : CrossField or None
        The field now; None soon after another that is drawn.
    """

    step: FieldStep
    base: LiveBase
    start: CrossField
    field: CrossField | None


class MethodSolver:
    """A pipeline whose results are ready to be drawn: nothing is left to another thread."""

    def __init__(self) -> None:
        self._pipeline = Pipeline()
        self._start: tuple[AlignedField, CrossField] | None = None

    def solve(self, problem: Problem) -> Generator[Progress, None, Solved]:
        """Solve with refinement by the problem's method; yields a `MethodStep` per iteration."""
        base: LiveBase | None = None
        drawn = -DRAWN_EVERY

        def show(step: Progress) -> Progress:
            nonlocal base, drawn
            if not isinstance(step, FieldStep):
                return step
            aligned = step.so_far.aligned
            base = base or LiveBase(aligned.prepared.refinement, aligned.solver, problem.marking)
            field = None
            if time.monotonic() - drawn >= DRAWN_EVERY:
                field = with_directions(step.so_far.field)
                drawn = time.monotonic()
            start = self._start_of(aligned)
            return MethodStep(step.stage, step.fraction, step, base, start, field)

        return self._ready((yield from relayed(self._pipeline.solve(problem), show)))

    def keep(self, step: FieldStep) -> Generator[Progress, None, Solved]:
        """Make what there is of a stopped `solve` its result, not converged."""
        yield Progress("keeping the last iterate", 0.9)
        return self._ready(self._pipeline.so_far(step))

    def _ready(self, solution: Solution) -> Solved:
        with_directions(solution.field)
        base, start = LiveBase.from_solution(solution), None
        triangles_of(base.surface)  # drawn at once then
        if solution.integrated is not None:
            start = self._start_of(solution.integrated.aligned)
        return Solved(solution, start, base)

    def _start_of(self, aligned: AlignedField) -> CrossField:
        if self._start is None or self._start[0] is not aligned:
            start = IntegratedField(aligned, aligned.start).field
            self._start = (aligned, with_directions(start))
        return self._start[1]
