"""The isotropic cross-field: H from one linear system, theta from one walk.

H and theta are discrete harmonic conjugates: the condition that theta closes around a vertex is
that vertex's row of the system for H. So the second linear system of the paper has an exact
solution, and a walk over a spanning tree of the triangles finds it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from functools import cached_property

import numpy as np

from solvers.algebra.factorization import factorized
from solvers.algebra.operators import lumped_mass, midpoint_offsets, stiffness
from solvers.errors import CrossviewError, SingularityError
from solvers.features.edges import Features
from solvers.fields.connection import CLEARANCE, Discretization
from solvers.fields.crossfield import Convergence, CrossField, WorkingField
from solvers.fields.embedded import split_offsets
from solvers.fields.holonomy import Holonomy
from solvers.fields.sampled import sampled
from solvers.number_checks import real_number
from solvers.singularities.budget import (
    Singularity,
    checked_corners,
    checked_singularities,
    default_corners,
    require_budget,
)
from solvers.surface.cutting import cut_graph
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray
from solvers.surface.trisurface import TriSurface


class IsotropicSolver:
    """Isotropic fields on one surface: factored once, solved for any singularities.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    corners : mapping of int to int, optional
        Index of each boundary vertex where the field turns; by default what `default_corners`
        reads from the interior angles.
    features : Features, optional
        Of the surface. The field is not aligned with them, but says how far off it is; without
        a boundary all crosses are turned alike, so that it is off as little as may be.

    Attributes
    ----------
    mass : (n,) float array
        Area of each vertex of the working triangulation.
    gauge : float
        Angle by which all crosses are turned, radians; see `in_gauge`.

    Raises
    ------
    SolveError
        If the surface's triangles are too poor for the system to be solved.

    Notes
    -----
    The paper's equations for H and theta; theta by a walk that solves the second exactly.

    Examples
    --------
    A disk with four valences 3, which its index budget asks for:

    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> solver = IsotropicSolver(surface)  # one factorisation
    >>> places = [[0.5, 0, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> field = solver.solve(threes)  # one back-substitution
    >>> field.index_sum, field.index_required
    (4, 4)
    >>> bool(abs(field.boundary_misalignment[0]) < 1e-9 and field.max_closing_error < 1e-9)
    True
    """

    def __init__(
        self,
        surface: TriSurface,
        corners: Mapping[int, int] | None = None,
        *,
        features: Features | None = None,
    ) -> None:
        self.surface = surface
        self.corners = (
            default_corners(surface) if corners is None else checked_corners(surface, corners)
        )
        self.discretization = Discretization(surface, features=features)
        matrix = stiffness(self.discretization.triangulation)
        # H is unique up to a constant: the first vertex is pinned, the mean subtracted after.
        self.factorization = factorized(matrix[1:, 1:])
        self.mass = lumped_mass(self.discretization.triangulation)
        self.gauge = 0.0

    @cached_property
    def holonomy(self) -> Holonomy:
        """The holonomy defects of any configuration on this surface."""
        return Holonomy(self.discretization, self.factorization, self.corners)

    @property
    def gauge_free(self) -> bool:
        """Whether neither a boundary nor a feature fixes the direction of the crosses."""
        return not self.surface.boundary_loops and not len(self.discretization.features)

    def in_gauge(self, angle: float) -> IsotropicSolver:
        """Return the same solver with all crosses of its fields turned by an angle.

        Parameters
        ----------
        angle : float
            Radians.

        Raises
        ------
        CrossviewError
            If a boundary or a feature fixes their direction.
        """
        if not self.gauge_free:
            raise CrossviewError("a boundary or a feature fixes the direction of the crosses")
        other = copy(self)
        other.gauge = self.gauge + real_number("the angle", angle)
        return other

    def following(self, discretization: Discretization) -> IsotropicSolver:
        """Return the same solver for fewer features.

        Parameters
        ----------
        discretization : Discretization
            Its own, but with those features.
        """
        other = copy(self)
        other.discretization = discretization
        return other

    def solve(self, singularities: Iterable[Singularity]) -> CrossField:
        """Return the field of a configuration, by one back-substitution and one walk.

        Parameters
        ----------
        singularities : iterable of Singularity
            Anywhere inside the surface, at most one in each triangle's interior. The field is
            the exact discrete one with each of them inserted as a vertex.

        Returns
        -------
        CrossField

        Raises
        ------
        SingularityError
            If the index budget is missed, or singularities coincide or lie on the boundary.
        """
        singularities = checked_singularities(singularities)
        require_budget(self.surface, singularities, self.corners)
        faces, weights = self.discretization.place([s.point for s in singularities])
        self._check_places(faces, weights)
        h, residual = self._certified_log_sizes(singularities, faces, weights)
        d = self.discretization
        t = d.triangulation
        offsets = self._offsets(h, singularities, faces, weights)
        theta = d.walk(offsets) + self.gauge
        if len(d.features) and not self.surface.boundary_loops:
            theta += d.turn_to_features(theta, offsets)
        defects = d.defects(theta, offsets)
        none = np.broadcast_to(0.0, (t.n_faces, 3))
        solved = WorkingField(d.working, h, theta, none, none[:, 0])
        # theta is conjugate to H.
        gradient = t.gradients(h[t.faces])
        seen = sampled(d, solved, np.stack([-gradient[:, 1], gradient[:, 0]], axis=1))
        return CrossField(
            surface=self.surface,
            singularities=singularities,
            corners=self.corners,
            method="isotropic",
            H=seen.H,
            theta=seen.theta,
            defects=defects,
            boundary_misalignment=d.boundary_misalignment(theta, offsets),
            residual=residual,
            max_closing_error=d.max_closing_error(theta, offsets, defects),
            half_log_aspect=seen.half_log_aspect,
            error_density=seen.error_density,
            convergence=Convergence(),
            feature_misalignment=d.feature_misalignment(theta, offsets),
            on_working=None if d.working.unchanged else solved,
        )

    def log_sizes(self, singularities: Iterable[Singularity]) -> FloatArray:
        """Return H alone, by one back-substitution, also where it is not checked to be a field's.

        Parameters
        ----------
        singularities : iterable of Singularity
            Anywhere on the surface, the index budget met.

        Returns
        -------
        (n,) float array
            At the vertices of the working triangulation, of mean zero.
        """
        placed = checked_singularities(singularities)
        faces, weights = self.discretization.place([s.point for s in placed])
        return self._certified_log_sizes(placed, faces, weights)[0]

    def _certified_log_sizes(
        self, singularities: Sequence[Singularity], faces: IntArray, weights: FloatArray
    ) -> tuple[FloatArray, float]:
        right = self._right_hand_side(singularities, faces, weights)
        h = np.zeros(len(right))
        h[1:], residual = self.factorization.certified(right[1:])
        return h - self.mass @ h / self.mass.sum(), residual

    def cut_graph(self, singularities: Iterable[Singularity]) -> IntArray:
        """Return the cut graph of a configuration (paper, branch cut L).

        Parameters
        ----------
        singularities : iterable of Singularity
            Those inside a triangle are met at its nearest corner.

        Returns
        -------
        (c, 2) int array
            End vertices of each edge of the surface in the cut.
        """
        own = self.surface.triangulation
        placed = checked_singularities(singularities)
        nearest = [self.surface.nearest_vertex(s.point) for s in placed]
        h = cut_graph(
            own,
            self.surface.boundary_loops,
            self.discretization.handles.chain,
            np.array(nearest, dtype=np.int64),
        )
        return np.stack([own.tail[h], own.head[h]], axis=1)

    def _check_places(self, faces: IntArray, weights: FloatArray) -> None:
        t = self.discretization.triangulation
        vertices = t.faces[faces]
        boundary = t.tail[t.boundary_halfedges]
        taken: dict[tuple[str, int], int] = {}
        for number, (face, weight) in enumerate(zip(faces, weights, strict=True), start=1):
            at = vertices[number - 1][weight > 0]
            if len(at) == 1:
                on_boundary = at[0] in boundary
            else:
                sides = (np.flatnonzero(weight <= CLEARANCE) + 1) % 3
                on_boundary = (t.twin[3 * face + sides] < 0).any()
            if on_boundary:
                raise SingularityError(
                    f"singularity {number} lies on the boundary",
                    advice="move it inside, or give the boundary a corner there",
                )
            place = ("vertex", int(at[0])) if len(at) == 1 else ("triangle", int(face))
            if place in taken:
                raise SingularityError(
                    f"singularities {taken[place]} and {number} lie in the same {place[0]}",
                    advice="move one of them away",
                )
            taken[place] = number

    def _right_hand_side(
        self, singularities: Sequence[Singularity], faces: IntArray, weights: FloatArray
    ) -> FloatArray:
        """K - (pi/2) k: both curvatures, the Diracs and the Neumann condition (paper, pdeH)."""
        t = self.discretization.triangulation
        right = t.curvatures.copy()
        for vertex, index in self.corners.items():
            right[vertex] -= QUARTER * index
        indices = np.array([s.index for s in singularities], dtype=np.float64)
        np.subtract.at(right, t.faces[faces], QUARTER * indices[:, None] * weights)
        return right

    def _offsets(
        self,
        h: FloatArray,
        singularities: Sequence[Singularity],
        faces: IntArray,
        weights: FloatArray,
    ) -> FloatArray:
        """Turns from barycentres to edge midpoints, around the singularities inside triangles."""
        t = self.discretization.triangulation
        offsets = midpoint_offsets(t, h)
        for singularity, face, weight in zip(singularities, faces, weights, strict=True):
            if weight.max() < 1:
                offsets[face] = split_offsets(
                    t.corner_positions[face], weight, singularity.index, h[t.faces[face]]
                )
        return offsets
