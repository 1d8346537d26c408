"""From a problem to its solution in stages, each computed once and kept."""

from __future__ import annotations

import time
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TypeVar

import numpy as np

from crossview.cases.model import Case
from crossview.workflow.layout import require_possible
from crossview.workflow.methods import integrate, isotropic_map, with_map
from crossview.workflow.problem import Problem, problems_of
from crossview.workflow.sizes import read_sizes, refined_sizes
from crossview.workflow.solution import Solution
from solvers.errors import CrossviewError
from solvers.fields import (
    AlignedField,
    CrossField,
    FieldStep,
    IntegratedField,
    IsotropicSolver,
    Limits,
    PreparedSurface,
    field_existence,
    judge,
    prepare,
)
from solvers.layouts import in_joining_gauge, joined_field
from solvers.maps import MappedField, with_possible_turns
from solvers.progress import Progress, between
from solvers.singularities import require_budget, require_places
from solvers.surface import FloatArray

__all__ = ["Pipeline", "Solution", "of_component", "solve_case"]

T = TypeVar("T")
Solving = Generator[Progress, None, Solution]


class Pipeline:
    """Solves problems one after the other and keeps what the next one can use."""

    def __init__(self) -> None:
        self._prepared: PreparedSurface | None = None
        self._problem: Problem | None = None
        self._kept: dict[str, Solution] = {}
        self._aligned: AlignedField | None = None
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
        require_places(problem.surface, problem.singularities)
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
            prepared = self._prepared_for(problem)
        yield Progress("factorising", 0.1)
        with _timed(seconds, "factor"):
            solver = prepared.operators.solver
        if problem.method == "isotropic":
            yield Progress("solving", 0.6)
            with _timed(seconds, "solve"):
                solver = in_joining_gauge(solver, prepared.singularities)
                field = solver.solve(prepared.singularities)
            limits = _limits(problem, solver)
            yield Progress("fitting the seamless map", 0.7)
            with _timed(seconds, "map"):
                mapped = isotropic_map(prepared, field, limits)
            yield Progress("judging", 0.9)
            solution = _solution(problem, prepared, solver, field, limits, seconds, None, mapped)
        else:
            yield Progress("aligning with the boundaries", 0.2)
            with _timed(seconds, "align"):
                if self._aligned is None:
                    self._aligned = joined_field(prepared, problem.options.turns)
                    if problem.options.turns is None:
                        self._aligned = with_possible_turns(self._aligned)
            finer = None if sizes is None else refined_sizes(sizes, prepared.refinement)
            solution = yield from _integrated(self._aligned, problem, finer, seconds)
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
        if self._problem is None:
            raise CrossviewError("nothing has been solved yet")
        integrated = step.so_far
        limits = _limits(self._problem, integrated.aligned.solver)
        mapped = with_map(integrated, limits)
        return _integrated_solution(self._problem, integrated, mapped, limits, {})

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

    def _prepared_for(self, problem: Problem) -> PreparedSurface:
        """The surface prepared for a problem, the last one's if it serves; forgets old results."""
        before, self._problem = self._problem, problem
        if self._prepared is not None and before is not None and problem.same_places(before):
            self._prepared = self._prepared.with_valences(problem.singularities)
        else:
            self._prepared = prepare(
                problem.surface,
                problem.singularities,
                refine=problem.options.refine,
                corners=problem.chosen_corners,
                features=problem.features,
            )
        if before is None or not problem.same_but_method(before):
            self._kept, self._aligned = {}, None
        return self._prepared


def _integrated(
    aligned: AlignedField, problem: Problem, sizes: FloatArray | None, seconds: dict[str, float]
) -> Solving:
    """Solve by a method that starts from the aligned field."""
    limits = _limits(problem, aligned.solver)
    iteration = integrate(problem.method, aligned, problem.options, sizes, limits)
    with _timed(seconds, "solve"):
        solved = yield from between(iteration, 0.3, 0.9)
    yield Progress("judging", 0.9)
    return _integrated_solution(problem, solved.integrated, solved.mapped, limits, seconds)


@contextmanager
def of_component(number: int | None) -> Iterator[None]:
    """Name the component in what goes wrong; None: there is only one."""
    try:
        yield
    except CrossviewError as error:
        if number is not None:
            error.locate(f"component {number}")
        raise


def solve_case(case: Case, quads: bool = False) -> Generator[Progress, None, tuple[Solution, ...]]:
    """Read a case and solve it.

    Parameters
    ----------
    case : Case
    quads : bool
        Whether quads are wanted: what topology forbids is refused before any solve.

    Returns
    -------
    tuple of Solution
        One, or if the case asks for all components one for each, the largest first.

    Raises
    ------
    CrossviewError
        As `problems_of` and `Pipeline.solve`, or quads are wanted and impossible.
    """
    yield Progress("reading the surface", 0.0)
    seconds: dict[str, float] = {}
    with _timed(seconds, "read"):
        problems = problems_of(case)
    solutions = []
    for number, problem in enumerate(problems):
        with of_component(number if len(problems) > 1 else None):
            if quads:
                require_possible(problem)
            solution = yield from Pipeline().solve(problem)
        solutions.append(replace(solution, seconds={**seconds, **solution.seconds}))
    return tuple(solutions)


def _limits(problem: Problem, solver: IsotropicSolver) -> Limits:
    """Within which the options of a problem call a field valid."""
    return Limits.on(solver.holonomy, float(np.radians(problem.options.tolerance_degrees)))


def _integrated_solution(
    problem: Problem,
    integrated: IntegratedField,
    mapped: MappedField | None,
    limits: Limits,
    seconds: dict[str, float],
) -> Solution:
    aligned, field = integrated.aligned, integrated.field
    return _solution(
        problem, aligned.prepared, aligned.solver, field, limits, seconds, integrated, mapped
    )


def _solution(
    problem: Problem,
    prepared: PreparedSurface,
    solver: IsotropicSolver,
    field: CrossField,
    limits: Limits,
    seconds: dict[str, float],
    integrated: IntegratedField | None = None,
    mapped: MappedField | None = None,
) -> Solution:
    """Put together what a method found with the holonomy and the verdict."""
    with _timed(seconds, "holonomy"):
        defects = solver.holonomy.defects(prepared.singularities)
    with _timed(seconds, "verdict"):
        inverted = None if mapped is None else len(mapped.map.inverted)
        wound = 0 if mapped is None else len(mapped.map.wrong_windings)
        known = None if integrated is None else field_existence(integrated.aligned)
        verdict = judge(field, inverted, limits, wrong_windings=wound, known=known)
    return Solution(
        problem,
        prepared,
        solver,
        field,
        defects,
        seconds,
        integrated,
        limits,
        verdict,
        mapped,
    )


@contextmanager
def _timed(seconds: dict[str, float], stage: str) -> Iterator[None]:
    start = time.perf_counter()
    yield
    seconds[stage] = time.perf_counter() - start
