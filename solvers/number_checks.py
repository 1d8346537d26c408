"""The one check of numbers that come from outside: Python callers, files and fields of a window.

A number is a Python or NumPy integer or float; True and False are none. Where a whole number is
wanted 3.0 is one, as in JSON, and becomes 3; 3.5 is refused, never cut. Nothing is rounded.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from solvers.errors import CrossviewError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

LARGEST = 1e50
"""Bound of all numbers, coordinates and lengths in the surface's unit.

From the range of double precision, 1.8e308: the squares of areas and the products of six lengths
must not overflow.
"""

EXACT = 2**53
"""Whole numbers beyond this are not told apart by double precision."""


def plain(value: object) -> int | float | None:
    """Return a finite number below `LARGEST` as Python's own; None for anything else."""
    if isinstance(value, np.integer | np.floating):
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return value if abs(value) < LARGEST else None


def whole_number(
    name: str,
    value: object,
    least: int | None = None,
    most: int | None = None,
    *,
    step: int = 1,
    error: type[CrossviewError] = CrossviewError,
) -> int:
    """Return a value as an int.

    Parameters
    ----------
    name : str
        What it is, as the error names it.
    value : object
        What was given.
    least, most : int, optional
        Its bounds, both allowed.
    step : int, optional
        It is `least` plus a multiple of this.
    error : type, optional
        What is raised.

    Raises
    ------
    CrossviewError
        Or `error`, unless it is such a number.

    Examples
    --------
    >>> from solvers.number_checks import whole_number
    >>> whole_number("the valence", 3.0, least=1)
    3
    >>> whole_number("the valence", 3.5, least=1)
    Traceback (most recent call last):
    solvers.errors.CrossviewError: the valence must be a whole number, at least 1, not 3.5
    """
    found = plain(value)
    if found is not None and abs(found) <= EXACT and found == int(found):
        low = least is None or (found >= least and (found - least) % step == 0)
        if low and (most is None or found <= most):
            return int(found)
    kind = "a whole number" if step == 1 else f"a multiple of {step}"
    raise error(f"{name} must be {_within(kind, least, most)}, not {_shown(value)}")


def real_number(
    name: str,
    value: object,
    least: float | None = None,
    most: float | None = None,
    *,
    above: float | None = None,
    error: type[CrossviewError] = CrossviewError,
) -> float:
    """Return a value as a float.

    Parameters
    ----------
    name, value, least, most, error
        As of `whole_number`.
    above : float, optional
        What it must be larger than.

    Raises
    ------
    CrossviewError
        Or `error`, unless it is such a number, finite and below `LARGEST`.

    Examples
    --------
    >>> from solvers.number_checks import real_number
    >>> real_number("the edge length", 2, above=0)
    2.0
    >>> real_number("the edge length", float("nan"), above=0)
    Traceback (most recent call last):
    solvers.errors.CrossviewError: the edge length must be a positive number, not nan
    """
    found = plain(value)
    if found is not None:
        low = (least is None or found >= least) and (above is None or found > above)
        if low and (most is None or found <= most):
            return float(found)
    kind = "a positive number" if above == 0 else "a number"
    kind = f"a number above {above:g}" if above else kind
    raise error(f"{name} must be {_within(kind, least, most)}, not {_shown(value)}")


def real_numbers(
    name: str,
    values: npt.ArrayLike,
    shape: Sequence[int | None] | None = None,
    *,
    finite: bool = False,
    error: type[CrossviewError] = CrossviewError,
) -> FloatArray:
    """Return values as a new array of floats.

    Parameters
    ----------
    name : str
        What they are, as the error names them.
    values : array_like
        What was given.
    shape : sequence of int or None, optional
        The wanted shape; None for any length.
    finite : bool, optional
        Whether they must be finite and below `LARGEST`.
    error : type, optional
        What is raised.

    Raises
    ------
    CrossviewError
        Or `error`, unless they are numbers in that shape.

    Examples
    --------
    >>> from solvers.number_checks import real_numbers
    >>> real_numbers("the position", [1, 2, 3], (3,)).tolist()
    [1.0, 2.0, 3.0]
    >>> real_numbers("the position", [1, 2], (3,))
    Traceback (most recent call last):
    solvers.errors.CrossviewError: the position must be 3 numbers, not 2
    """
    numbers = np.array(_table(name, values, shape, "numbers", error), dtype=np.float64)
    if finite and not (np.abs(numbers) < LARGEST).all():
        raise error(f"{name} must be finite numbers, not {_shown(numbers.tolist())}")
    return numbers


def whole_numbers(
    name: str,
    values: npt.ArrayLike,
    shape: Sequence[int | None] | None = None,
    *,
    below: int | None = None,
    error: type[CrossviewError] = CrossviewError,
) -> IntArray:
    """Return values as a new array of ints.

    Parameters
    ----------
    name, values, shape, error
        As of `real_numbers`.
    below : int, optional
        They are numbers of things that there are so many of, from 0.

    Raises
    ------
    CrossviewError
        Or `error`, unless they are whole numbers in that shape; it names the first that is none.

    Examples
    --------
    >>> from solvers.number_checks import whole_numbers
    >>> whole_numbers("faces", [[0, 1, 2.0]]).tolist()
    [[0, 1, 2]]
    >>> whole_numbers("faces", [[0, 1, 2.7]])
    Traceback (most recent call last):
    solvers.errors.CrossviewError: faces must be whole numbers, not 2.7 (row 0)
    """
    table = _table(name, values, shape, "whole numbers", error)
    if table.dtype.kind == "f":
        # not so where it is NaN
        wrong = ~((np.abs(table) <= EXACT) & (table == np.rint(table)))
    else:
        wrong = table > np.iinfo(np.int64).max
    kind = "whole numbers"
    if below is not None:
        wrong |= (table < 0) | (table >= below)
        kind += f" from 0 to {below - 1}"
    if wrong.any():
        first = tuple(np.argwhere(wrong)[0].tolist())
        place = f"row {first[0]}" if first else ""
        raise error(f"{name} must be {kind}, not {table[first]}", place)
    return np.array(table, dtype=np.int64)


def _table(
    name: str,
    values: npt.ArrayLike,
    shape: Sequence[int | None] | None,
    kind: str,
    error: type[CrossviewError],
) -> npt.NDArray[Any]:
    """Return values as an array of ints or floats in the wanted shape."""
    try:
        table = np.asarray(values)
    except (ValueError, TypeError, OverflowError):
        raise error(f"{name} must be {kind} in rows of one length") from None
    if table.size == 0:
        table = table.astype(np.int64)  # nothing is a number of any kind
    if table.dtype.kind not in "iuf":
        odd = "True and False" if table.dtype.kind == "b" else _shown(values)
        raise error(f"{name} must be {kind}, not {odd}")
    if shape is not None:
        fits = table.ndim == len(shape)
        fits &= all(want in (None, got) for want, got in zip(shape, table.shape, strict=False))
        if not fits:
            raise error(f"{name} must be {_sized(shape)} {kind}, not {_sized(table.shape)}")
    return table


def _sized(shape: Sequence[int | None]) -> str:
    """Return a shape in words: 3, or any number x 3."""
    if not shape:
        return "a single one"
    return " x ".join("any number" if length is None else str(length) for length in shape)


def _within(kind: str, least: float | None, most: float | None) -> str:
    if least is not None and most is not None:
        return f"{kind} from {least:g} to {most:g}"
    if least is not None:
        return f"{kind}, at least {least:g}"
    return f"{kind}, at most {most:g}" if most is not None else kind


def _shown(value: object) -> str:
    """Return a value as Python writes it, shortened so that an error stays one line."""
    plain = value.item() if isinstance(value, np.generic) else value
    text = " ".join(repr(plain).split())
    return text if len(text) <= 40 else text[:37] + "..."
