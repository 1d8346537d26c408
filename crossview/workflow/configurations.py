"""Problems whose singularities are placed anew: natural ones, completed, moved to validity."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from crossview.workflow.problem import Problem
from crossview.workflow.sizes import read_sizes
from solvers import Progress
from solvers.fields import (
    CURVATURE_WEIGHT,
    MOST_VALENCE,
    NATURAL_ALIGNMENTS,
    NATURAL_METHODS,
    IsotropicSolver,
    natural_singularities,
)
from solvers.layouts import NearMisses, Snapped, holding, join, nearly_connected
from solvers.layouts import snap as moved_to_meet
from solvers.singularities import require_budget
from solvers.validity import Improved, Moved, missing_singularities
from solvers.validity import improve as moved_to_even_sizes
from solvers.validity import make_valid as moved_to_validity
from solvers.validity import simplify as merged_to_fewer

Placing = Generator[Progress, None, Problem]

CROWDED = 2.0
"""Mean edges between singularities, below which the triangles say where they are. Chosen."""


def natural(
    problem: Problem,
    method: str = NATURAL_METHODS[0],
    seed: int = 0,
    *,
    alignment: str = NATURAL_ALIGNMENTS[0],
    weight: float = CURVATURE_WEIGHT,
    most_valence: int = MOST_VALENCE,
    fewest: bool = False,
    most: int | None = None,
    scale: float | None = None,
) -> Placing:
    """Put the singularities of a smooth cross-field in place of a problem's, with its own corners.

    Parameters
    ----------
    problem : Problem
    method, seed, alignment, weight, most_valence, fewest, most, scale
        As of `solvers.fields.natural_singularities`.

    Raises
    ------
    CrossviewError
        As `solvers.fields.natural_singularities`.
    """
    bare = replace(problem, singularities=(), corners=None, connections=())
    singularities = yield from natural_singularities(
        bare.surface,
        method,
        seed,
        alignment=alignment,
        weight=weight,
        features=bare.features,
        most_valence=most_valence,
        fewest=fewest,
        most=most,
        scale=scale,
    )
    require_budget(bare.surface, singularities, bare.chosen_corners)
    return replace(bare, singularities=singularities)


def crowded(problem: Problem) -> int:
    """Return how many singularities are as near to another as the surface's edges are long.

    Their places are those of its triangles: zeros of a field that a finer surface would move, or
    make one. The globally optimal field of a disk has all four there.

    Parameters
    ----------
    problem : Problem
    """
    places = problem.surface.positions([s.point for s in problem.singularities])
    if len(places) < 2:
        return 0
    corners = problem.surface.vertices[problem.surface.edges]
    edge = float(np.linalg.norm(corners[:, 0] - corners[:, 1], axis=1).mean())
    nearest = cKDTree(places).query(places, k=2)[0][:, 1]
    return int((nearest < CROWDED * edge).sum())


def complete(problem: Problem) -> Placing:
    """Add the valences 3 or 5 that the index budget lacks, after those there are.

    Raises
    ------
    CrossviewError
        As `solvers.validity.missing_singularities`.
    """
    yield Progress("preparing the surface", 0.1)
    solver = IsotropicSolver(problem.surface, problem.corners)
    added = yield from missing_singularities(solver, problem.singularities)
    return replace(problem, singularities=(*problem.singularities, *added))


def make_valid(problem: Problem) -> Generator[Progress, None, tuple[Problem, Moved]]:
    """Move the unlocked singularities until every holonomy defect vanishes, those joined so again.

    Returns
    -------
    Problem
    Moved
        The last step of the way: its defects, and the layout that was aimed at.

    Raises
    ------
    SingularityError
        As `solvers.validity.make_valid`, or as `solvers.layouts.join`.
    """
    end = yield from moved_to_validity(
        problem.surface,
        problem.singularities,
        problem.corners,
        problem.options.refine,
        features=problem.features,
    )
    if problem.connections:
        valid = replace(problem, singularities=end.singularities)
        valid, joined = yield from connect(valid)
        return valid, replace(joined, aim=end.aim)
    return replace(problem, singularities=end.singularities), end


def improve(problem: Problem) -> Generator[Progress, None, tuple[Problem, Improved]]:
    """Move the unlocked singularities until sizes are most even, or nearest to the size map.

    Those joined stay so. Of two sizes at a vertex the geometric mean counts.

    Returns
    -------
    Problem
    Improved
        The last step of the way: its sizes beside those before.

    Raises
    ------
    SingularityError
        As `solvers.validity.improve`.
    """
    sizes = problem.options.sizes
    wanted = None if sizes is None else read_sizes(sizes, problem.surface.n_vertices)
    hold = None
    if problem.connections:
        problem, _ = yield from connect(problem)
        hold = holding(problem.connections, problem.options.refine)
    end = yield from moved_to_even_sizes(
        problem.surface,
        problem.singularities,
        problem.corners,
        problem.options.refine,
        wanted=wanted if wanted is None or wanted.ndim == 1 else np.sqrt(wanted.prod(axis=1)),
        features=problem.features,
        hold=hold,
    )
    return replace(problem, singularities=end.singularities), end


def snap(problem: Problem) -> Generator[Progress, None, tuple[Problem, Snapped]]:
    """Move the unlocked singularities until separatrices meet what they nearly meet.

    Returns
    -------
    Problem
        With those that are joined now as its connections.
    Snapped
        The last step of the way: which singularities are joined.

    Raises
    ------
    SingularityError
        As `solvers.layouts.snap`.
    """
    end = yield from moved_to_meet(
        problem.surface,
        problem.singularities,
        problem.corners,
        problem.options.refine,
        features=problem.features,
        kept=problem.connections,
    )
    pairs = tuple((a, b) for a, b in end.connections.tolist())
    return replace(problem, singularities=end.singularities, connections=pairs), end


def connect(problem: Problem) -> Generator[Progress, None, tuple[Problem, Snapped]]:
    """Move the unlocked singularities until its connections hold.

    Returns
    -------
    Problem
    Snapped
        The last step of the way.

    Raises
    ------
    SingularityError
        As `solvers.layouts.join`.
    """
    end = yield from join(
        problem.surface,
        problem.singularities,
        problem.connections,
        problem.corners,
        problem.options.refine,
        features=problem.features,
    )
    return replace(problem, singularities=end.singularities), end


def near_misses(problem: Problem) -> Generator[Progress, None, NearMisses]:
    """What `snap` would join beside what is.

    Raises
    ------
    SingularityError
        As `solvers.layouts.nearly_connected`.
    """
    return nearly_connected(
        problem.surface,
        problem.singularities,
        problem.corners,
        problem.options.refine,
        features=problem.features,
        kept=problem.connections,
    )


def simplify(
    problem: Problem, most: int, *, most_valence: int = MOST_VALENCE
) -> Generator[Progress, None, tuple[Problem, Moved]]:
    """Merge unlocked singularities until no more than some are left, and make those valid.

    Parameters
    ----------
    problem : Problem
    most, most_valence
        As of `solvers.validity.simplify`.

    Returns
    -------
    Problem
    Moved
        The last step of the way to validity.

    Raises
    ------
    SingularityError
        As `solvers.validity.simplify`.
    """
    end = yield from merged_to_fewer(
        problem.surface,
        problem.singularities,
        most,
        problem.corners,
        problem.options.refine,
        features=problem.features,
        most_valence=most_valence,
    )
    return replace(problem, singularities=end.singularities, connections=()), end
