"""Whether any quad mesh has given singularities and corners: decided by topology alone.

A quad mesh is a flat metric whose cone angles are whole quarter turns, with holonomy in quarter
turns and a boundary along its axes: a quartic differential, real on the boundary, with a zero of
order -k where the index is k. The question is whether there is one, of any shape.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Literal

import numpy as np

from solvers.errors import SingularityError
from solvers.number_checks import whole_number, whole_numbers
from solvers.remedies import Remedy
from solvers.singularities.budget import (
    Singularity,
    checked_corners,
    checked_singularities,
    index_budget,
)
from solvers.singularities.remedies import AddPair, ChangeCorners, ChangeTurns
from solvers.singularities.theorems import (
    ANNULUS_TURNS,
    BUDGET,
    EMPTY_STRATUM,
    FLAT_ANNULUS,
    FLAT_TORUS,
    TORUS_PAIR,
    ZIGZAG,
    Theorem,
)
from solvers.surface.trisurface import TriSurface

Answer = Literal["possible", "impossible", "undecided"]


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


def decide(
    genus: int,
    boundaries: Sequence[Sequence[int]],
    indices: Iterable[int],
    turns: Sequence[int] | None = None,
) -> tuple[Answer, Theorem | None]:
    """Decide whether any quad mesh has given indices, on any surface of a topology.

    Parameters
    ----------
    genus : int
        Number of handles.
    boundaries : sequence of sequence of int
        The indices of the corners of each boundary loop, in the order in which the loop meets them
        with the surface on its left; zeros are regular.
    indices : iterable of int
        Of the singularities inside; zeros are regular.
    turns : sequence of int, optional
        Quarter turns, counterclockwise, of the crosses against each handle loop, then against a
        path to each further boundary, from a place before the first corner of the first boundary
        to one before the first corner of the further one. By default any.

    Returns
    -------
    answer : {"possible", "impossible", "undecided"}
        "undecided" only where turns are given.
    theorem : Theorem or None
        What forbids it.

    Raises
    ------
    SingularityError
        An index is none of a point inside, or of a corner.

    Notes
    -----
    Spheres and disks have no holonomy, so that the budget is enough: the quartic differential
    prod (z - z_i)^-k_i dz^4 is there, at any places. On a torus Abel's theorem asks that
    sum k_i z_i is a period, which distinct points can meet unless the indices are 1 and -1. On
    closed surfaces of higher genus no stratum of quartic differentials with such orders is empty
    (Jucovic and Trenkler 1973 for valences from 3; Gendron and Tahar 2022 in general).

    An annulus is conformally a cylinder. Let T(phi) be the turns along the path across it at the
    angle phi, whole numbers that jump by k where a singularity or a corner is passed. Integrating
    the conjugate of H over paths gives that the mean of T over phi is zero, and any such T has its
    field. Without singularities T is ``turns`` plus the sums of corners passed on the one boundary
    less those on the other, and the mean of such sums may be anything between their extremes: of
    corners + - + - ... opposite a straight boundary between 0 and 1, never whole.

    Surfaces with more boundaries or with handles: the indices are doubled and the double is a
    closed surface, of genus 2 at least. All small square-tiled surfaces were enumerated; the only
    budget without any is that whose double has the orders 6 and 2 and quadratic holonomy.

    Examples
    --------
    >>> from solvers.singularities import decide
    >>> answer, theorem = decide(1, [], [1, -1, 0])
    >>> print(answer, theorem)
    impossible No quadrangulation of a torus has one valence 3, one valence 5 and nothing else (...
    >>> decide(0, [[1, -1, 1, -1], []], [])[0], decide(0, [[1, 1, -1, -1], []], [])[0]
    ('impossible', 'possible')
    >>> decide(0, [[1, 1, -1, -1], []], [], turns=[1])[0]
    'impossible'
    """
    inside = sorted(_checked("a singularity", indices, 3))
    loops = [_checked("a corner", loop, 1) for loop in boundaries]
    given = None
    if turns is not None:
        given = whole_numbers("turns", turns, (None,), error=SingularityError).tolist()
    budget = 4 * (2 - 2 * genus - len(loops))
    if sum(inside) + sum(map(sum, loops)) != budget:
        return "impossible", BUDGET
    match genus, len(loops):
        case 0, 0 | 1:
            return "possible", None
        case 1, 0:
            return _on_torus(inside, given)
        case 0, 2:
            return _on_annulus(loops, inside, given)
        case 0, 3 if not inside and sorted(map(sorted, loops)) == [[], [], [-3, -1]]:
            return "impossible", EMPTY_STRATUM
        case _:
            return ("possible" if given is None else "undecided"), None


def _checked(of: str, indices: Iterable[int], most: int) -> list[int]:
    """Return the indices that are not 0."""
    whole = (
        whole_number(f"the index of {of}", k, most=most, error=SingularityError) for k in indices
    )
    return [k for k in whole if k]


def _on_torus(inside: Sequence[int], turns: Sequence[int] | None) -> tuple[Answer, Theorem | None]:
    if not inside and any(turns or ()):
        return "impossible", FLAT_TORUS
    if inside == [-1, 1]:
        return "impossible", TORUS_PAIR
    # Two points of indices k and -k differ by a period over k, which must be no period itself.
    return ("possible" if turns is None or len(inside) != 2 else "undecided"), None


def _on_annulus(
    loops: Sequence[Sequence[int]], inside: Sequence[int], turns: Sequence[int] | None
) -> tuple[Answer, Theorem | None]:
    sums = _sums(loops)
    if inside or sums[0][-1]:  # one singularity, or boundary, turned about the axis: any mean
        return "possible", None
    if not any(loops):
        return ("impossible", FLAT_ANNULUS) if any(turns or ()) else ("possible", None)
    low, high = _span(sums)
    if high - low < 2:
        return "impossible", ZIGZAG
    if turns is None or low < turns[-1] < high:
        return "possible", None
    return "impossible", ANNULUS_TURNS


def _sums(loops: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return the sums of the corners passed on each boundary, from none on."""
    return [[0, *accumulate(loop)] for loop in loops]


def _span(sums: Sequence[Sequence[int]]) -> tuple[int, int]:
    """Return between which numbers the turns from the one boundary to the other must be."""
    return min(sums[1]) - max(sums[0]), max(sums[1]) - min(sums[0])


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
        As of `decide`, from behind the first vertex of each boundary loop; they count where there
        are no singularities. Where there are no corners either, they are those over each holonomy
        condition besides those nearest to the isotropic field.

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
    index = np.zeros(surface.n_vertices, dtype=np.int64)
    index[list(turning)] = list(turning.values())
    around = [np.roll(index[loop], -1) for loop in surface.boundary_loops]
    loops = [along[along != 0].tolist() for along in around]
    answer, theorem = decide(surface.genus, loops, indices, None if indices else turns)
    remedies: tuple[Remedy, ...] = ()
    if theorem is BUDGET:
        remedies = index_budget(surface, placed, turning).remedies
    elif theorem is FLAT_TORUS or theorem is FLAT_ANNULUS:
        remedies = (ChangeTurns.of(-n for n in turns or ()),)
    elif theorem is ANNULUS_TURNS and turns:
        low, high = _span(_sums(loops))
        remedies = (ChangeTurns.of([min(max(turns[0], low + 1), high - 1) - turns[0]]), AddPair())
    elif theorem is ZIGZAG:
        remedies = (AddPair(), ChangeCorners.none_of(turning))
    elif theorem is not None:
        remedies = (AddPair(),)
    return Existence(answer, theorem, remedies)
