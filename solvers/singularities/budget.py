"""Singularities, corners, and the index budget they must meet (Poincare-Hopf)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from solvers.errors import SingularityError
from solvers.kind_checks import all_of_kind, one_of_kind
from solvers.number_checks import whole_number
from solvers.remedies import Remedy, in_words
from solvers.singularities.remedies import AddMissing, ChangeOne, RemoveOne
from solvers.singularities.topology import decide
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import QUARTER
from solvers.surface.trisurface import TriSurface

TIE = 1e-3
"""By how many quads, of 90 degrees each, an angle may miss the middle between two whole numbers and
still count as there. Chosen, above the rounding of coordinates in single precision.
"""


@dataclass(frozen=True)
class Singularity:
    """An irregular point of the cross-field.

    Parameters
    ----------
    point : SurfacePoint
        Where it sits.
    valence : int
        Number of quads that meet there; 4 would be regular.
    locked : bool, optional
        Whether it must stay where it is.

    Raises
    ------
    SingularityError
        Unless it has a point, and its valence is a whole number, at least 1.

    Examples
    --------
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.25)
    >>> for valence in (3, 5, 6):
    ...     print(Singularity(surface.point_at_vertex(0), valence).index)
    1
    -1
    -2
    """

    point: SurfacePoint
    valence: int
    locked: bool = False

    def __post_init__(self) -> None:
        advice = "take one of the surface, as closest_point gives"
        one_of_kind(
            "the point of a singularity", self.point, SurfacePoint, advice, error=SingularityError
        )
        valence = whole_number(
            "the valence of a singularity", self.valence, 1, error=SingularityError
        )
        if not isinstance(self.locked, bool | np.bool_):
            raise SingularityError(f"locked must be True or False, not {self.locked!r}")
        object.__setattr__(self, "valence", valence)
        object.__setattr__(self, "locked", bool(self.locked))

    @property
    def index(self) -> int:
        """Index k = 4 - valence, in quarter turns (paper, section 2)."""
        return 4 - self.valence


def checked_singularities(singularities: Iterable[Singularity]) -> tuple[Singularity, ...]:
    """Return singularities given from outside as a tuple.

    Parameters
    ----------
    singularities : iterable of Singularity
        Any number.

    Returns
    -------
    tuple of Singularity
        The same, to be gone through more than once.

    Raises
    ------
    SingularityError
        If one is something else.

    Examples
    --------
    >>> from solvers.singularities import checked_singularities
    >>> checked_singularities(iter([]))
    ()
    >>> checked_singularities([3, 5])
    Traceback (most recent call last):
    solvers.errors.SingularityError: singularities must each be a Singularity, not an int (number 1)
    """
    return all_of_kind("singularities", singularities, Singularity, error=SingularityError)


def default_corners(surface: TriSurface) -> dict[int, int]:
    """Return the boundary vertices where the field turns, judged by their interior angle.

    Parameters
    ----------
    surface : TriSurface
        A surface with or without boundary.

    Returns
    -------
    dict of int to int
        Index k = 2 - (number of quads that meet there, the nearest to the angle and at least
        one) for each boundary vertex where it is not zero: +1 at 90 degrees, -1 at 270. Halfway
        between, as at 135 degrees, the one nearer to a straight boundary counts.

    Notes
    -----
    The paper's section 2.

    Examples
    --------
    >>> from solvers.primitives import square
    >>> from solvers.singularities import default_corners
    >>> default_corners(square(n=2))  # vertices 0 to 2 are the lower side, 6 to 8 the upper
    {0: 1, 2: 1, 6: 1, 8: 1}
    """
    vertices = np.flatnonzero(surface.boundary_vertices)
    turn = surface.angle_defects[vertices] / QUARTER
    size = np.ceil(np.abs(turn) - 0.5 - TIE)
    index = np.minimum((np.sign(turn) * size).astype(int), 1)
    turning = index != 0
    return {int(v): int(k) for v, k in zip(vertices[turning], index[turning], strict=True)}


def checked_corners(surface: TriSurface, corners: Mapping[int, int]) -> dict[int, int]:
    """Return corners given from outside.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    corners : mapping of int to int
        Index by boundary vertex.

    Returns
    -------
    dict of int to int
        The same, of Python's own integers.

    Raises
    ------
    SingularityError
        If it is no mapping, a vertex is not on the boundary, or an index is no whole number up
        to 1, one quad.

    Examples
    --------
    >>> from solvers.primitives import square
    >>> from solvers.singularities import checked_corners
    >>> checked_corners(square(n=2), {0: 1.0})
    {0: 1}
    >>> checked_corners(square(n=2), {4: 1})
    Traceback (most recent call last):
    solvers.errors.SingularityError: vertex 4 has a corner but is not on the boundary: ...
    """
    one_of_kind("the corners", corners, Mapping, error=SingularityError)  # type: ignore[type-abstract]
    found: dict[int, int] = {}
    for given, turning in corners.items():
        last = surface.n_vertices - 1
        vertex = whole_number("the vertex of a corner", given, 0, last, error=SingularityError)
        index = whole_number(
            f"the index of corner {vertex}", turning, most=1, error=SingularityError
        )
        if not surface.boundary_vertices[vertex]:
            raise SingularityError(
                f"vertex {vertex} has a corner but is not on the boundary",
                advice="place a singularity there instead",
            )
        found[vertex] = index
    return found


def corner_indices(surface: TriSurface, corners: Mapping[int, int]) -> list[list[int]]:
    """Return the indices of the corners along each boundary loop, from behind its first vertex.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    corners : mapping of int to int
        Index by boundary vertex; zeros are left out.

    Returns
    -------
    list of list of int
        One for each loop.

    Examples
    --------
    >>> from solvers.primitives import square
    >>> from solvers.singularities import default_corners
    >>> from solvers.singularities.budget import corner_indices
    >>> surface = square(n=2)
    >>> corner_indices(surface, default_corners(surface))
    [[1, 1, 1, 1]]
    """
    index = np.zeros(surface.n_vertices, dtype=np.int64)
    index[list(corners)] = list(corners.values())
    around = [np.roll(index[loop], -1) for loop in surface.boundary_loops]
    return [along[along != 0].tolist() for along in around]


@dataclass(frozen=True)
class IndexBudget:
    """The sum of all indices against the sum the topology demands.

    Parameters
    ----------
    index_sum : int
        Sum of the indices of singularities and corners.
    required : int
        Four times the Euler characteristic.
    remedies : tuple of Remedy
        Single changes that would meet the budget, each to what topology does not forbid.

    Examples
    --------
    >>> from solvers.primitives import sphere
    >>> from solvers.singularities import index_budget
    >>> budget = index_budget(sphere(subdivisions=1), [], {})
    >>> budget.satisfied, budget.missing, [remedy.words for remedy in budget.remedies]
    (False, 8, ['add 8 valence 3'])
    """

    index_sum: int
    required: int
    remedies: tuple[Remedy, ...]

    @property
    def message(self) -> str:
        """The comparison in plain words, with what would mend it."""
        said = f"index {self.index_sum} of {self.required}"
        return said if self.satisfied else f"{said}: {in_words(self.remedies)}"

    @property
    def missing(self) -> int:
        """What must be added to the index sum."""
        return self.required - self.index_sum

    @property
    def satisfied(self) -> bool:
        """Whether nothing is missing."""
        return self.missing == 0


def index_budget(
    surface: TriSurface, singularities: Iterable[Singularity], corners: Mapping[int, int]
) -> IndexBudget:
    """Compare the indices of a configuration with 4 chi (paper, section 2; Poincare-Hopf).

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        Interior singularities.
    corners : mapping of int to int
        Index of the corners, by boundary vertex.

    Returns
    -------
    IndexBudget
        The sum, what it must be, and what would mend it.

    Raises
    ------
    SingularityError
        If a singularity or a corner is something else.

    Examples
    --------
    The square needs no singularity, for its four corners sum to 4 = 4 chi:

    >>> from solvers.primitives import square
    >>> from solvers.singularities import default_corners, index_budget
    >>> surface = square(n=2)
    >>> index_budget(surface, [], default_corners(surface)).message
    'index 4 of 4'
    """
    placed = checked_singularities(singularities)
    total = sum(s.index for s in placed) + sum(checked_corners(surface, corners).values())
    required = 4 * surface.euler_characteristic
    missing = required - total
    remedies: tuple[Remedy, ...] = ()
    if missing:
        around = corner_indices(surface, corners)
        all_that_meet = _meeting(missing, placed)
        possible = [
            remedy
            for remedy, indices in all_that_meet
            if decide(surface.genus, around, indices)[0] != "impossible"
        ]
        # one that changes a singularity is enough
        own = [r for r in possible if not isinstance(r, AddMissing)]
        remedies = tuple([r for r in possible if r not in own] + own[:1]) or (all_that_meet[0][0],)
    return IndexBudget(total, required, remedies)


def require_budget(
    surface: TriSurface, singularities: Iterable[Singularity], corners: Mapping[int, int]
) -> None:
    """Refuse a configuration that misses the index budget.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        Interior singularities.
    corners : mapping of int to int
        Index of the corners, by boundary vertex.

    Raises
    ------
    SingularityError
        It names the sum, what is required, and what would mend it; or as of `index_budget`.

    Examples
    --------
    >>> from solvers.primitives import torus
    >>> from solvers.singularities import Singularity, require_budget
    >>> surface = torus(n=12)
    >>> require_budget(surface, [], {})  # a torus needs none
    >>> require_budget(surface, [Singularity(surface.point_at_vertex(0), 5)], {})
    Traceback (most recent call last):
    solvers.errors.SingularityError: the singularities miss the index budget, -1 of 0: ...
    """
    budget = index_budget(surface, singularities, corners)
    if not budget.satisfied:
        raise SingularityError(
            f"the singularities miss the index budget, {budget.index_sum} of {budget.required}",
            remedies=budget.remedies,
        )


def _meeting(missing: int, singularities: Sequence[Singularity]) -> list[tuple[Remedy, list[int]]]:
    """Return what would meet the budget, each with the indices then; the change of one last."""
    now = [s.index for s in singularities]
    sign = 1 if missing > 0 else -1
    added = AddMissing.of(4 - sign, abs(missing))
    found: list[tuple[Remedy, list[int]]] = [(added, now + [sign] * abs(missing))]
    if missing < -1:
        found.append((AddMissing.of(4 - missing, 1), [*now, missing]))
    changed = [
        (abs(s.valence - missing - 4), -number, s.valence - missing)
        for number, s in enumerate(singularities)
        if s.valence - missing >= 1 and not s.locked
    ]
    for _, number, valence in sorted(changed):  # to the most usual valence, of the newest
        others = now[:-number] + now[1 - number :]
        name = f"#{1 - number}"
        if valence == 4:  # regular: it is to go
            found.append((RemoveOne(f"remove {name}", -number), others))
        else:
            made = ChangeOne(f"make {name} a valence {valence}", -number, valence)
            found.append((made, [*others, 4 - valence]))
    return found
