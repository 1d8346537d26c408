"""What may be done about an index budget that is missed."""

from __future__ import annotations

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
    >>> index_budget(surface, pair, {}).remedies[-1] == ChangeOne("make #2 a valence 5", 1, 5)
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
