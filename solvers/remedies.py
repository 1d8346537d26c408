"""What may be done about an error, as values that a program can carry out.

The class of a remedy is its kind and its fields are what it needs. Nothing is decided by its
words: they may be changed, or translated, and the same buttons appear.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Remedy:
    """Something that may be done about an error.

    Parameters
    ----------
    words : str
        What to do, as an imperative within a sentence.

    Examples
    --------
    >>> from solvers import Remedy
    >>> Remedy("unlock it").label
    'Unlock it'
    """

    words: str

    @property
    def label(self) -> str:
        """What a button says that does it."""
        return self.words[:1].upper() + self.words[1:]


@dataclass(frozen=True)
class RepairSurface(Remedy):
    """Also mend what cannot be mended without changing the surface.

    Parameters
    ----------
    words : str
        As in `Remedy`.

    Examples
    --------
    >>> from solvers import RepairSurface, SurfaceError, TriSurface
    >>> try:
    ...     TriSurface([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    ... except SurfaceError as error:
    ...     print([isinstance(remedy, RepairSurface) for remedy in error.remedies])
    [True]
    """

    @property
    def label(self) -> str:
        """What a button says that does it."""
        return "Repair"


@dataclass(frozen=True)
class TakeLargest(Remedy):
    """Take the largest component of a surface in several.

    Parameters
    ----------
    words : str
        As in `Remedy`.

    Examples
    --------
    >>> from solvers import SurfaceError, TakeLargest, TriSurface
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 0, 0], [6, 0, 0], [5, 1, 0]]
    >>> try:
    ...     TriSurface(corners, [[0, 1, 2], [3, 4, 5]])
    ... except SurfaceError as error:
    ...     print([isinstance(remedy, TakeLargest) for remedy in error.remedies])
    [True]
    """

    @property
    def label(self) -> str:
        """What a button says that does it."""
        return "Use the largest piece"


@dataclass(frozen=True)
class MakeValid(Remedy):
    """Move the unlocked singularities until the holonomy defects vanish.

    Parameters
    ----------
    words : str, optional
        As in `Remedy`.

    Examples
    --------
    >>> from solvers import MakeValid
    >>> MakeValid().words
    'make the configuration valid'
    """

    words: str = "make the configuration valid"

    @property
    def label(self) -> str:
        """What a button says that does it."""
        return "Make valid"


@dataclass(frozen=True)
class UseMethod(Remedy):
    """Solve by another method.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    method : str
        Its name.

    Examples
    --------
    >>> from solvers import UseMethod
    >>> UseMethod("solve the anisotropic field", "anisotropic").label
    'Solve anisotropic'
    """

    method: str

    @property
    def label(self) -> str:
        """What a button says that does it."""
        return f"Solve {self.method}"


MAKE_VALID = MakeValid()
"""In its usual words."""

ANISOTROPIC = UseMethod("solve the anisotropic field", "anisotropic")
"""The method that bridges holonomy defects, in the usual words."""


def in_words(
    remedies: Iterable[Remedy], told: Callable[[Remedy], str] = lambda remedy: remedy.words
) -> str:
    """Return remedies as one imperative: "do this or do that".

    Parameters
    ----------
    remedies : iterable of Remedy
        In the order in which they are told.
    told : callable, optional
        The words of one of them, such as those with the command that does it.
    """
    return " or ".join(told(remedy) for remedy in remedies)
