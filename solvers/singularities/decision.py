"""What topology says of a surface's singularities and corners, and the nearest possible ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from solvers.remedies import Remedy
from solvers.singularities.budget import (
    Singularity,
    checked_corners,
    checked_singularities,
    corner_indices,
    index_budget,
)
from solvers.singularities.remedies import AddPair, ChangeCorners, ChangeTurns
from solvers.singularities.theorems import BUDGET, ZIGZAG, Theorem
from solvers.singularities.topology import Answer, decide
from solvers.surface.trisurface import TriSurface

FEW = 4
"""Turns of which several are changed at once for the nearest that are possible. Chosen."""


@dataclass(frozen=True)
class Existence:
    """Whether a quad mesh exists, by topology.

    Parameters
    ----------
    answer : {"possible", "impossible", "undecided"}
        "undecided" where no theorem is known either way.
    theorem : Theorem, optional
        What forbids it, where it is impossible.
    remedies : tuple of Remedy, optional
        What leads to the nearest configurations that are possible.

    Examples
    --------
    >>> from solvers.primitives import torus
    >>> from solvers.singularities import existence
    >>> found = existence(torus(n=12), [], {}, turns=[0, 1])
    >>> found.answer, [remedy.words for remedy in found.remedies]
    ('impossible', ['change the turns by 0, -1'])
    """

    answer: Answer
    theorem: Theorem | None = None
    remedies: tuple[Remedy, ...] = ()


def existence(
    surface: TriSurface,
    singularities: Iterable[Singularity],
    corners: Mapping[int, int],
    turns: Sequence[int] | None = None,
) -> Existence:
    """Decide whether any surface of this topology has quads with such singularities and corners.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        The singularities inside, wherever they are.
    corners : mapping of int to int
        Index of the corners, by boundary vertex.
    turns : sequence of int, optional
        As of `decide`, from behind the first vertex of each boundary loop. Without singularities
        and corners they are those over each holonomy condition.

    Returns
    -------
    Existence
        The answer, why, and the nearest configurations that are possible.

    Raises
    ------
    SingularityError
        If a singularity or a corner is something else.

    Examples
    --------
    >>> from solvers.primitives import torus
    >>> from solvers.singularities import Singularity, existence
    >>> surface = torus(n=12)
    >>> pair = [Singularity(surface.point_at_vertex(v), n) for v, n in ((0, 3), (40, 5))]
    >>> found = existence(surface, pair, {})
    >>> found.answer, [remedy.words for remedy in found.remedies]
    ('impossible', ['add a pair of valences 3 and 5'])
    >>> existence(surface, [], {}, turns=[1, 0]).remedies[0].by
    (-1, 0)
    """
    placed = checked_singularities(singularities)
    turning = {vertex: k for vertex, k in checked_corners(surface, corners).items() if k}
    indices = [s.index for s in placed if s.index]
    loops = corner_indices(surface, turning)
    genus = surface.genus
    answer, theorem = decide(genus, loops, indices, turns)
    remedies: tuple[Remedy, ...] = ()
    if theorem is BUDGET:
        remedies = index_budget(surface, placed, turning).remedies
    elif theorem is ZIGZAG:
        remedies = (AddPair(), ChangeCorners.none_of(turning))
    elif theorem is not None:
        nearest = () if turns is None else nearest_turns(genus, loops, indices, turns)
        remedies = (*nearest, AddPair()) if any(loops) or indices else nearest
    return Existence(answer, theorem, remedies)


def nearest_turns(
    genus: int,
    boundaries: Sequence[Sequence[int]],
    indices: Sequence[int],
    turns: Sequence[int],
) -> tuple[ChangeTurns, ...]:
    """Return the least change of turns that makes what is impossible possible, if there is one.

    Parameters
    ----------
    genus, boundaries, indices, turns
        As of `decide`.

    Returns
    -------
    tuple of ChangeTurns
        One or none.
    """
    t = np.array(turns, dtype=np.int64)
    reach = int(np.abs(t).max(initial=0)) + sum(abs(k) for loop in boundaries for k in loop) + 1
    changes = [-t, *(n * row for row in np.eye(len(t), dtype=np.int64) for n in _steps(reach))]
    if len(t) <= FEW:
        changes += [np.array(by) for by in product(range(-2, 3), repeat=len(t))]
    for by in sorted(changes, key=lambda by: int(np.abs(by).sum())):
        if decide(genus, boundaries, indices, (t + by).tolist())[0] != "impossible":
            return (ChangeTurns.of(by.tolist()),)
    return ()


def _steps(reach: int) -> list[int]:
    """Return the numbers but 0 up to one, either sign."""
    return [n for n in range(-reach, reach + 1) if n]
