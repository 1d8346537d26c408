"""The one check of things that come from outside and are to be of a kind: points, features, cases.

What is to be several of a kind may be any iterable, a generator too: it becomes a tuple, so that
it may be gone through more than once.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

from solvers.errors import CrossviewError

T = TypeVar("T")


def one_of_kind(
    name: str,
    value: object,
    kind: type[T],
    advice: str = "",
    *,
    error: type[CrossviewError] = CrossviewError,
) -> T:
    """Return a value that is of a kind.

    Parameters
    ----------
    name : str
        What it is, as the error names it.
    value : object
        What was given.
    kind : type
        What it must be.
    advice : str, optional
        How to come by one.
    error : type, optional
        What is raised.

    Raises
    ------
    CrossviewError
        Or `error`, if it is anything else.

    Examples
    --------
    >>> from solvers.kind_checks import one_of_kind
    >>> one_of_kind("the title", "A disk", str)
    'A disk'
    >>> one_of_kind("the title", None, str)
    Traceback (most recent call last):
    solvers.errors.CrossviewError: the title must be a str, not None
    """
    if isinstance(value, kind):
        return value
    raise error(f"{name} must be {_a(kind)}, not {_kind_of(value)}", advice=advice)


def all_of_kind(
    name: str,
    values: Iterable[object],
    kind: type[T],
    *,
    error: type[CrossviewError] = CrossviewError,
) -> tuple[T, ...]:
    """Return values that are all of a kind, as a tuple.

    Parameters
    ----------
    name : str
        What they are, as the error names them.
    values : iterable
        What was given.
    kind, error
        As of `one_of_kind`.

    Raises
    ------
    CrossviewError
        Or `error`, if they are no iterable, or one of them is anything else.

    Examples
    --------
    >>> from solvers.kind_checks import all_of_kind
    >>> all_of_kind("the names", (name for name in ("a", "b")), str)
    ('a', 'b')
    >>> all_of_kind("the names", ["a", 3], str)
    Traceback (most recent call last):
    solvers.errors.CrossviewError: the names must each be a str, not an int (number 2)
    """
    try:
        given = tuple(values)
    except TypeError:
        raise error(f"{name} must be several {kind.__name__}, not {_kind_of(values)}") from None
    found: list[T] = []
    for number, value in enumerate(given, start=1):
        if not isinstance(value, kind):
            what = f"{name} must each be {_a(kind)}, not {_kind_of(value)}"
            raise error(what, f"number {number}")
        found.append(value)
    return tuple(found)


def _kind_of(value: object) -> str:
    return "None" if value is None else _a(type(value))


def _a(kind: type) -> str:
    """Return the name of a kind with its article."""
    return f"{'an' if kind.__name__[0] in 'aeiouAEIOU' else 'a'} {kind.__name__}"
