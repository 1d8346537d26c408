"""From a problem to its solution in stages, each computed once and kept."""

from __future__ import annotations

import time
from collections.abc import Generator, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from crossview.case import Case
from crossview.problem import Problem, problems_of
from solvers.crossfield import CrossField
from solvers.errors import SingularityError
from solvers.isotropic import IsotropicSolver
from solvers.progress import Progress
from solvers.refinement import Refinement, refine_at
from solvers.singularities import Singularity, index_budget
from solvers.surface import TriSurface
from solvers.triangulation import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Solution:
    """A solved problem.

    Attributes
    ----------
    problem : Problem
    refinement : Refinement
        The surface solved on: refined around the singularities, which are vertices of it.
    solver : IsotropicSolver
        Keeps the factorisation of that surface.
    singularities : tuple of Singularity
        On the refined surface, in the order of the problem's.
    field : CrossField
    holonomy_defects : (2 g + max(b - 1, 0),) float array
        Radians in (-pi/4, pi/4], in the order of ``solver.holonomy.conditions``.
    seconds : mapping of str to float
        Time of each stage; next to nothing for one that was kept.
    """

    problem: Problem
    refinement: Refinement
    solver: IsotropicSolver
    singularities: tuple[Singularity, ...]
    field: CrossField
    holonomy_defects: FloatArray
    seconds: Mapping[str, float]

    @property
    def surface(self) -> TriSurface:
        """The refined surface that was solved on."""
        return self.refinement.surface

    @cached_property
    def cut_graph(self) -> IntArray:
        """(k, 2) vertex pairs of `surface` that cut it to a disk and meet every singularity."""
        return self.solver.cut_graph(self.singularities)

    @property
    def valid(self) -> bool:
        """Whether every holonomy defect is below the tolerance (the budget holds if solved)."""
        tolerance = np.radians(self.problem.options.tolerance_degrees)
        return bool((np.abs(self.holonomy_defects) < tolerance).all())


class Pipeline:
    """Solves problems one after the other and keeps what the next one can use."""

    def __init__(self) -> None:
        self._last: Solution | None = None

    def solve(self, problem: Problem) -> Generator[Progress, None, Solution]:
        """Solve in stages; refined surface and factor are kept while only valences change.

        Raises
        ------
        SingularityError
            The index budget is missed, a singularity is on the boundary, or two coincide.
        """
        _require_budget(problem)
        seconds: dict[str, float] = {}
        kept = self._kept(problem)
        yield Progress("refining at the singularities", 0.0)
        with _timed(seconds, "refine"):
            refinement = kept.refinement if kept else _refined(problem)
        yield Progress("factorising", 0.1)
        with _timed(seconds, "factor"):
            # refinement keeps the numbers of vertices, so the corners stay where they are
            solver = (
                kept.solver if kept else IsotropicSolver(refinement.surface, problem.chosen_corners)
            )
        yield Progress("solving", 0.6)
        with _timed(seconds, "solve"):
            singularities = tuple(
                replace(s, point=refinement.surface.point_at_vertex(int(vertex)))
                for s, vertex in zip(problem.singularities, refinement.vertices, strict=True)
            )
            field = solver.solve(singularities)
        yield Progress("checking the holonomy", 0.8)
        with _timed(seconds, "holonomy"):
            defects = solver.holonomy.defects(singularities)
        self._last = Solution(problem, refinement, solver, singularities, field, defects, seconds)
        return self._last

    def _kept(self, problem: Problem) -> Solution | None:
        """The last solution if its refined surface and factor serve this problem too."""
        if self._last is None:
            return None
        before = self._last.problem
        same = (
            before.surface is problem.surface
            and before.options.refine == problem.options.refine
            and [s.point for s in before.singularities] == [s.point for s in problem.singularities]
            and before.chosen_corners == problem.chosen_corners
        )
        return self._last if same else None


def solve_case(case: Case) -> Generator[Progress, None, tuple[Solution, ...]]:
    """Read a case and solve it.

    Returns
    -------
    tuple of Solution
        One, or if the case asks for all components one for each, the largest first.
    """
    yield Progress("reading the surface", 0.0)
    seconds: dict[str, float] = {}
    with _timed(seconds, "read"):
        problems = problems_of(case)
    solutions = []
    for problem in problems:
        solution = yield from Pipeline().solve(problem)
        solutions.append(replace(solution, seconds={**seconds, **solution.seconds}))
    return tuple(solutions)


def _require_budget(problem: Problem) -> None:
    """Refuse a missed index budget before anything is computed."""
    budget = index_budget(problem.surface, problem.singularities, problem.chosen_corners)
    if not budget.satisfied:
        raise SingularityError(
            f"the singularities miss the index budget, {budget.index_sum} of {budget.required}",
            remedy=" or ".join(budget.remedies),
        )


def _refined(problem: Problem) -> Refinement:
    points = [s.point for s in problem.singularities]
    return refine_at(problem.surface, points, problem.options.refine)


@contextmanager
def _timed(seconds: dict[str, float], stage: str) -> Iterator[None]:
    start = time.perf_counter()
    yield
    seconds[stage] = time.perf_counter() - start
