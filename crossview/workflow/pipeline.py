"""From a problem to its solution in stages, each computed once and kept."""

from __future__ import annotations

import time
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TypeVar

import numpy as np

from crossview.cases.model import Case
from crossview.workflow.methods import growth_when_refined, integrate, inverted_triangles
from crossview.workflow.problem import Problem, problems_of
from crossview.workflow.sizes import read_sizes, refined_sizes
from crossview.workflow.solution import Solution, Stage
from solvers.errors import CrossviewError
from solvers.fields.aligned import IntegratedField
from solvers.fields.crossfield import CrossField
from solvers.fields.integrable import FieldStep
from solvers.fields.verdict import judge
from solvers.progress import Progress, between
from solvers.singularities.budget import require_budget
from solvers.surface.refinement import refine_at
from solvers.surface.triangulation import FloatArray

__all__ = ["Pipeline", "Solution", "of_component", "solve_case"]

T = TypeVar("T")
Solving = Generator[Progress, None, Solution]


class Pipeline:
    """Solves problems one after the other and keeps what the next one can use."""

    def __init__(self) -> None:
        self._stage: Stage | None = None
        self._problem: Problem | None = None
        self._kept: dict[str, Solution] = {}
        self._sizes: FloatArray | None = None  # of the last anisotropic solution

    def solve(self, problem: Problem) -> Solving:
        """Solve in stages; refined surface and factors are kept while only valences change.

        The last solution by each method is kept too while nothing else changes. The methods that
        iterate yield a `FieldStep` for each iteration.

        Raises
        ------
        CrossviewError
            The index budget is missed, a singularity is on the boundary, two coincide, the turns
            are too many or too few, or the size map is wrong.
        """
        require_budget(problem.surface, problem.singularities, problem.chosen_corners)
        wanted = problem.options.sizes if problem.method == "anisotropic" else None
        sizes = None if wanted is None else read_sizes(wanted, problem.surface.n_vertices)
        kept = self._kept_by(problem, sizes)
        if kept is not None:
            self._problem = problem
            return replace(kept, problem=problem)
        seconds: dict[str, float] = {}
        yield Progress("refining at the singularities", 0.0)
        with _timed(seconds, "refine"):
            stage = self._prepared(problem)
        yield Progress("factorising", 0.1)
        isotropic = problem.method == "isotropic"
        with _timed(seconds, "factor"):
            stage.solver(flips=isotropic)
        if isotropic:
            yield Progress("solving", 0.6)
            with _timed(seconds, "solve"):
                field = stage.solver_for(problem, flips=True).solve(stage.placed(problem))
            yield Progress("checking the holonomy", 0.8)
            solution = _solution(stage, problem, field, seconds)
        else:
            finer = None if sizes is None else refined_sizes(sizes, stage.refinement)
            solution = yield from _integrated(stage, problem, finer, seconds)
            self._sizes = sizes if problem.method == "anisotropic" else self._sizes
        self._kept[problem.method] = solution
        return solution

    def so_far(self, step: FieldStep) -> Solution:
        """A solution, not converged, of an iteration that the running `solve` has shown.

        Raises
        ------
        CrossviewError
            There has been none.
        """
        if self._stage is None or self._problem is None:
            raise CrossviewError("nothing has been solved yet")
        return _solution(self._stage, self._problem, step.so_far, {})

    @property
    def stage(self) -> Stage | None:
        """The refined surface of the last `solve`, or of the one that runs."""
        return self._stage

    def _kept_by(self, problem: Problem, sizes: FloatArray | None) -> Solution | None:
        """The last solution of this very problem by its method."""
        kept = self._kept.get(problem.method)
        if kept is None or not problem.same_but_method(kept.problem):
            return None
        if sizes is None:
            return kept
        # the file may have changed
        same = self._sizes is not None and np.array_equal(sizes, self._sizes)
        return kept if same else None

    def _prepared(self, problem: Problem) -> Stage:
        """The stage for a problem, the last one if it serves; forgets what has become wrong."""
        before, self._problem = self._problem, problem
        if self._stage is None or not self._stage.serves(problem):
            points = [s.point for s in problem.singularities]
            refinement = refine_at(
                problem.surface, points, problem.options.refine, problem.features.edges
            )
            self._stage = Stage(problem, refinement)
        if before is None or not problem.same_but_method(before):
            self._kept = {}
        return self._stage


def _integrated(
    stage: Stage, problem: Problem, sizes: FloatArray | None, seconds: dict[str, float]
) -> Solving:
    """Solve by a method that starts from the aligned field."""
    yield Progress("aligning with the boundaries", 0.2)
    options = problem.options
    with _timed(seconds, "align"):
        aligned = stage.aligned(problem)
    iteration = integrate(problem.method, aligned, options, sizes)
    with _timed(seconds, "solve"):
        integrated = yield from between(iteration, 0.3, 0.6 if options.verify else 0.9)
    growth = None
    if options.verify and problem.method != "aligned":
        with _timed(seconds, "verify"):
            again = growth_when_refined(integrated, options, sizes)
            growth = yield from between(again, 0.6, 0.9)
    yield Progress("judging", 0.9)
    return _solution(stage, problem, integrated, seconds, growth)


@contextmanager
def of_component(number: int | None) -> Iterator[None]:
    """Name the component in what goes wrong; None: there is only one."""
    try:
        yield
    except CrossviewError as error:
        if number is not None:
            error.locate(f"component {number}")
        raise


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
    for number, problem in enumerate(problems):
        with of_component(number if len(problems) > 1 else None):
            solution = yield from Pipeline().solve(problem)
        solutions.append(replace(solution, seconds={**seconds, **solution.seconds}))
    return tuple(solutions)


def _solution(
    stage: Stage,
    problem: Problem,
    found: CrossField | IntegratedField,
    seconds: dict[str, float],
    growth: float | None = None,
) -> Solution:
    """Put together what a method found with the holonomy and the verdict."""
    integrated = found if isinstance(found, IntegratedField) else None
    field = found if isinstance(found, CrossField) else found.field
    solver = stage.solver_for(problem, flips=integrated is None)
    singularities = stage.placed(problem)
    with _timed(seconds, "holonomy"):
        defects = solver.holonomy.defects(singularities)
    with _timed(seconds, "verdict"):
        tolerance = float(np.radians(problem.options.tolerance_degrees))
        inverted = inverted_triangles(integrated)
        verdict = judge(field, inverted, growth, tolerance)
    return Solution(
        problem,
        stage.refinement,
        solver,
        singularities,
        field,
        defects,
        seconds,
        integrated,
        verdict,
        growth,
        inverted,
    )


@contextmanager
def _timed(seconds: dict[str, float], stage: str) -> Iterator[None]:
    start = time.perf_counter()
    yield
    seconds[stage] = time.perf_counter() - start
