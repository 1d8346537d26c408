"""Packages whose names are imported when they are wanted: a command that only tells of itself waits
for no numerics.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pkgutil import get_data
from typing import Any


def names_of_stub(
    package: str,
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return ``__getattr__``, ``__dir__`` and ``__all__`` of a package as its stub has them.

    The stub, ``__init__.pyi``, is the one place where a package says which names it has and where
    they come from, to type checkers and to Python alike. A name is imported when it is first
    wanted; the modules and packages within are found, too.

    Parameters
    ----------
    package : str
        Its name.

    Examples
    --------
    >>> find, _, names = names_of_stub("solvers")
    >>> "Progress" in names, find("Progress").__name__
    (True, 'Progress')
    """
    stub = ast.parse(get_data(package, "__init__.pyi") or b"")
    home_of = {
        name.name: statement.module
        for statement in stub.body
        if isinstance(statement, ast.ImportFrom) and statement.module is not None
        for name in statement.names
    }

    def found(name: str) -> Any:
        if name in home_of:
            return getattr(import_module(home_of[name]), name)
        if not name.startswith("_") and find_spec(f"{package}.{name}") is not None:
            return import_module(f"{package}.{name}")
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    def listed() -> list[str]:
        return sorted({*vars(import_module(package)), *home_of})

    return found, listed, sorted(home_of)
