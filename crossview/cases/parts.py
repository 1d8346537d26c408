"""The values a case is made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from crossview.cases.json_values import CaseError, nearest

METHODS = ("isotropic", "aligned", "anisotropic", "alternating")
"""The methods there are, the default first."""

Sizes = str | tuple[float, ...] | tuple[tuple[float, float], ...]
"""A size map: its file, or a size or a pair of sizes for each vertex."""

Position = tuple[float, float, float]

Polyline = tuple[Position, ...]


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
class PlacedFeatures:
    """Edges inside the surface that crosses are to follow.

    Attributes
    ----------
    dihedral_degrees : float or None
        Edges over which the surface bends by more than this are features; None: no such.
    curves : tuple of polylines
        Each runs along edges, the shortest way, through the vertices nearest to its points.
    without : tuple of polylines
        Edges, given likewise, that are none although they are sharp.
    """

    dihedral_degrees: float | None = None
    curves: tuple[Polyline, ...] = ()
    without: tuple[Polyline, ...] = ()


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
    turns : tuple of int, or None
        Quarter turns that the aligned field makes over each holonomy condition besides those
        nearest to the isotropic field; other numbers are other layouts. For all methods but the
        isotropic.
    proximal_weight : float
        Weight of the proximal term of the alternating method; the paper's is 1.
    sizes : str, tuple or None
        Size map that the anisotropic method follows as closely as the singularities allow: a
        .npy or .txt file, or a size or a pair of sizes for each vertex of the surface given.
    verify : bool
        Solve again on a once refined mesh, and judge by how much the aspect grows.
    """

    tolerance_degrees: float = 0.01
    refine: int = 3
    component: int | str | None = None
    repair: bool = False
    turns: tuple[int, ...] | None = None
    proximal_weight: float = 1.0
    sizes: Sizes | None = None
    verify: bool = False


def check_method(name: str, where: str) -> str:
    """The method `name` if it is available.

    Raises
    ------
    CaseError
        It is not; the message names the nearest, or lists those that are.
    """
    if name not in METHODS:
        raise CaseError(f'unknown method "{name}"', where, nearest(name, METHODS))
    return name
