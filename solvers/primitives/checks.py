"""Checks of the parameters of built-in surfaces."""

from __future__ import annotations

from solvers import number_checks
from solvers.errors import SurfaceError

MOST_VERTICES = 4_000_000
"""Vertices of the finest surface that is made.

Chosen, so that a slip in a parameter gets one line, not all memory.
"""


def whole(name: str, value: float, least: int, step: int = 1) -> int:
    """Return `value` as an int; raises SurfaceError unless it is `least` plus some `step`."""
    return number_checks.whole_number(name, value, least, step=step, error=SurfaceError)


def positive(name: str, value: float) -> float:
    """Return `value` as a float; raises SurfaceError unless it is a positive number."""
    return number_checks.real_number(name, value, above=0, error=SurfaceError)


def affordable(n_vertices: float) -> None:
    """Raise SurfaceError when a surface would be larger than any computation here can take."""
    if n_vertices > MOST_VERTICES:
        raise SurfaceError(
            f"a surface of {n_vertices:.2g} vertices is too fine",
            f"at most {MOST_VERTICES}",
            "choose coarser triangles",
        )
