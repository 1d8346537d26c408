"""theta by the paper's second linear system: Crouzeix-Raviart least squares on the cut surface.

The walk of `solvers.fields.isotropic` gives the same answer in linear time; this solve is the
paper's own formulation and the independent check of it.
"""

from __future__ import annotations

import numpy as np

from solvers.algebra.factorization import factorized
from solvers.algebra.operators import crouzeix_raviart, midpoint_offsets
from solvers.fields.connection import Discretization
from solvers.surface.cutting import cut_graph
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray


def least_squares_theta(
    discretization: Discretization, h: FloatArray, singular_vertices: IntArray
) -> FloatArray:
    """Minimise the integral of |grad(theta) - J grad(H)|^2 (paper, equation thetaManifold).

    theta is continuous at edge midpoints but for the cut graph, where it is free to jump, and
    imposed at the reference alone. Across uncut edges the frames of the two triangles differ by
    the Levi-Civita transport and whole quarter turns.

    Parameters
    ----------
    discretization : Discretization
        The surface.
    h : (n,) float array
        H, solved for singularities at vertices.
    singular_vertices : (k,) int array
        Those vertices.

    Returns
    -------
    (m,) float array
        theta at the barycentres in the frames of the triangulation, radians.
    """
    d, t = discretization, discretization.triangulation
    cut = cut_graph(t, [t.tail[loop] for loop in d.boundary_loops], d.chain, singular_vertices)
    joined = np.setdiff1d(t.edge_halfedges[t.twin[t.edge_halfedges] >= 0], cut)
    g = t.twin[joined]
    unknown = np.arange(len(t.twin))
    unknown[g] = joined
    _, unknown = np.unique(unknown, return_inverse=True)
    matrix = crouzeix_raviart(t, unknown, int(unknown.max()) + 1)
    # Each midpoint's value in its own face's frame is its unknown plus a known turn.
    known = np.zeros(len(t.twin))
    known[g] = t.transport[joined] - QUARTER * _quarter_turns(d, h, joined)
    every = np.arange(len(t.twin))
    apart = crouzeix_raviart(t, every, len(every))
    # A |grad psi_e . J grad H| integrates to minus the difference of H along the edge.
    right = np.zeros(matrix.shape[0])
    np.add.at(right, unknown, h[t.tail] - h[t.head] - apart @ known)
    pin = int(unknown[max(d.reference, 0)])
    free = np.delete(np.arange(len(right)), pin)
    value = np.empty(len(right))
    value[pin] = _reference_angle(d, h)
    right -= matrix[:, [pin]].toarray()[:, 0] * value[pin]
    value[free] = factorized(matrix[free][:, free]).solve(right[free])
    return np.asarray((value[unknown] + known).reshape(-1, 3).mean(axis=1))


def _quarter_turns(d: Discretization, h: FloatArray, halfedges: IntArray) -> FloatArray:
    """Return how many quarter turns the frames are counted apart across each halfedge."""
    t = d.triangulation
    offset = midpoint_offsets(t, h)
    theta = np.repeat(d.walk(offset), 3) + offset.reshape(-1)
    apart = theta[halfedges] + t.transport[halfedges] - theta[t.twin[halfedges]]
    return np.rint(apart / QUARTER)


def _reference_angle(d: Discretization, h: FloatArray) -> float:
    """Return theta at the midpoint of the reference halfedge."""
    if d.reference >= 0:
        return float(d.triangulation.directions[d.reference])
    return float(midpoint_offsets(d.triangulation, h)[0, 0])
