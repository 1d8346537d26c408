"""Tools that keep the index sum: pairs added, singularities merged and split."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from solvers.errors import SingularityError
from solvers.number_checks import real_number, whole_number
from solvers.singularities.budget import Singularity, checked_singularities
from solvers.surface.geodesics import straightest
from solvers.surface.points import SurfacePoint
from solvers.surface.trisurface import TriSurface

APART = 0.04
"""How far the two of a pair are put apart, in square roots of the surface's area. Chosen."""

DIRECTIONS = 12
"""How many directions, in half a turn, are tried for one that leaves the most room. Chosen."""


def pair_at(
    surface: TriSurface,
    singularities: Iterable[Singularity],
    point: SurfacePoint,
    apart: float | None = None,
) -> tuple[Singularity, Singularity]:
    """Return a valence 3 and a valence 5 around a place, for the sum of indices to stay.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        What is there; the pair keeps away from them and from the boundary.
    point : SurfacePoint
        The middle of the pair.
    apart : float, optional
        How far, in units of length; by default two mean edges, at least `APART`.

    Returns
    -------
    tuple of 2 Singularity
        The valence 3, the valence 5.

    Raises
    ------
    SingularityError
        There is no room.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import pair_at
    >>> surface = disk(edge_length=0.1)
    >>> pair = pair_at(surface, [], surface.closest_point([0.3, 0.0, 0.0]), apart=0.2)
    >>> [s.valence for s in pair], sum(s.index for s in pair)
    ([3, 5], 0)
    >>> first, second = surface.positions([s.point for s in pair])
    >>> round(float(np.linalg.norm(first - second)), 6)
    0.2
    """
    first, second = _ends(surface, checked_singularities(singularities), point, apart)
    return Singularity(first, 3), Singularity(second, 5)


def merged(
    surface: TriSurface, singularities: Iterable[Singularity], one: int, other: int
) -> tuple[Singularity, ...]:
    """Return the configuration with two singularities made one, the sum of indices kept.

    Where their indices cancel, as those of valences 3 and 5, none is left. A locked one keeps its
    place; else the new one lies midway.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        The configuration.
    one, other : int
        Which two, from 0; the new one takes the place of the earlier in the sequence.

    Returns
    -------
    tuple of Singularity
        One fewer, or two where their indices cancel.

    Raises
    ------
    SingularityError
        No valence has the sum of their indices, or both are locked.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity, merged
    >>> surface = disk(edge_length=0.1)
    >>> left, right = (surface.closest_point([x, 0.0, 0.0]) for x in (-0.2, 0.2))
    >>> (one,) = merged(surface, [Singularity(left, 5), Singularity(right, 5)], 0, 1)
    >>> one.valence, np.allclose(surface.position(one.point), 0.0)  # a 6, at the origin
    (6, True)
    >>> merged(surface, [Singularity(left, 3), Singularity(right, 5)], 0, 1)
    ()
    """
    singularities = checked_singularities(singularities)
    last = len(singularities) - 1
    first, second = sorted(
        whole_number("the number of a singularity", i, 0, last) for i in (one, other)
    )
    a, b = singularities[first], singularities[second]
    names = f"#{first + 1} and #{second + 1}"
    if first == second:
        raise SingularityError("it takes two singularities to merge", names, "choose another")
    index = a.index + b.index
    if a.locked and b.locked:
        raise SingularityError("both singularities are locked", names, "unlock one of them")
    if index > 3:
        raise SingularityError(
            f"no valence has the index {index}",
            names,
            "merge others, whose indices sum to 3 at most",
        )
    kept = [s for i, s in enumerate(singularities) if i not in (first, second)]
    if index != 0:
        held = a if a.locked else b
        middle = 0.5 * (surface.position(a.point) + surface.position(b.point))
        point = held.point if held.locked else surface.closest_point(middle)
        kept.insert(first, Singularity(point, 4 - index, held.locked))
    return tuple(kept)


def split(
    surface: TriSurface,
    singularities: Iterable[Singularity],
    which: int,
    apart: float | None = None,
) -> tuple[Singularity, ...]:
    """Return the configuration with one singularity made two, of half its index each.

    A valence 6 becomes two 5, an 8 two 6, a 2 two 3; of an odd index the larger part comes first.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        The configuration.
    which : int
        Which one, from 0.
    apart : float, optional
        As of `pair_at`.

    Returns
    -------
    tuple of Singularity
        One more; the parts stand where the one stood.

    Raises
    ------
    SingularityError
        Its index is 1 or -1, it is locked, or there is no room.

    Examples
    --------
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity, split
    >>> surface = disk(edge_length=0.1)
    >>> one = Singularity(surface.point_at_vertex(0), 8)
    >>> [s.valence for s in split(surface, [one], 0)]
    [6, 6]
    """
    singularities = checked_singularities(singularities)
    which = whole_number("the number of a singularity", which, 0, len(singularities) - 1)
    held = singularities[which]
    name = f"#{which + 1}"
    if abs(held.index) < 2:
        raise SingularityError(
            f"a valence {held.valence} cannot be split", name, "add a pair there instead"
        )
    if held.locked:
        raise SingularityError("the singularity is locked", name, "unlock it")
    smaller = int(held.index / 2)
    others = [s for i, s in enumerate(singularities) if i != which]
    ends = _ends(surface, others, held.point, apart)
    parts = (
        replace(held, point=ends[0], valence=4 - (held.index - smaller)),
        replace(held, point=ends[1], valence=4 - smaller),
    )
    return (*singularities[:which], *parts, *singularities[which + 1 :])


def _ends(
    surface: TriSurface,
    singularities: Sequence[Singularity],
    point: SurfacePoint,
    apart: float | None,
) -> tuple[SurfacePoint, SurfacePoint]:
    """Return two points about a place, along the direction that leaves the most room."""
    if apart is None:
        edge = float(surface.triangulation.lengths.mean())
        apart = max(2 * edge, APART * float(np.sqrt(surface.area)))
    apart = real_number("the distance between the two of a pair", apart, above=0)
    obstacles = np.concatenate(
        [
            surface.positions([s.point for s in singularities]),
            surface.vertices[surface.boundary_vertices],
        ]
    )
    best, room = None, 0.0
    for angle in np.linspace(0, np.pi, DIRECTIONS, endpoint=False):
        half = 0.5 * apart * np.array([np.cos(angle), np.sin(angle)])
        ends = straightest(surface, point, half).end, straightest(surface, point, -half).end
        gaps = np.linalg.norm(surface.positions(ends)[:, None] - obstacles, axis=2)
        nearest = float(gaps.min(initial=np.inf))
        if nearest > room:
            best, room = ends, nearest
    if best is None or room < 0.25 * apart:
        raise SingularityError(
            "there is no room for two singularities here",
            f"they would be {apart:.3g} apart",
            "choose a place farther from the others and from the boundary",
        )
    return best
