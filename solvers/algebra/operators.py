"""Finite element matrices on an intrinsic triangulation."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csc_array

from solvers.surface.triangulation import FloatArray, IntArray, IntrinsicTriangulation


def stiffness(triangulation: IntrinsicTriangulation) -> csc_array:
    """Return the P1 stiffness (cotangent) matrix, positive semi-definite.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        Where.

    Returns
    -------
    (n, n) csc_array
        Pure numbers: u^T S u is the integral of |grad u|^2, whatever the unit of length.

    Notes
    -----
    Pinkall and Polthier 1993; the matrix of the paper's equation for H.

    Examples
    --------
    >>> from solvers.algebra import stiffness
    >>> from solvers.primitives import square
    >>> surface = square(n=4, size=3.0)
    >>> x = surface.vertices[:, 0]  # its gradient has length 1 everywhere, on an area of 9
    >>> round(float(x @ stiffness(surface.triangulation) @ x), 9)
    9.0
    """
    t = triangulation
    h = t.edge_halfedges
    return laplacian(t.n_vertices, t.tail[h], t.head[h], t.weights[h])


def laplacian(n: int, rows: IntArray, columns: IntArray, weights: FloatArray) -> csc_array:
    """Return the graph Laplacian of weighted pairs.

    Parameters
    ----------
    n : int
        Number of nodes.
    rows, columns : (k,) int array
        The pairs.
    weights : (k,) float array
        Their weights.

    Returns
    -------
    (n, n) csc_array
        Its rows sum to zero.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.algebra import laplacian
    >>> laplacian(3, np.array([0, 1]), np.array([1, 2]), np.array([1.0, 2.0])).toarray().tolist()
    [[1.0, -1.0, 0.0], [-1.0, 3.0, -2.0], [0.0, -2.0, 2.0]]
    """
    diagonal = np.bincount(rows, weights, n) + np.bincount(columns, weights, n)
    every = np.arange(n)
    data = np.concatenate([-weights, -weights, diagonal])
    i = np.concatenate([rows, columns, every])
    j = np.concatenate([columns, rows, every])
    return coo_array((data, (i, j)), shape=(n, n)).tocsc()


def lumped_mass(triangulation: IntrinsicTriangulation) -> FloatArray:
    """Return the area that belongs to each vertex, a third of its triangles.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        Where.

    Returns
    -------
    (n,) float array
        Squares of the unit of length; their sum is the surface's area.

    Examples
    --------
    >>> from solvers.algebra import lumped_mass
    >>> from solvers.primitives import square
    >>> surface = square(n=4, size=3.0)
    >>> round(float(lumped_mass(surface.triangulation).sum()), 9)
    9.0
    """
    t = triangulation
    return np.asarray(np.bincount(t.tail, np.repeat(t.areas / 3, 3), t.n_vertices))


def crouzeix_raviart(triangulation: IntrinsicTriangulation, unknown: IntArray, n: int) -> csc_array:
    """Return the Crouzeix-Raviart stiffness matrix.

    The basis function of an edge is 1 at its midpoint and 0 at the midpoints of the other two:
    1 - 2 phi, with phi the P1 function of the opposite corner.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        Where.
    unknown : (3 m,) int array
        The unknown at each halfedge's midpoint; equal for both sides where continuous.
    n : int
        Number of unknowns.

    Returns
    -------
    (n, n) csc_array
        Pure numbers: u^T S u is the integral of |grad u|^2, triangle by triangle.

    Notes
    -----
    Crouzeix and Raviart 1973; the element of the paper's theta.

    Examples
    --------
    On functions that are linear everywhere it agrees with `stiffness`:

    >>> from solvers.algebra import crouzeix_raviart
    >>> from solvers.primitives import square
    >>> surface = square(n=4, size=3.0)
    >>> edge = surface.face_edges.reshape(-1)  # one unknown for each edge
    >>> x = surface.vertices[surface.edges, 0].mean(axis=1)  # at the midpoints
    >>> matrix = crouzeix_raviart(surface.triangulation, edge, len(surface.edges))
    >>> round(float(x @ matrix @ x), 9)
    9.0
    """
    u = unknown.reshape(-1, 3)
    # Halfedges i and i + 1 of a face are opposite the corners i + 2 and i, whose P1 functions
    # couple by minus half the cotangent at the corner between the two halfedges, i + 1.
    weights = 2.0 * triangulation.cotangents[:, [1, 2, 0]]
    return laplacian(n, u.reshape(-1), u[:, [1, 2, 0]].reshape(-1), weights.reshape(-1))


def midpoint_offsets(triangulation: IntrinsicTriangulation, values: FloatArray) -> FloatArray:
    """Return how far the conjugate of a P1 function turns from barycentre to edge midpoints.

    The conjugate theta has grad(theta) = J grad(H) in each triangle (paper, equation for theta;
    J turns by +90 degrees), so the difference is J grad(H) . (midpoint - barycentre), written
    with cotangents.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        Where.
    values : (n,) float array
        Nodal values of H.

    Returns
    -------
    (m, 3) float array
        theta at the midpoint of halfedge i minus theta at the barycentre, radians.
    """
    t = triangulation
    return corner_midpoint_offsets(t.cotangents, values[t.faces])


def corner_midpoint_offsets(cotangents: FloatArray, values: FloatArray) -> FloatArray:
    """Return `midpoint_offsets` of values given by corner.

    Parameters
    ----------
    cotangents : (m, 3) float array
        Of the angle at each corner.
    values : (m, 3) float array
        H at each corner.

    Returns
    -------
    (m, 3) float array
        Radians.
    """
    flux = (cotangents[:, [2, 0, 1]] / 6.0) * (values - values[:, [1, 2, 0]])
    # flux[:, i] belongs to halfedge i. With c the cotangents, the offset at halfedge (i, j)
    # opposite k is (2 c_k (H_i - H_j) + c_j (H_i - H_k) - c_i (H_j - H_k)) / 6.
    return np.asarray(3.0 * flux - flux.sum(axis=1, keepdims=True))
