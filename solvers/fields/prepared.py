"""A surface prepared for a configuration: each singularity a vertex, its operator factored once.

An isotropic field takes singularities anywhere. A field that is aligned everywhere, or has two
sizes, has them at vertices. `prepare` makes that true, so that nothing later has to ask.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from solvers.errors import SingularityError
from solvers.features.edges import Features, no_features
from solvers.fields.isotropic import IsotropicSolver
from solvers.singularities.budget import (
    Singularity,
    checked_corners,
    checked_singularities,
    default_corners,
)
from solvers.surface.points import SurfacePoint
from solvers.surface.refinement import LEVELS, Refinement, refine_at
from solvers.surface.trisurface import TriSurface


@dataclass(frozen=True, eq=False)
class Operators:
    """What is factored for a surface, once and when it is first asked for.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    corners : mapping of int to int
        As of `IsotropicSolver`.
    features : Features
        Of the surface.

    Examples
    --------
    >>> from solvers.fields import prepare
    >>> from solvers.primitives import square
    >>> operators = prepare(square(n=4)).operators
    >>> operators.solver is operators.solver
    True
    """

    surface: TriSurface
    corners: Mapping[int, int]
    features: Features

    @cached_property
    def solver(self) -> IsotropicSolver:
        """On the working triangulation of the surface."""
        return IsotropicSolver(self.surface, self.corners, features=self.features)


@dataclass(frozen=True, eq=False)
class PreparedSurface:
    """A refined surface on which a configuration's singularities are vertices.

    Made by `prepare`.

    Parameters
    ----------
    refinement : Refinement
        Of the surface given.
    places : tuple of SurfacePoint
        Where singularities were put on the surface given.
    singularities : tuple of Singularity
        On the refined surface, at vertices, in the order of `places`.
    operators : Operators
        Of the refined surface.

    Raises
    ------
    SingularityError
        A singularity is not at a vertex.

    Examples
    --------
    Other valences at the same places need no other factor:

    >>> from dataclasses import replace
    >>> from solvers.fields import prepare
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> surface = annulus(inner=0.4, n=24)
    >>> one = Singularity(surface.closest_point([0.7, 0, 0]), 3)
    >>> two = Singularity(surface.closest_point([-0.7, 0, 0]), 5)
    >>> prepared = prepare(surface, [one, two])
    >>> swapped = prepared.with_valences([replace(one, valence=5), replace(two, valence=3)])
    >>> swapped.operators.solver is prepared.operators.solver
    True
    """

    refinement: Refinement
    places: tuple[SurfacePoint, ...]
    singularities: tuple[Singularity, ...]
    operators: Operators

    def __post_init__(self) -> None:
        for number, s in enumerate(self.singularities, start=1):
            if max(s.point.barycentric) != 1.0:
                raise SingularityError(
                    f"singularity {number} is not at a vertex", "", "prepare the surface for it"
                )

    @property
    def surface(self) -> TriSurface:
        """The refined surface."""
        return self.refinement.surface

    @property
    def corners(self) -> Mapping[int, int]:
        """Index of each boundary vertex where the field turns."""
        return self.operators.corners

    @property
    def features(self) -> Features:
        """The edges of the refined surface that crosses are to follow."""
        return self.operators.features

    def with_valences(self, singularities: Iterable[Singularity]) -> PreparedSurface:
        """Return the same surface, its factors kept, for other valences at the same places.

        Parameters
        ----------
        singularities : iterable of Singularity
            On the surface given, where those were that it was prepared for.

        Raises
        ------
        SingularityError
            They are somewhere else.
        """
        given = checked_singularities(singularities)
        if tuple(s.point for s in given) != self.places:
            raise SingularityError(
                "the surface is prepared for singularities elsewhere", "", "prepare it for these"
            )
        placed = tuple(
            replace(s, point=at.point) for s, at in zip(given, self.singularities, strict=True)
        )
        return replace(self, singularities=placed)


def prepare(
    surface: TriSurface,
    singularities: Iterable[Singularity] = (),
    *,
    refine: int = LEVELS,
    corners: Mapping[int, int] | None = None,
    features: Features | None = None,
) -> PreparedSurface:
    """Make the singularities of a configuration vertices of a surface, finer around them.

    Parameters
    ----------
    surface : TriSurface
        What to refine.
    singularities : iterable of Singularity
        On vertices, on edges or inside triangles of the surface.
    refine : int, optional
        How many times edges are halved near the singularities; 0 only inserts them.
    corners : mapping of int to int, optional
        Index of each boundary vertex where the field turns, quarter turns; by default what
        `default_corners` reads from the interior angles.
    features : Features, optional
        Edges of the surface that crosses are to follow; by default none.

    Returns
    -------
    PreparedSurface
        The refined surface, what is factored for it, and the configuration on it.

    Raises
    ------
    CrossviewError
        If a singularity, a corner or a feature is none of the surface.

    Examples
    --------
    >>> from solvers.fields import prepare
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> surface = annulus(inner=0.4, n=24)
    >>> inside = surface.closest_point([0.7, 0.01, 0.0])
    >>> prepared = prepare(surface, [Singularity(inside, 3)])
    >>> max(prepared.singularities[0].point.barycentric)
    1.0
    """
    along = no_features(surface) if features is None else features.require_on(surface)
    given = checked_singularities(singularities)
    places = tuple(s.point for s in given)
    refinement = refine_at(surface, places, refine, along.edges)
    fine = refinement.surface
    # refinement keeps the numbers of vertices, so the corners stay where they are
    chosen = default_corners(surface) if corners is None else checked_corners(surface, corners)
    return PreparedSurface(
        refinement,
        places,
        tuple(
            replace(s, point=fine.point_at_vertex(int(vertex)))
            for s, vertex in zip(given, refinement.vertices, strict=True)
        ),
        Operators(fine, chosen, along.refined(refinement)),
    )
