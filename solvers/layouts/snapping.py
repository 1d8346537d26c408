"""Singularities moved until separatrices that nearly meet others do: saddle connections.

Each is one real equation more beside the holonomy defects. Newton's method solves all of them by
the least moves; the fresh field of each step tells how far off they are. Those that hold already
are kept; what would take more than a little, or more freedom than there is, is left out.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from solvers.errors import SingularityError
from solvers.features.edges import Features, no_features
from solvers.fields.isotropic import IsotropicSolver
from solvers.layouts.saddle_connections import (
    NEAR,
    STEPS,
    Configuration,
    Connected,
    Places,
)
from solvers.progress import Progress
from solvers.singularities.budget import Singularity, checked_singularities, require_budget
from solvers.singularities.connections import Connections
from solvers.surface.refinement import LEVELS
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface
from solvers.validity.attempts import make_valid
from solvers.validity.constrained_moves import Blocked, ConstrainedMoves
from solvers.validity.search import TOLERANCE, Moved, Search

KEPT = 0.75
"""Share of the connections that are tried again where all of them are too much. Chosen."""


@dataclass(frozen=True, kw_only=True)
class Snapped(Moved):
    """A step on the way to separatrices that meet singularities; the last is the result.

    Parameters
    ----------
    stage : str
        As in `Progress`.
    fraction : float
        As in `Progress`.
    singularities : tuple of Singularity
        Where they are.
    defects : (c,) float array
        Their holonomy defects, radians.
    turns : tuple of int
        As in `Moved`: no turns.
    aim : str
        As in `Moved`; empty.
    start : tuple of Singularity
        The valid configuration that was started from.
    connections : (p, 2) int array
        The singularities that separatrices are to join, the lower number of each two first.
    misses : (p,) float array
        By how much it does not, radians.

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.layouts import Snapped, snap
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0.03, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> way = []
    >>> end = run(snap(surface, threes), way.append)
    >>> bool(end.misses.max() < 0.002 < max(s.misses.max() for s in way if isinstance(s, Snapped)))
    True
    """

    start: Places
    connections: IntArray
    misses: FloatArray


def snap(
    surface: TriSurface,
    singularities: Iterable[Singularity],
    corners: Mapping[int, int] | None = None,
    levels: int = LEVELS,
    *,
    features: Features | None = None,
    kept: Connections = (),
) -> Generator[Progress, None, Snapped]:
    """Move the unlocked singularities until separatrices meet what they nearly meet.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        A configuration that meets the index budget; if it is not valid it is made valid first.
    corners : mapping of int to int, optional
        As for `IsotropicSolver`.
    levels : int, optional
        Of refinement at the singularities.
    features : Features, optional
        Of the surface. No singularity crosses one, and one on a feature stays.
    kept : tuple of (int, int), optional
        Those that are joined in any case, as the pairs of `join`.

    Returns
    -------
    Snapped
        The valid configuration, verified by a fresh operator, and which singularities are joined;
        the result of the computation, for `solvers.run`.

    Raises
    ------
    SingularityError
        If the index budget is missed, no singularity is free to move, no separatrix can be made to
        meet another singularity, or those kept cannot be.
    ValidityError
        As `make_valid`.

    Examples
    --------
    Four valences 3 on a disk, one off the corner of their square:

    >>> from solvers import run
    >>> from solvers.layouts import snap
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0.03, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> end = run(snap(surface, threes))
    >>> sorted(sorted(pair) for pair in end.connections.tolist())
    [[0, 1], [0, 3], [1, 2], [2, 3]]
    """
    first = yield from configuration(surface, singularities, corners, levels, features)
    yield Progress("looking for near misses", 0.0)
    held = first.between(kept)
    wanted = first.near_misses(held)
    while len(wanted):
        end = yield from _met(first, wanted, corners)
        if end is not None:
            # What was wanted may have become one way over another singularity.
            reached, defects = end[0].base, end[1]
            joined = Connected(reached, reached.connections(reached.between(kept)))
            return _told("valid", 1.0, joined, defects, first.singularities)
        fewer = int(KEPT * len(wanted))
        wanted = wanted[: max(fewer, len(held)) if len(wanted) > len(held) else 0]
    if len(held):
        raise _not_together()
    raise SingularityError(
        "no separatrix can be made to meet a singularity that it misses",
        f"by less than {np.degrees(NEAR):.0f} degrees, with small moves of those that may",
        "move some nearer, or unlock some",
    )


def join(
    surface: TriSurface,
    singularities: Iterable[Singularity],
    pairs: Connections,
    corners: Mapping[int, int] | None = None,
    levels: int = LEVELS,
    *,
    features: Features | None = None,
) -> Generator[Progress, None, Snapped]:
    """Move the unlocked singularities until separatrices join given pairs of them.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        As for `snap`.
    pairs : tuple of (int, int)
        Numbers of singularities, from 0; of two the separatrices that miss least are meant, as
        many as the pair is given often.
    corners : mapping of int to int, optional
        As for `IsotropicSolver`.
    levels : int, optional
        Of refinement at the singularities.
    features : Features, optional
        As for `snap`.

    Returns
    -------
    Snapped
        The valid configuration, verified by a fresh operator; the result of the computation, for
        `solvers.run`.

    Raises
    ------
    SingularityError
        If the index budget is missed, no singularity is free to move, separatrices of a pair miss
        by 5 degrees or more, or not all pairs can be joined.
    ValidityError
        As `make_valid`.

    Examples
    --------
    Of four valences 3 on a disk one is taken to where a line from its neighbour meets it:

    >>> from solvers import run
    >>> from solvers.layouts import join
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0.03, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> end = run(join(surface, threes, ((0, 1),)))
    >>> end.connections.tolist(), bool(end.misses.max() < 0.009)
    ([[0, 1]], True)
    """
    first = yield from configuration(surface, singularities, corners, levels, features)
    yield Progress("looking for near misses", 0.0)
    end = yield from _met(first, first.between(pairs), corners)
    if end is None:
        raise _not_together()
    return _told("valid", 1.0, *end, first.singularities)


def configuration(
    surface: TriSurface,
    singularities: Iterable[Singularity],
    corners: Mapping[int, int] | None,
    levels: int,
    features: Features | None,
) -> Generator[Progress, None, Configuration]:
    """Return the valid configuration to start from; it is refused where nothing may move."""
    start = checked_singularities(singularities)
    solver = IsotropicSolver(surface, corners)
    require_budget(surface, start, solver.corners)
    along = no_features(surface) if features is None else features.require_on(surface)
    moves = ConstrainedMoves(surface, solver.holonomy, start, along)
    if not moves.free.any():
        raise SingularityError(
            "no singularity may move", advice="unlock some" if start else "add some"
        )
    if np.abs(solver.holonomy.defects(start)).max(initial=0.0) > TOLERANCE:
        valid = yield from make_valid(surface, start, corners, levels, features=along)
        start = valid.singularities
    return Configuration(solver, moves, levels, start)


def _met(
    first: Configuration, wanted: IntArray, corners: Mapping[int, int] | None
) -> Generator[Progress, None, tuple[Connected, FloatArray] | None]:
    """Move the singularities until the wanted passings are none, and verify their defects."""
    start, at = first.singularities, Connected(first, wanted)
    for step, reached in enumerate(at.steps()):
        at = reached
        yield _told("snapping", 0.9 * step / STEPS, at, at.base.defects, start)
    if not at.met:
        return None
    moves = first.moves
    search = Search(moves.surface, moves.guide, start, moves.features)
    try:
        end = yield from search.verify(at.singularities, at.turns, corners, first.levels)
    except Blocked:
        return None
    found = at.followed(end.singularities, np.zeros((len(start), 2)))
    return None if found is None else (found, end.defects)


def _not_together() -> SingularityError:
    return SingularityError(
        "the connections between singularities cannot all be kept",
        "with small moves of those that may",
        "let some connections go, or unlock some",
    )


def _told(stage: str, done: float, at: Connected, defects: FloatArray, start: Places) -> Snapped:
    return Snapped(
        stage,
        done,
        at.singularities,
        defects,
        at.turns,
        start=start,
        connections=at.pairs,
        misses=at.passings.angles,
    )
