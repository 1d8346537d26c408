"""What may be done about singularities and corners that have no quad mesh."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from solvers.remedies import Remedy


@dataclass(frozen=True)
class AddMissing(Remedy):
    """Add singularities that the index budget lacks.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    valence : int
        Of each.
    count : int
        How many.

    Examples
    --------
    >>> from solvers.primitives import sphere
    >>> from solvers.singularities import AddMissing, index_budget
    >>> (remedy,) = index_budget(sphere(subdivisions=1), [], {}).remedies
    >>> remedy == AddMissing.of(valence=3, count=8)
    True
    """

    valence: int
    count: int

    @classmethod
    def of(cls, valence: int, count: int) -> AddMissing:
        """Return the remedy, in its usual words.

        Parameters
        ----------
        valence, count : int
            As of the class.
        """
        return cls(f"add {'one' if count == 1 else count} valence {valence}", valence, count)

    @property
    def label(self) -> str:
        """What a button says that does it."""
        return f"Add {'one' if self.count == 1 else f'all {self.count}'} valence {self.valence}"


@dataclass(frozen=True)
class ChangeOne(Remedy):
    """Give one singularity the valence that takes up all that is missing.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    number : int
        Which singularity, from 0.
    valence : int
        Its new valence.

    Examples
    --------
    >>> from solvers.primitives import torus
    >>> from solvers.singularities import ChangeOne, Singularity, index_budget
    >>> surface = torus(n=12)
    >>> places = [surface.point_at_vertex(vertex) for vertex in (0, 40)]
    >>> pair = [Singularity(places[0], 3), Singularity(places[1], 6)]
    >>> index_budget(surface, pair, {}).remedies[-1] == ChangeOne("make #1 a valence 2", 0, 2)
    True
    """

    number: int
    valence: int


@dataclass(frozen=True)
class RemoveOne(Remedy):
    """Take one singularity away, whose index is what is too much.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    number : int
        Which singularity, from 0.

    Examples
    --------
    >>> from solvers.primitives import torus
    >>> from solvers.singularities import RemoveOne, Singularity, index_budget
    >>> surface = torus(n=12)
    >>> alone = [Singularity(surface.point_at_vertex(0), 5)]
    >>> index_budget(surface, alone, {}).remedies[-1] == RemoveOne("remove #1", 0)
    True
    """

    number: int

    @property
    def label(self) -> str:
        """What a button says that does it."""
        return f"Delete #{self.number + 1}"


@dataclass(frozen=True)
class AddPair(Remedy):
    """Add a valence 3 and a valence 5 where there is most room: the sum of indices stays.

    Parameters
    ----------
    words : str, optional
        As in `Remedy`.

    Examples
    --------
    >>> from solvers.singularities import AddPair
    >>> AddPair().label
    'Add a pair of valences 3 and 5'
    """

    words: str = "add a pair of valences 3 and 5"


@dataclass(frozen=True)
class ChangeCorners(Remedy):
    """Give corners other indices.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    corners : tuple of (int, int)
        Boundary vertices that change, with their new indices; 0 for none.

    Examples
    --------
    >>> from solvers.singularities import ChangeCorners
    >>> ChangeCorners.none_of({5: 1, 3: -1}).corners
    ((3, 0), (5, 0))
    """

    corners: tuple[tuple[int, int], ...]

    @classmethod
    def none_of(cls, vertices: Iterable[int]) -> ChangeCorners:
        """Return the remedy that takes corners away, in its usual words.

        Parameters
        ----------
        vertices : iterable of int
            Where they are.
        """
        gone = tuple((vertex, 0) for vertex in sorted(vertices))
        return cls(f"take the {len(gone)} corners away", gone)


@dataclass(frozen=True)
class ChangeTurns(Remedy):
    """Let the crosses turn otherwise over the holonomy conditions.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    by : tuple of int
        Quarter turns to add over each.

    Examples
    --------
    >>> from solvers.singularities import ChangeTurns
    >>> ChangeTurns.of((-1, 0)).words
    'change the turns by -1, 0'
    """

    by: tuple[int, ...]

    @classmethod
    def of(cls, by: Iterable[int]) -> ChangeTurns:
        """Return the remedy, in its usual words.

        Parameters
        ----------
        by : iterable of int
            As of the class.
        """
        added = tuple(by)
        listed = ", ".join(f"{n:+d}" if n else "0" for n in added)
        return cls(f"change the turns by {listed}", added)


@dataclass(frozen=True)
class MergeTwo(Remedy):
    """Make one singularity of two.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    one, other : int
        Which singularities, from 0.

    Examples
    --------
    >>> from solvers.errors import SingularityError
    >>> from solvers.primitives import torus
    >>> from solvers.singularities import MergeTwo, Singularity, require_places
    >>> surface = torus(n=12)
    >>> place = surface.point_at_vertex(0)
    >>> try:
    ...     require_places(surface, [Singularity(place, 3), Singularity(place, 5)])
    ... except SingularityError as error:
    ...     error.remedies == (MergeTwo("merge them", 0, 1),)
    True
    """

    one: int
    other: int


@dataclass(frozen=True)
class SplitOne(Remedy):
    """Make two singularities of one.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    number : int
        Which singularity, from 0.

    Examples
    --------
    >>> from solvers.singularities import SplitOne
    >>> SplitOne("split #1 into a 2 and a 3", 0).label
    'Split #1 into a 2 and a 3'
    """

    number: int


@dataclass(frozen=True)
class MoveInside(Remedy):
    """Move a singularity from the boundary to the nearest vertex inside.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    number : int
        Which singularity, from 0.

    Examples
    --------
    >>> from solvers.errors import SingularityError
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import MoveInside, Singularity, require_places
    >>> surface = disk(edge_length=0.2)
    >>> rim = surface.point_at_vertex(int(surface.boundary_loops[0][0]))
    >>> try:
    ...     require_places(surface, [Singularity(rim, 3)])
    ... except SingularityError as error:
    ...     error.remedies == (MoveInside("move it inside", 0),)
    True
    """

    number: int
