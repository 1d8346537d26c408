"""The integrability error E of a cross-field with two scales, and its derivative.

In each triangle, with flat frame, u and v at the barycentre (paper, equation intError):

    rho1 = grad_u H2 - grad_v theta        rho2 = grad_v H1 + grad_u theta
    E^2 = sum of area (rho1^2 + rho2^2)

Unknowns, all single-valued on the uncut surface: a = -(H1 + H2) / 2 at vertices; at vertices also
s = (H2 - H1) / 2, up to the sign of the sheet, for u and v swap over odd quarter turns; and delta,
the turn of the crosses against the initial field, at inner edge midpoints (Crouzeix-Raviart).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.assembly import ElementAssembly
from solvers.discretization import QUARTER, Discretization
from solvers.operators import corner_midpoint_offsets
from solvers.triangulation import FloatArray, IntArray, next_halfedge


@dataclass(frozen=True, eq=False)
class Residual:
    """rho and its derivative in each triangle, both scaled by the square root of the area.

    Parameters
    ----------
    values : (m, 2) float array
        The scaled rho1, rho2.
    jacobian : (m, 2, 9) float array
        Derivatives by the triangle's a (3), s (3) and delta (3).
    """

    values: FloatArray
    jacobian: FloatArray

    @property
    def energy(self) -> float:
        """E."""
        return float(np.linalg.norm(self.values))


class Integrability:
    """The residual of integrability over one surface, around an initial field.

    Parameters
    ----------
    discretization : Discretization
        The surface.
    conjugate : (m, 3) float array
        Corner values of the (multiple-valued) function whose conjugate the initial field is.
    quarter_turns : (3 m,) int array, optional
        As the attribute; by default the nearest to the initial field's turns over each edge.

    Attributes
    ----------
    theta : (m,) float array
        The initial field at the barycentres, radians.
    offsets : (m, 3) float array
        How far it turns from there to the edge midpoints.
    quarter_turns : (3 m,) int array
        Quarter turns from the cross of each halfedge's triangle to that of its twin's.
    sheet : (m, 3) int array
        Sign of s at each corner, 0 where it vanishes.
    assembly : ElementAssembly
        Of the unknowns a, s and delta, in this order.
    """

    def __init__(
        self,
        discretization: Discretization,
        conjugate: FloatArray,
        quarter_turns: IntArray | None = None,
    ) -> None:
        self.discretization = discretization
        self.triangulation = t = discretization.triangulation
        self.offsets = corner_midpoint_offsets(t.cotangents, conjugate)
        self.theta = discretization.walk(self.offsets)
        gradient = t.gradients(conjugate)
        self._turning = np.stack([-gradient[:, 1], gradient[:, 0]], axis=1)
        midpoint = np.repeat(self.theta, 3) + self.offsets.reshape(-1)
        across = np.where(t.twin >= 0, midpoint[t.twin] - t.transport, midpoint)
        nearest = np.rint((midpoint - across) / QUARTER).astype(np.int64)
        self.quarter_turns = nearest if quarter_turns is None else quarter_turns
        self.sheet = _sheets(t.twin, self.quarter_turns).reshape(-1, 3)
        self.unknowns = self._number_unknowns()
        self.assembly = ElementAssembly(self.unknowns, int(self.unknowns.max()) + 1)

    def _number_unknowns(self) -> IntArray:
        t = self.triangulation
        doubled = np.zeros(t.n_vertices, dtype=bool)
        doubled[t.faces[self.sheet != 0]] = True
        s_number = np.where(doubled, t.n_vertices + np.cumsum(doubled) - 1, -1)
        inner = t.edge_halfedges[t.twin[t.edge_halfedges] >= 0]
        delta = np.full(len(t.twin), -1, dtype=np.int64)
        delta[inner] = delta[t.twin[inner]] = t.n_vertices + doubled.sum() + np.arange(len(inner))
        return np.concatenate([t.faces, s_number[t.faces], delta.reshape(-1, 3)], axis=1)

    @cached_property
    def hat_gradients(self) -> FloatArray:
        """(m, 3, 2) gradients of the corners' hat functions in each face's frame."""
        t = self.triangulation
        p = t.corner_positions
        opposite = p[:, [2, 0, 1]] - p[:, [1, 2, 0]]
        turned = np.stack([-opposite[..., 1], opposite[..., 0]], axis=2)
        return np.asarray(turned / (2 * t.areas)[:, None, None])

    @cached_property
    def hat_stiffness(self) -> FloatArray:
        """(m, 3, 3) P1 stiffness matrix of each face."""
        hat, areas = self.hat_gradients, self.triangulation.areas
        return np.asarray(np.einsum("mid,mjd,m->mij", hat, hat, areas))

    def local(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return a, s (with the sheet's sign) and delta of each triangle, (m, 3) each."""
        values = self.assembly.gathered(x)
        return values[:, :3], self.sheet * values[:, 3:6], values[:, 6:]

    @property
    def edge_gradients(self) -> FloatArray:
        """(m, 3, 2) gradients of the Crouzeix-Raviart functions of each face's halfedges."""
        # That of halfedge i is 1 - 2 times the hat function of corner i + 2.
        return -2.0 * self.hat_gradients[:, [2, 0, 1]]

    def crosses(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return u and v, (m, 2) each, at the barycentres in the frames of the triangles."""
        angle = self.theta + self.local(x)[2].mean(axis=1)
        u = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return u, np.stack([-u[:, 1], u[:, 0]], axis=1)

    def frozen_turning(self, x: FloatArray) -> FloatArray:
        """Return the (m, 2, 3) derivative of the scaled residual by delta, u and v frozen."""
        u, v = self.crosses(x)
        edge, scale = self.edge_gradients, np.sqrt(self.triangulation.areas)
        both = [-np.einsum("md,mid->mi", v, edge), np.einsum("md,mid->mi", u, edge)]
        return scale[:, None, None] * np.stack(both, axis=1)

    def residual(self, x: FloatArray) -> Residual:
        """Return the scaled residual and its derivative at the unknowns `x`."""
        a, s, delta = self.local(x)
        hat, edge = self.hat_gradients, self.edge_gradients
        h1 = np.einsum("mi,mid->md", -a - s, hat)
        h2 = np.einsum("mi,mid->md", -a + s, hat)
        turning = self._turning + np.einsum("mi,mid->md", delta, edge)
        u, v = self.crosses(x)
        dot = lambda p, q: np.einsum("md,md->m", p, q)  # noqa: E731
        along = lambda w, g: np.einsum("md,mid->mi", w, g)  # noqa: E731
        rho = np.stack([dot(u, h2) - dot(v, turning), dot(v, h1) + dot(u, turning)], axis=1)
        by_angle = np.stack([dot(v, h2) + dot(u, turning), dot(v, turning) - dot(u, h1)], axis=1)
        hat_u, hat_v = along(u, hat), along(v, hat)
        first = [-hat_u, self.sheet * hat_u, by_angle[:, :1] / 3 - along(v, edge)]
        second = [-hat_v, -self.sheet * hat_v, by_angle[:, 1:] / 3 + along(u, edge)]
        jacobian = np.stack([np.concatenate(first, 1), np.concatenate(second, 1)], axis=1)
        scale = np.sqrt(self.triangulation.areas)
        return Residual(scale[:, None] * rho, scale[:, None, None] * jacobian)


def _sheets(twin: IntArray, quarter_turns: IntArray) -> IntArray:
    """Return on which sheet of its vertex each corner lies: 1 or -1; 0 where both are one.

    Both sheets of a corner continue into the next corner around the vertex, swapped over odd
    quarter turns; around a singularity of odd index they join.
    """
    n = len(twin)
    h = np.flatnonzero(twin >= 0)
    beside = next_halfedge(twin[h])
    odd = quarter_turns[h] % 2
    rows = np.concatenate([h, h + n])
    columns = np.concatenate([beside + n * odd, beside + n * (1 - odd)])
    graph = coo_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(2 * n, 2 * n))
    _, label = connected_components(graph, directed=False)
    return np.sign(label[n:] - label[:n]).astype(np.int64)
