"""Values whose arrays nobody writes to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import cached_property, wraps
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")


def freeze_arrays(value: Any) -> None:
    """Make the arrays of a frozen dataclass read-only, for its ``__post_init__``.

    Those of the caller stay as they are: the value keeps views.

    Parameters
    ----------
    value : dataclass
        The value, just made.
    """
    for name in (each.name for each in fields(value)):
        if isinstance(array := getattr(value, name), np.ndarray):
            object.__setattr__(value, name, read_only(array))


def read_only(value: T) -> T:
    """Return a read-only view of an array, or a tuple with such views of its arrays.

    Parameters
    ----------
    value : array, tuple or anything else
        What is to be kept; anything else is returned as it is.
    """
    kept: Any = value
    if type(kept) is tuple:
        kept = tuple(map(read_only, kept))
    elif isinstance(kept, np.ndarray):
        kept = kept.view()
        kept.setflags(write=False)
    result: T = kept
    return result


def frozen_property(compute: Callable[[Any], T]) -> cached_property[T]:
    """Make a property that is computed once, and whose arrays nobody writes to.

    Parameters
    ----------
    compute : callable
        The method that computes it; what it returns is kept by `read_only`.
    """

    @wraps(compute)
    def computed(self: Any) -> T:
        return read_only(compute(self))

    return cached_property(computed)
