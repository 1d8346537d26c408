"""The values a case is made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from crossview.jsonfield import CaseError

METHODS = ("isotropic",)
"""The methods there are, the default first."""

Position = tuple[float, float, float]


@dataclass(frozen=True)
class Builtin:
    """A surface made by the function `name` of ``solvers.primitives.BUILTIN``."""

    name: str
    parameters: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class PlacedSingularity:
    """A singularity given by a point of space, to be projected to the surface."""

    position: Position
    valence: int
    locked: bool = False


@dataclass(frozen=True)
class PlacedCorner:
    """A boundary vertex given by a point of space; index = 2 - quads meeting there."""

    position: Position
    index: int


@dataclass(frozen=True)
class Options:
    """What may be tuned.

    Attributes
    ----------
    tolerance_degrees : float
        Largest holonomy defect of a configuration called valid, degrees.
    refine : int
        Levels of graded refinement around each singularity; 0 only inserts it as a vertex.
    component : int, str or None
        Of a surface in several pieces: "largest", a number (0 is the largest) or "all";
        None refuses such a surface.
    repair : bool
        Also make repairs that change the surface: drop degenerate and duplicate triangles, cut
        non-manifold edges and vertices apart.
    """

    tolerance_degrees: float = 0.01
    refine: int = 3
    component: int | str | None = None
    repair: bool = False


def check_method(name: str, where: str) -> str:
    """The method `name` if it is available.

    Raises
    ------
    CaseError
        It is not; the message lists those that are.
    """
    if name not in METHODS:
        raise CaseError(
            f'the method "{name}" is not available', where, "available: " + ", ".join(METHODS)
        )
    return name
