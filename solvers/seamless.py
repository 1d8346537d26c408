"""The seamless map: every edge's image in the plane, consistent up to whole quarter turns.

The unknown is one vector for each edge, in the frame of its triangle's cross; the other side sees
it turned by the matching. The three vectors of a triangle close, boundary edges have no component
across, and the vectors stay as near as possible to what the field asks for.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csc_array, diags_array

from solvers.factorization import factorized
from solvers.integrability import Integrability
from solvers.triangulation import FloatArray, IntArray

LEAST_WEIGHT = 0.05
"""Edges opposite right or obtuse angles still count this much, in cotangents."""


@dataclass(frozen=True, eq=False)
class SeamlessMap:
    """The images of a surface's edges.

    Parameters
    ----------
    images : (m, 3, 2) float array
        Image of each halfedge in the frame of its triangle's cross: along u, along v.
    distance : float
        How far they are from what the field asks for, relative, in the weighted norm.
    """

    images: FloatArray
    distance: float

    @property
    def flipped(self) -> IntArray:
        """Triangles whose image is turned over or has no area."""
        first, last = self.images[:, 0], self.images[:, 2]
        area = last[:, 0] * first[:, 1] - last[:, 1] * first[:, 0]
        return np.flatnonzero(area <= 0)


def seamless_map(integrability: Integrability, x: FloatArray) -> SeamlessMap:
    """Return the seamless map nearest to a field, by one sparse solve.

    Parameters
    ----------
    integrability : Integrability
        The problem whose unknowns `x` are.
    x : (N,) float array
        The field.

    Returns
    -------
    SeamlessMap
    """
    t = integrability.triangulation
    edges = t.edge_halfedges
    wanted = _wanted(integrability, x)[edges]
    weight = np.maximum(t.weights[edges], LEAST_WEIGHT / 2)
    closing = _closing(integrability, edges)
    free = _free(integrability, edges)
    inverse = np.repeat(1 / weight, 2) * free.reshape(-1)
    wanted = np.where(free, wanted, 0.0)
    schur = closing @ diags_array(inverse) @ closing.T
    # On a flat torus the closing of all triangles together is no condition.
    schur = csc_array(schur + 1e-13 * diags_array(schur.diagonal()))
    gap = closing @ wanted.reshape(-1)
    correction = inverse * (closing.T @ factorized(schur).solve(gap))
    moved = wanted - correction.reshape(-1, 2)
    squares = np.repeat(weight, 2)
    distance = np.sqrt(squares @ correction**2 / (squares @ wanted.reshape(-1) ** 2))
    images = (_to_halfedges(integrability, edges) @ moved.reshape(-1)).reshape(-1, 3, 2)
    return SeamlessMap(images, float(distance))


def _wanted(integrability: Integrability, x: FloatArray) -> FloatArray:
    """Return what the field makes of each halfedge (3 m, 2): its lengths over the sizes."""
    i, t = integrability, integrability.triangulation
    a, s, delta = i.local(x)
    following = np.array([1, 2, 0])
    a = (a + a[:, following]) / 2
    s = (s + s[:, following]) / 2
    angle = t.directions - (i.theta[:, None] + i.offsets + delta).reshape(-1)
    length = t.lengths.reshape(-1)
    # Sizes are exp(H1) = exp(-a - s) along u and exp(H2) = exp(-a + s) along v.
    along_u = np.exp((a + s).reshape(-1)) * length * np.cos(angle)
    along_v = np.exp((a - s).reshape(-1)) * length * np.sin(angle)
    return np.stack([along_u, along_v], axis=1)


def _to_halfedges(integrability: Integrability, edges: IntArray) -> csc_array:
    """Return the (6 m, 2 ne) matrix from edges' images to those of all halfedges."""
    t = integrability.triangulation
    inner = t.twin[edges] >= 0
    number = np.arange(len(edges))
    h = np.concatenate([edges, t.twin[edges[inner]]])
    column = np.concatenate([number, number[inner]])
    # The twin runs the other way, and its cross is p quarter turns behind.
    turns = np.concatenate(
        [np.zeros(len(edges), int), 2 + integrability.quarter_turns[edges[inner]]]
    )
    cosine = np.array([1, 0, -1, 0])[turns % 4]
    sine = np.array([0, 1, 0, -1])[turns % 4]
    rows = np.concatenate([2 * h, 2 * h, 2 * h + 1, 2 * h + 1])
    columns = np.concatenate([2 * column, 2 * column + 1, 2 * column, 2 * column + 1])
    values = np.concatenate([cosine, -sine, sine, cosine]).astype(np.float64)
    return coo_array((values, (rows, columns)), shape=(2 * len(t.twin), 2 * len(edges))).tocsc()


def _closing(integrability: Integrability, edges: IntArray) -> csc_array:
    """Return the (2 m, 2 ne) matrix that sums the edges of each triangle."""
    m = integrability.triangulation.n_faces
    rows = np.repeat(np.arange(m), 3)
    summing = coo_array(
        (
            np.ones(6 * m),
            (np.stack([2 * rows, 2 * rows + 1], axis=1).reshape(-1), np.arange(6 * m)),
        ),
        shape=(2 * m, 6 * m),
    ).tocsc()
    return csc_array(summing @ _to_halfedges(integrability, edges))


def _free(integrability: Integrability, edges: IntArray) -> np.ndarray:
    """Return which components (ne, 2) are free: on the boundary only the one along it."""
    i, t = integrability, integrability.triangulation
    free = np.ones((len(edges), 2), dtype=bool)
    border = t.twin[edges] < 0
    h = edges[border]
    angle = t.directions[h] - (i.theta[:, None] + i.offsets).reshape(-1)[h]
    along_v = np.rint(angle / (np.pi / 2)).astype(int) % 2
    free[border, 0] = along_v == 0
    free[border, 1] = along_v == 1
    return free
