"""Checks of the parameters of built-in surfaces."""

from __future__ import annotations

from solvers.errors import SurfaceError
from solvers.surface.validation import LARGEST

MOST_VERTICES = 4_000_000
"""Vertices of the finest surface that is made.

Chosen, so that a slip in a parameter gets one line, not all memory.
"""


def whole(name: str, value: float, least: int, step: int = 1) -> int:
    """Return `value` as an integer.

    Raises
    ------
    SurfaceError
        Unless it is `least` or `least` plus a multiple of `step`.
    """
    good = _is_usable(value) and value == int(value)
    if not good or value < least or (int(value) - least) % step:
        kind = "a whole number" if step == 1 else f"a multiple of {step}"
        raise SurfaceError(f"{name} must be {kind}, at least {least}, not {value!r}")
    return int(value)


def positive(name: str, value: float) -> float:
    """Return `value` as a float; raises SurfaceError unless it is positive, below `LARGEST`."""
    if not _is_usable(value) or value <= 0:
        raise SurfaceError(f"{name} must be a positive number, not {value!r}")
    return float(value)


def _is_usable(value: object) -> bool:
    """Whether `value` is a number that can be computed with; parameters come from files."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < LARGEST


def affordable(n_vertices: float) -> None:
    """Raise SurfaceError when a surface would be larger than any computation here can take."""
    if n_vertices > MOST_VERTICES:
        raise SurfaceError(
            f"a surface of {n_vertices:.2g} vertices is too fine",
            f"at most {MOST_VERTICES}",
            "choose coarser triangles",
        )
