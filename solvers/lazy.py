"""Packages whose names are imported when they are wanted: a command that only tells of itself waits
for no numerics.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from importlib.util import find_spec
from typing import Any


def when_wanted(package: str, homes: Mapping[str, tuple[str, ...]]) -> Callable[[str], Any]:
    """Return the ``__getattr__`` of a package that imports a name when it is first wanted.

    Parameters
    ----------
    package : str
        Its name; the packages in it are found, too.
    homes : mapping of str to tuple of str
        The names that each module has for it.

    Examples
    --------
    >>> find = when_wanted("solvers", {"solvers.progress": ("Progress",)})
    >>> find("Progress").__name__
    'Progress'
    """
    home_of = {name: home for home, names in homes.items() for name in names}

    def found(name: str) -> Any:
        if name in home_of:
            return getattr(import_module(home_of[name]), name)
        if not name.startswith("_") and find_spec(f"{package}.{name}") is not None:
            return import_module(f"{package}.{name}")
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    return found
