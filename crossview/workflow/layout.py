"""From a solution to its separatrices and its quad layout."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from crossview.workflow.solution import Solution
from solvers.errors import CrossviewError
from solvers.fields.aligned import IntegratedField, aligned_field
from solvers.layouts.errors import LayoutError
from solvers.layouts.layout import QuadLayout, quad_layout
from solvers.layouts.separatrices import Separatrices
from solvers.progress import Progress
from solvers.remedies import ANISOTROPIC, MAKE_VALID, Remedy
from solvers.surface.triangulation import FloatArray, IntArray

SOON = 50_000
"""Triangles up to which a layout takes seconds at most."""


def layout(solution: Solution) -> Generator[Progress, None, QuadLayout]:
    """Cut the surface of a solution into rectangles along its separatrices.

    Raises
    ------
    LayoutError
        The field misses a boundary or is not integrable, there is no quad mesh with these
        singularities, or triangles are turned over in the map.
    """
    _require_possible(solution)
    yield Progress("aligning with the boundaries", 0.0)
    return (yield from quad_layout(_integrated(solution)))


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
    tolerance = np.radians(solution.problem.options.tolerance_degrees)
    loops = np.flatnonzero(np.abs(solution.field.boundary_misalignment) > tolerance)
    surface = solution.surface
    first = np.array([surface.boundary_loops[i][0] for i in loops], dtype=np.int64)
    return loops, surface.vertices[first].reshape(-1, 3)


def _require_possible(solution: Solution) -> None:
    """Refuse what no map can mend; the layout itself judges integrability."""
    loops, _ = misaligned_boundaries(solution)
    if len(loops):
        misses = "a boundary" if len(loops) == 1 else f"{len(loops)} boundaries"
        raise _misses(misses, solution.field.boundary_misalignment, MAKE_VALID, ANISOTROPIC)
    if solution.verdict.status in ("impossible", "unknown"):
        reason = solution.verdict.reason.rstrip(".")
        raise LayoutError(f"no quads: {reason}", remedies=solution.verdict.remedies)
    off = np.abs(np.degrees(solution.field.feature_misalignment))
    missed = np.count_nonzero(off > solution.problem.options.tolerance_degrees)
    if missed:
        misses = "a feature curve" if missed == 1 else f"{missed} feature curves"
        raise _misses(misses, solution.field.feature_misalignment, ANISOTROPIC)


def _misses(what: str, angles: FloatArray, *remedies: Remedy) -> LayoutError:
    worst = np.degrees(np.abs(angles).max())
    return LayoutError(f"the field misses {what}, by up to {worst:.3g} degrees", remedies=remedies)


def _integrated(solution: Solution) -> IntegratedField:
    """The field in a form that has a map; an isotropic one may have to be solved again."""
    if solution.integrated is not None:
        return solution.integrated
    aligned = aligned_field(solution.prepared, like=solution.field)
    return IntegratedField(aligned, aligned.start)
