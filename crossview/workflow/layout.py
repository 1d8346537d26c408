"""From a solution to its separatrices and its quad layout."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from crossview.workflow.problem import Problem
from crossview.workflow.solution import Solution
from solvers.errors import CrossviewError
from solvers.layouts import LayoutError, QuadLayout, Separatrices, quad_layout
from solvers.progress import Progress
from solvers.singularities import existence, require_budget
from solvers.surface import BoolArray, FloatArray, IntArray

SOON = 50_000
"""Triangles up to which a layout takes seconds at most."""


def require_possible(problem: Problem) -> None:
    """Refuse a problem that no quad mesh solves, by topology alone.

    Raises
    ------
    SingularityError
        It misses the index budget.
    LayoutError
        It names the theorem and what leads to the nearest problem that is possible.
    """
    surface, placed, corners = problem.surface, problem.singularities, problem.chosen_corners
    require_budget(surface, placed, corners)
    known = existence(surface, placed, corners, problem.known_turns)
    if known.theorem is not None:
        raise LayoutError(f"no quads: {str(known.theorem).rstrip('.')}", remedies=known.remedies)


def layout(solution: Solution) -> Generator[Progress, None, QuadLayout]:
    """Cut the surface of a solution into rectangles along its separatrices.

    Raises
    ------
    LayoutError
        The field misses a boundary or is not integrable, there is no quad mesh with these
        singularities, or triangles are inverted in the map.
    """
    mapped = solution.mapped
    integrated = solution.integrated if mapped is None else mapped.integrated
    if solution.verdict.refused or integrated is None:
        raise _refusal(solution)
    yield Progress("aligning with the boundaries", 0.0)
    fit = None if mapped is None else mapped.fit
    return (yield from quad_layout(integrated, solution.verdict, fit))


def layout_soon(solution: Solution) -> Generator[Progress, None, QuadLayout | None]:
    """The layout of a solution where it has one and that takes seconds at most, else None."""
    if solution.surface.n_faces > SOON:
        return None
    try:
        return (yield from layout(solution))
    except CrossviewError:
        return None


def separatrices(solution: Solution, layout: QuadLayout | None) -> Separatrices:
    """The separatrices of a solution: exact those of its layout, else near those of its field."""
    return solution.separatrices if layout is None else layout.separatrices


def misaligned_boundaries(solution: Solution) -> tuple[IntArray, FloatArray]:
    """The boundaries that the field is not aligned with.

    Returns
    -------
    loops : (k,) int array
        Numbers in ``solution.surface.boundary_loops``.
    places : (k, 3) float array
        A point on each, for a mark.
    """
    loops = np.flatnonzero(solution.limits.missed(solution.field.boundary_misalignment))
    surface = solution.surface
    first = np.array([surface.boundary_loops[i][0] for i in loops], dtype=np.int64)
    return loops, surface.vertices[first].reshape(-1, 3)


def _refusal(solution: Solution) -> LayoutError:
    """Why the verdict refuses it; boundaries and curves that the field misses are counted."""
    verdict, field = solution.verdict, solution.field
    missed = solution.limits.missed
    boundaries, curves = missed(field.boundary_misalignment), missed(field.feature_misalignment)
    what = f"no quads: {verdict.reason.rstrip('.')}"
    if verdict.status == "impossible" or not verdict.remedies:
        pass
    elif boundaries.any():
        what = _misses(boundaries, "a boundary", "boundaries", field.boundary_misalignment)
    elif curves.any() and not missed(field.defects).any():
        what = _misses(curves, "a feature curve", "feature curves", field.feature_misalignment)
    return LayoutError(what, remedies=verdict.remedies)


def _misses(missed: BoolArray, one: str, many: str, angles: FloatArray) -> str:
    count, worst = np.count_nonzero(missed), np.degrees(np.abs(angles).max())
    which = one if count == 1 else f"{count} {many}"
    return f"the field misses {which}, by up to {worst:.3g} degrees"
