"""From a configuration to a valid one of fewer singularities."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping
from dataclasses import replace

import numpy as np

from solvers.features.edges import Features, no_features
from solvers.features.regions import in_one_region
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.merging import Merging, fewer_refused
from solvers.fields.placement import MOST_VALENCE
from solvers.number_checks import whole_number
from solvers.progress import Progress
from solvers.singularities.budget import Singularity, checked_singularities, require_budget
from solvers.surface.refinement import LEVELS
from solvers.surface.triangulation import IntArray
from solvers.surface.trisurface import TriSurface
from solvers.validity.attempts import make_valid
from solvers.validity.search import Moved


def simplify(
    surface: TriSurface,
    singularities: Iterable[Singularity],
    most: int,
    corners: Mapping[int, int] | None = None,
    levels: int = LEVELS,
    *,
    features: Features | None = None,
    most_valence: int = MOST_VALENCE,
) -> Generator[Progress, None, Moved]:
    """Merge singularities until no more than some are left, and make those valid.

    Opposite ones cancel and equal ones are merged, those first by which the energy rises least;
    then all that are not locked move as `make_valid` has it.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        A configuration that meets the index budget; those locked stay what and where they are.
    most : int
        How many may be left.
    corners : mapping of int to int, optional
        As for `IsotropicSolver`.
    levels : int, optional
        Of refinement at the singularities, for the final check.
    features : Features, optional
        Of the surface; none on them is merged, none across them, and none crosses one.
    most_valence : int, optional
        Of what is merged, 5 or more.

    Returns
    -------
    Moved
        The valid configuration, verified by a fresh operator; the result of the computation, for
        `solvers.run`.

    Raises
    ------
    SingularityError
        If the index budget is missed, or so few cannot be left; it says why.
    ValidityError
        As `make_valid`.

    Examples
    --------
    On a sphere a valence 6 and two valences 3 beside it leave the eight that it needs:

    >>> from solvers import run
    >>> from solvers.primitives import sphere
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import simplify
    >>> surface = sphere(subdivisions=3)
    >>> cube = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    >>> more = [([0, 0, 1], 6), ([0.2, 0, 1], 3), ([-0.2, 0, 1], 3)]
    >>> placed = [*((x, 3) for x in cube), *more]
    >>> start = [Singularity(surface.closest_point(x), valence) for x, valence in placed]
    >>> end = run(simplify(surface, start, 8))
    >>> [s.valence for s in end.singularities]
    [3, 3, 3, 3, 3, 3, 3, 3]
    """
    start = checked_singularities(singularities)
    most = whole_number("the number of singularities", most, 0)
    most_valence = whole_number("the most valence", most_valence, 5)
    along = no_features(surface) if features is None else features.require_on(surface)
    yield Progress("preparing the surface", 0.0)
    solver = IsotropicSolver(surface, corners)
    require_budget(surface, start, solver.corners)
    free = np.array([not s.locked for s in start], dtype=bool)
    may = in_one_region(along, [s.point for s in start]) & free[:, None] & free
    yield Progress("merging", 0.1)
    merging = Merging(solver, start)
    if not merging.reduce(may, most, most_valence):
        raise fewer_refused(len(merging), most, most_valence)
    left = tuple(
        replace(s, valence=4 - index)
        for s, index in zip(start, np.rint(merging.index).astype(int).tolist(), strict=True)
        if index or s.locked
    )
    return (yield from make_valid(surface, left, corners, levels, features=along))


def fewest_left(
    singularities: Iterable[Singularity],
    features: Features,
    *,
    most_valence: int = MOST_VALENCE,
) -> int:
    """Return how many singularities `simplify` leaves at the least, by their indices alone.

    Parameters
    ----------
    singularities : iterable of Singularity
        On a surface.
    features : Features
        Of the surface.
    most_valence : int, optional
        As of `simplify`.

    Returns
    -------
    int
        In which order they are merged may leave more.

    Raises
    ------
    SingularityError
        If one is no singularity.

    Notes
    -----
    Opposite indices cancel until all within a region between features have the sign of their sum;
    above zero none of them grows, below zero each may grow to the most valence.

    Examples
    --------
    >>> from solvers.features import no_features
    >>> from solvers.primitives import sphere
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import fewest_left
    >>> surface = sphere(subdivisions=2)
    >>> placed = [Singularity(surface.point_at_vertex(i), 3 if i < 9 else 5) for i in range(10)]
    >>> fewest_left(placed, no_features(surface))
    8
    """
    given = checked_singularities(singularities)
    index = np.array([s.index for s in given], dtype=np.int64)
    may = np.ones((len(given), len(given)), dtype=bool)
    if len(features):
        may = in_one_region(features, [s.point for s in given])
    free = may.diagonal() & ~np.array([s.locked for s in given], dtype=bool)
    region = may.argmax(axis=1) if len(given) else index
    groups = [index[free & (region == number)] for number in np.unique(region[free])]
    return int(np.count_nonzero(index[~free])) + sum(
        _fewest(group, most_valence - 4) for group in groups
    )


def _fewest(index: IntArray, largest: int) -> int:
    """Return how many of some indices are left at the least; negative ones grow."""
    total = int(index.sum())
    if not total:
        return 0
    sizes = np.sort(np.abs(index[index * total > 0]))[::-1]
    if total < 0:
        sizes = np.maximum(sizes, largest)
    return 1 + int(np.searchsorted(np.cumsum(sizes), abs(total)))
