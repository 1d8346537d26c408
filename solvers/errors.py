"""The errors a user can meet: one line that says what, where and what to do."""

from __future__ import annotations

import copyreg
import json
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from solvers.remedies import Remedy, in_words

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


class CrossviewError(Exception):
    """A mistake the user can mend, told in one line.

    Parameters
    ----------
    what : str
        What is wrong.
    where : str, optional
        The file, element or setting it is wrong at.
    advice : str, optional
        What the user may do that no program can; nothing is decided by it.
    remedies : iterable of Remedy, optional
        What a program can do about it, the least change first.

    Examples
    --------
    >>> from solvers import CrossviewError
    >>> str(CrossviewError("the edge length must be above 0", "-2", "give another"))
    'the edge length must be above 0 (-2): give another'
    """

    def __init__(
        self, what: str, where: str = "", advice: str = "", *, remedies: Iterable[Remedy] = ()
    ) -> None:
        self.what = what
        self.where = where
        self.advice = advice
        self.remedies = tuple(remedies)
        super().__init__(what, where, advice)

    def __str__(self) -> str:
        """Return ``what (where): what to do`` without line breaks."""
        return self.line()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle all that is told: exceptions by themselves only pickle their arguments."""
        return copyreg.__newobj__, (type(self), *self.args), vars(self)  # type: ignore[attr-defined]

    def line(self, told: Callable[[Remedy], str] = lambda remedy: remedy.words) -> str:
        """Return ``what (where): what to do`` without line breaks.

        Parameters
        ----------
        told : callable, optional
            The words of a remedy, such as those with the command that does it.
        """
        line = shortened(self.what)
        if self.where:
            line += f" ({shortened(self.where, LONGEST_PLACE)})"
        to_do = self.to_do(told)
        if to_do:
            line += f": {shortened(to_do)}"
        return printable(" ".join(line.split()))

    def to_do(self, told: Callable[[Remedy], str] = lambda remedy: remedy.words) -> str:
        """Return the advice and the remedies in words; empty where there are none.

        Parameters
        ----------
        told : callable, optional
            As of `line`.
        """
        return ", or ".join(part for part in (self.advice, in_words(self.remedies, told)) if part)

    def locate(self, place: str) -> None:
        """Name the larger place, such as the file, before where it is wrong.

        Parameters
        ----------
        place : str
            Its name.
        """
        self.where = f"{place}, {self.where}" if self.where else place


class SurfaceError(CrossviewError):
    """A surface that cannot be worked on.

    Parameters
    ----------
    what, where, advice : str
        As in `CrossviewError`.
    elements : array_like of int, optional
        Numbers of the offending faces, vertices or edges.
    kind : {"", "faces", "vertices", "edges"}, optional
        What `elements` counts. Edges are given as pairs of vertices, shape (k, 2).
    remedies : iterable of Remedy, optional
        As in `CrossviewError`.

    Examples
    --------
    >>> from solvers import SurfaceError, TriSurface
    >>> try:
    ...     TriSurface([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2], [1, 2, 3]])
    ... except SurfaceError as error:
    ...     print(error.kind, error.elements.tolist())
    edges [[1, 2]]
    """

    def __init__(
        self,
        what: str,
        where: str = "",
        advice: str = "",
        elements: npt.ArrayLike = (),
        kind: str = "",
        *,
        remedies: Iterable[Remedy] = (),
    ) -> None:
        super().__init__(what, where, advice, remedies=remedies)
        import numpy as np  # a mistyped command needs none

        self.elements: npt.NDArray[np.int64] = np.asarray(elements, dtype=np.int64)
        self.kind = kind


class SingularityError(CrossviewError):
    """A singularity configuration that has no field, or that is placed where none can be.

    Parameters
    ----------
    what, where, advice : str
        As in `CrossviewError`.
    remedies : iterable of Remedy, optional
        As in `CrossviewError`.

    Examples
    --------
    >>> from solvers import SingularityError
    >>> from solvers.primitives import sphere
    >>> from solvers.singularities import require_budget
    >>> try:
    ...     require_budget(sphere(subdivisions=1), [], {})
    ... except SingularityError as error:
    ...     print(error.remedies[0].words)
    add 8 valence 3
    """


class SolveError(CrossviewError):
    """A linear system or an iteration that could not be solved.

    Parameters
    ----------
    what, where, advice : str
        As in `CrossviewError`.
    remedies : iterable of Remedy, optional
        As in `CrossviewError`.

    Examples
    --------
    >>> import numpy as np
    >>> from scipy.sparse import csc_array
    >>> from solvers import SolveError
    >>> from solvers.algebra import factorized
    >>> try:
    ...     factorized(csc_array(np.ones((2, 2))))
    ... except SolveError as error:
    ...     print(error.what)
    the linear system could not be solved
    """


LONGEST = 400
"""Characters of what is wrong and of what to do that a line tells. Chosen."""

LONGEST_PLACE = 4400
"""Of where it is wrong: the longest path that Linux has, 4096, and a key in the file."""


def shortened(text: str, most: int = LONGEST) -> str:
    """Return a text without its middle if it is too long.

    Parameters
    ----------
    text : str
        Perhaps from a file, which may hold anything.
    most : int, optional
        Characters that are kept.

    Examples
    --------
    >>> from solvers.errors import shortened
    >>> shortened("abcdefghij", 7)
    'ab...ij'
    """
    if len(text) <= most:
        return text
    half = (most - 3) // 2
    return f"{text[:half]}...{text[-half:]}"


def printable(text: str) -> str:
    r"""Return a text in which characters that steer a terminal are written as JSON does.

    Parameters
    ----------
    text : str
        Perhaps with line breaks, which stay.

    Examples
    --------
    >>> from solvers.errors import printable
    >>> print(printable("a\x1b[31mb"))
    a\u001b[31mb
    """
    if text.isprintable():
        return text
    return "".join(
        c if c.isprintable() or c in "\n " else json.dumps(c)[1:-1].replace("\x7f", r"\u007f")
        for c in text
    )


def listed(elements: npt.NDArray[np.int64], limit: int = 5) -> str:
    """Return the first few of `elements` as text."""
    import numpy as np

    shown = ["-".join(str(v) for v in np.atleast_1d(element)) for element in elements[:limit]]
    more = f" and {len(elements) - limit} more" if len(elements) > limit else ""
    return ", ".join(shown) + more


def counted(number: int, noun: str) -> str:
    """Return the number with its noun: "1 vertex", "2 vertices"."""
    plural = noun.removesuffix("vertex") + "vertices" if noun.endswith("vertex") else f"{noun}s"
    return f"{number} {noun if number == 1 else plural}"
