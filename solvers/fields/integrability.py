"""The integrability error E of a cross-field with two scales, and its derivative.

In each triangle, with flat frame, u and v at the barycentre (paper, equation intError):

    rho1 = grad_u H2 - grad_v theta        rho2 = grad_v H1 + grad_u theta
    E^2 = sum of area (rho1^2 + rho2^2)

Unknowns, all single-valued on the uncut surface: a = -(H1 + H2) / 2 at vertices; at vertices also
s = (H2 - H1) / 2, up to the sign of the sheet, for u and v swap over odd quarter turns; and delta,
the turn of the crosses against the initial field, at inner edge midpoints (Crouzeix-Raviart). On
boundary and feature edges delta is 0: there the initial field is aligned already.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.algebra.assembly import ElementAssembly
from solvers.algebra.operators import corner_midpoint_offsets
from solvers.fields.connection import Discretization
from solvers.surface.triangulation import QUARTER, BoolArray, FloatArray, IntArray, next_halfedge

Pair = tuple[FloatArray, FloatArray]

NO_FEATURES = np.empty(0, dtype=np.int64)
"""Halfedges of features where there are none."""


def norm(values: FloatArray) -> float:
    """Return the square root of the sum of squares.

    Not by BLAS: its threads would go on spinning and hold up those of the factorisation.
    """
    return float(np.sqrt((values * values).sum()))


@dataclass(frozen=True, eq=False)
class Residual:
    """rho and its derivative in each triangle, both scaled by the square root of the area.

    Parameters
    ----------
    values : (m, 2) float array
        The scaled rho1, rho2.
    differentiate : callable
        Makes `jacobian`.
    """

    values: FloatArray
    differentiate: Callable[[], FloatArray]

    @property
    def energy(self) -> float:
        """E."""
        return norm(self.values)

    @cached_property
    def jacobian(self) -> FloatArray:
        """(m, 2, 9) derivatives by the triangle's a (3), s (3) and delta (3)."""
        return self.differentiate()

    def pulled(self, forces: FloatArray) -> FloatArray:
        """Return the (m, 9) products of the transposed derivative with forces (m, 2)."""
        first, second = self.jacobian[:, 0].T, self.jacobian[:, 1].T
        return np.asarray((first * forces[:, 0] + second * forces[:, 1]).T)

    def pushed(self, steps: FloatArray) -> FloatArray:
        """Return the (m, 2) products of the derivative with steps (m, 9)."""
        rows = [(self.jacobian[:, r].T * steps.T).sum(axis=0) for r in (0, 1)]
        return np.stack(rows).T


class Integrability:
    """The residual of integrability over one surface, around an initial field.

    Parameters
    ----------
    discretization : Discretization
        The surface.
    conjugate : (m, 3) float array
        Corner values of the (multiple-valued) function whose conjugate the initial field is.
    period_jumps : (3 m,) int array, optional
        As the attribute; by default the nearest to the initial field's turns over each edge.
    features : (k,) int array, optional
        As the attribute; by default none.
    turning : (m, 3) float array, optional
        What to turn that conjugate by at the midpoint of each halfedge (Crouzeix-Raviart,
        single-valued), radians; by default nothing.

    Attributes
    ----------
    features : (k,) int array
        One halfedge of each edge inside the surface that the initial field is aligned with and
        that every field is to stay aligned with.
    theta : (m,) float array
        The initial field at the barycentres, radians.
    offsets : (m, 3) float array
        How far it turns from there to the edge midpoints.
    period_jumps : (3 m,) int array
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
        period_jumps: IntArray | None = None,
        features: IntArray = NO_FEATURES,
        turning: FloatArray | None = None,
    ) -> None:
        self.discretization = discretization
        self.features = features
        self.triangulation = t = discretization.triangulation
        self.offsets = corner_midpoint_offsets(t.cotangents, conjugate)
        self.theta = discretization.walk(self.offsets)
        gradient = t.gradients(conjugate)
        self._turning = np.stack([-gradient[:, 1], gradient[:, 0]], axis=1)
        if turning is not None:
            mean = turning.mean(axis=1)
            self.theta = self.theta + mean
            self.offsets = self.offsets + turning - mean[:, None]
            # The function of halfedge i is 1 - 2 times the hat function of corner i + 2.
            self._turning += t.gradients(-2.0 * turning[:, [1, 2, 0]])
        midpoint = np.repeat(self.theta, 3) + self.offsets.reshape(-1)
        across = np.where(t.twin >= 0, midpoint[t.twin] - t.transport, midpoint)
        nearest = np.rint((midpoint - across) / QUARTER).astype(np.int64)
        self.period_jumps = nearest if period_jumps is None else period_jumps
        self.sheet = _sheets(t.twin, self.period_jumps).reshape(-1, 3)
        self.unknowns = self._number_unknowns()
        self.assembly = ElementAssembly(self.unknowns, int(self.unknowns.max()) + 1)

    def _number_unknowns(self) -> IntArray:
        t = self.triangulation
        doubled = np.zeros(t.n_vertices, dtype=bool)
        doubled[t.faces[self.sheet != 0]] = True
        s_number = np.where(doubled, t.n_vertices + np.cumsum(doubled) - 1, -1)
        inner = t.edge_halfedges[~self.aligned_edges]
        delta = np.full(len(t.twin), -1, dtype=np.int64)
        delta[inner] = delta[t.twin[inner]] = t.n_vertices + doubled.sum() + np.arange(len(inner))
        return np.concatenate([t.faces, s_number[t.faces], delta.reshape(-1, 3)], axis=1)

    @cached_property
    def aligned_edges(self) -> BoolArray:
        """(ne,) whether each edge is one to stay aligned with: of the boundary or a feature."""
        t = self.triangulation
        on_feature = np.zeros(len(t.twin), dtype=bool)
        on_feature[self.features] = on_feature[t.twin[self.features]] = True
        h = t.edge_halfedges
        return (t.twin[h] < 0) | on_feature[h]

    @cached_property
    def hat_stiffness(self) -> FloatArray:
        """(m, 3, 3) P1 stiffness matrix of each face."""
        x, y = self.triangulation.hat_gradients.transpose(2, 1, 0)
        products = x[:, None] * x[None] + y[:, None] * y[None]
        return np.asarray((self.triangulation.areas * products).transpose(2, 0, 1))

    def local(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return a, s (with the sheet's sign) and delta of each triangle, (m, 3) each."""
        values = self.assembly.gathered(x)
        return values[:, :3], self._signs.T * values[:, 3:6], values[:, 6:]

    @cached_property
    def _signs(self) -> FloatArray:
        return np.ascontiguousarray(self.sheet.T).astype(np.float64)

    @cached_property
    def _scale(self) -> FloatArray:
        return np.sqrt(self.triangulation.areas)

    def frozen_turning(self, x: FloatArray) -> FloatArray:
        """Return the (m, 2, 3) derivative of the scaled residual by delta, u and v frozen."""
        cos, sin = self._crosses(self.local(x)[2])
        _, (along_u, along_v) = self._along(cos, sin)
        return np.stack([-self._scale * along_v, self._scale * along_u]).transpose(2, 0, 1)

    def _crosses(self, delta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the components (m,) of u at the barycentres; v is 90 degrees further."""
        angle = self.theta + delta.mean(axis=1)
        return np.cos(angle), np.sin(angle)

    def _along(self, cos: FloatArray, sin: FloatArray) -> tuple[Pair, Pair]:
        """Return derivatives (3, m) along u and v of the hat functions and of the edges'."""
        x, y = self.triangulation.hat_gradients.transpose(2, 1, 0)
        hat = cos * x + sin * y, cos * y - sin * x
        # The function of halfedge i is 1 - 2 times the hat function of corner i + 2.
        return hat, (-2.0 * hat[0][[2, 0, 1]], -2.0 * hat[1][[2, 0, 1]])

    def residual(self, x: FloatArray) -> Residual:
        """Return the scaled residual and its derivative at the unknowns `x`."""
        a, s, delta = (values.T for values in self.local(x))
        cos, sin = self._crosses(delta.T)
        hat, edge = self._along(cos, sin)
        turn_x, turn_y = self._turning.T
        turning_u = cos * turn_x + sin * turn_y + (delta * edge[0]).sum(axis=0)
        turning_v = cos * turn_y - sin * turn_x + (delta * edge[1]).sum(axis=0)
        h1_u, h1_v = ((-(a + s) * along).sum(axis=0) for along in hat)
        h2_u, h2_v = (((s - a) * along).sum(axis=0) for along in hat)
        rho = np.stack([h2_u - turning_v, h1_v + turning_u])
        scale, signs = self._scale, self._signs

        def differentiate() -> FloatArray:
            jacobian = np.empty((2, 9, len(scale)))
            jacobian[0, :3], jacobian[1, :3] = -hat[0], -hat[1]
            jacobian[0, 3:6], jacobian[1, 3:6] = signs * hat[0], -signs * hat[1]
            jacobian[0, 6:] = (h2_v + turning_u) / 3 - edge[1]
            jacobian[1, 6:] = (turning_v - h1_u) / 3 + edge[0]
            jacobian *= scale
            return jacobian.transpose(2, 0, 1)

        return Residual((scale * rho).T, differentiate)


def _sheets(twin: IntArray, period_jumps: IntArray) -> IntArray:
    """Return on which sheet of its vertex each corner lies: 1 or -1; 0 where both are one.

    Both sheets of a corner continue into the next corner around the vertex, swapped over odd
    quarter turns; around a singularity of odd index they join.
    """
    n = len(twin)
    h = np.flatnonzero(twin >= 0)
    beside = next_halfedge(twin[h])
    odd = period_jumps[h] % 2
    rows = np.concatenate([h, h + n])
    columns = np.concatenate([beside + n * odd, beside + n * (1 - odd)])
    graph = coo_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(2 * n, 2 * n))
    _, label = connected_components(graph, directed=False)
    return np.asarray(np.sign(label[n:] - label[:n]).astype(np.int64))
