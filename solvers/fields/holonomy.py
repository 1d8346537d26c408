"""Which configurations are valid: holonomy defects by look-up (Abel-Jacobi).

A configuration that meets the index budget has a boundary-aligned, consistent isotropic field
exactly when every defect is zero (paper, section "Valid singularity configurations").
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

import numpy as np

from solvers.algebra.factorization import Factorization
from solvers.fields.connection import Condition, Discretization
from solvers.singularities.budget import Singularity, checked_singularities
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray, next_halfedge, wrap


class Holonomy:
    """The holonomy defects of any configuration on one surface.

    For each condition i with dual path gamma_i, the holonomy potential Z_i solves
    S Z_i = B^T w gamma_i. The path's rotation is linear in H, and S H = K - (pi/2) k, so

        r_i = wrap(transport_i - Z_i . K + (pi/2) sum_j k_j Z_i(x_j))

    One back-substitution a condition, once; then a table look-up a configuration.

    Parameters
    ----------
    discretization : Discretization
        The surface.
    factorization : Factorization
        Of the stiffness matrix without its first row and column.
    corners : mapping of int to int
        Index of each boundary vertex where the field turns.

    Examples
    --------
    On an annulus the defect is the sum of indices times polar angles, over four:

    >>> import numpy as np
    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> surface = annulus(n=24)
    >>> holonomy = IsotropicSolver(surface).holonomy
    >>> three = Singularity(surface.closest_point([0.8, 0.0, 0.0]), 3)
    >>> for place in ([0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [-0.5, 0.0, 0.0]):
    ...     five = Singularity(surface.closest_point(place), 5)
    ...     print(np.degrees(np.abs(holonomy.defects([three, five]))).round(6))
    [0.]
    [22.5]
    [45.]
    """

    def __init__(
        self,
        discretization: Discretization,
        factorization: Factorization,
        corners: Mapping[int, int],
    ) -> None:
        self.discretization = discretization
        t = discretization.triangulation
        h = t.edge_halfedges
        forms = np.zeros((len(self.conditions), len(t.twin)), dtype=np.int64)
        for row, condition in zip(forms, self.conditions, strict=True):
            row[:] = discretization.dual_path(condition)
        nodal = np.zeros((len(self.conditions), t.n_vertices))
        for values, form in zip(nodal, forms, strict=True):
            flow = form[h] * t.weights[h]
            np.add.at(values, t.head[h], flow)
            np.subtract.at(values, t.tail[h], flow)
        nodal[:, 0] = 0.0
        nodal[:, 1:] = factorization.solve(nodal[:, 1:].T).T
        level = np.zeros((t.n_faces, 3))
        curvature = t.curvatures.copy()
        for vertex, index in corners.items():
            curvature[vertex] -= QUARTER * index
        transported = discretization.defects(discretization.walk(level), level)
        self._constant = transported - nodal @ curvature
        jumps = forms.reshape(len(forms), t.n_faces, 3)
        # Along a halfedge Z changes by the nodal difference less the jump across the path.
        self._corner_values = nodal[:, t.faces]
        self._corner_values[:, :, 1] -= jumps[:, :, 0]
        self._corner_values[:, :, 2] -= jumps[:, :, 0] + jumps[:, :, 1]
        self._paths = forms

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """The 2 g + max(b - 1, 0) conditions."""
        return self.discretization.conditions

    @cached_property
    def surface_values(self) -> FloatArray:
        """(c, m, 3) the potentials at the corners of the surface's own triangles.

        From one triangle to the next they jump by how often the condition's path crosses; inside
        triangles that the operator has others for they are linear only in between vertices.
        """
        d = self.discretization
        if d.working.unchanged:
            return self._corner_values
        nodal = np.empty((len(self.conditions), d.triangulation.n_vertices))
        nodal[:, d.triangulation.faces] = self._corner_values
        faces = np.arange(d.surface.n_faces)
        centre = self.values_at(faces, np.full((len(faces), 3), 1 / 3))[:, :, None]
        own = nodal[:, d.surface.faces]
        return np.asarray(own + np.rint(centre - own))

    def corner_values(self, faces: IntArray) -> FloatArray:
        """Return the potentials at the corners of triangles of the working triangulation.

        Parameters
        ----------
        faces : (k,) int array
            Their numbers there, as of `Discretization.place`.

        Returns
        -------
        (c, k, 3) float array
            Up to whole numbers.
        """
        return np.asarray(self._corner_values[:, faces])

    def values_at(self, faces: IntArray, weights: FloatArray) -> FloatArray:
        """Return the exact values of the potentials at points of the surface.

        Parameters
        ----------
        faces : (k,) int array
            The points' triangles.
        weights : (k, 3) float array
            Their barycentric weights.

        Returns
        -------
        (c, k) float array
            Up to whole numbers.
        """
        d = self.discretization
        located = d.working.locate(faces, d.surface.triangulation.places(faces, weights))
        at = d.triangulation.weights_at(located.face, located.place)
        return np.asarray(np.einsum("ckj,kj->ck", self._corner_values[:, located.face], at))

    def defects(self, singularities: Iterable[Singularity]) -> FloatArray:
        """Return the defects of a configuration, without solving.

        Parameters
        ----------
        singularities : iterable of Singularity
            Anywhere on the surface.

        Returns
        -------
        (2 g + max(b - 1, 0),) float array
            Radians in (-pi/4, pi/4]; meaningful when the index budget is met.
        """
        placed = checked_singularities(singularities)
        faces, weights = self.discretization.place([s.point for s in placed])
        index = np.array([s.index for s in placed], dtype=np.float64)
        potential = np.einsum("ckj,kj->ck", self.corner_values(faces), weights)
        return wrap(self._constant + QUARTER * potential @ index, QUARTER)

    def gradients(self, points: Sequence[SurfacePoint]) -> FloatArray:
        """Return the gradients of the holonomy potentials.

        Parameters
        ----------
        points : sequence of SurfacePoint
            Where.

        Returns
        -------
        (c, k, 2) float array
            In the frames of the points' triangles. Moving a singularity of index k_j by d
            changes defect i by (pi/2) k_j grad Z_i . d.
        """
        at = self.discretization.locate(points)
        return self.discretization.gradients(self._corner_values[:, at.face], at)

    def harmonic_correction(self, turns: FloatArray) -> FloatArray:
        """Return what to add to H so that the defects change by given angles, and nothing else.

        A multiple-valued function whose gradient is the harmonic 1-form sum c_i eta_i with
        eta_i = dZ_i - gamma_i; the rotation over path j changes by P_ji c_i, where
        P_ij = <gamma_i, eta_j> with the cotangent weights.

        Parameters
        ----------
        turns : (2 g + max(b - 1, 0),) float array
            Radians to add to each defect.

        Returns
        -------
        (m, 3) float array
            Values at the corners of the triangulation's triangles.
        """
        coefficients = np.linalg.solve(self.harmonic_energy, turns)
        return np.asarray(np.einsum("c,cmi->mi", coefficients, self._corner_values))

    def aligned_energy(self, angle: float) -> float:
        """Return the most E of a field that is aligned where the defects are up to an angle.

        E^2 is that of the harmonic correction, r P^-1 r for defects r.

        Parameters
        ----------
        angle : float
            Of the defects, radians.
        """
        if not len(self.conditions):
            return 0.0
        return angle * float(np.sqrt(np.abs(np.linalg.inv(self.harmonic_energy)).sum()))

    @cached_property
    def harmonic_energy(self) -> FloatArray:
        """(c, c) products <eta_i, eta_j> = -<gamma_i, eta_j> of the harmonic 1-forms."""
        t = self.discretization.triangulation
        h = t.edge_halfedges
        after = next_halfedge(h)
        values = self._corner_values.reshape(len(self._paths), len(t.twin))
        harmonic = values[:, after] - values[:, h]
        return np.asarray(-(self._paths[:, h] * t.weights[h]) @ harmonic.T)
