"""A surface's curvature without details: what curves it over lengths below some scale.

The Gauss curvature K of the vertices diffuses to K~, as heat does in a time for which a point
spreads over the scale. No other surface is made: the angles of the triangles' corners change as
under a conformal change of the metric, to first order,

    S phi = K~ - K,    angle_i += 1/2 cot_k (phi_j - phi_i) + 1/2 cot_j (phi_k - phi_i),

so that they sum to pi in each triangle and to 2 pi - K~ around each vertex. On features and the
boundary the angles of all sectors stay what they are: quads there have to fit them.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.sparse.csgraph import dijkstra

from solvers.algebra.factorization import factorized
from solvers.algebra.operators import laplacian, lumped_mass
from solvers.features.edges import Features
from solvers.surface.sectors import corner_sectors
from solvers.surface.triangulation import (
    BoolArray,
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
    next_halfedge,
)

STEPS = 4
"""Implicit steps that the time of diffusion is divided into. Chosen: near a Gaussian's spread."""

SHIFT = 1e-10
"""Of the system for phi, which it leaves regular, in parts of one over the area. Chosen."""


def angles_without_details(features: Features, scale: float) -> FloatArray:
    """Return the angles of a surface's corners with its curvature smoothed.

    Parameters
    ----------
    features : Features
        Of the surface; curvature stays within the regions that they enclose.
    scale : float
        Length over which curvature is spread, twice the standard deviation of heat from a point.

    Returns
    -------
    (m, 3) float array
        Radians, with sum pi in each triangle; not always between 0 and pi.

    Examples
    --------
    A bump in a plane is a detail, the whole sphere is not:

    >>> import numpy as np
    >>> from solvers.features import no_features
    >>> from solvers.fields.details import angles_without_details, curvatures_of
    >>> from solvers.primitives import sphere, square
    >>> from solvers.surface import TriSurface
    >>> flat = square(n=20)
    >>> x, y, _ = flat.vertices.T
    >>> bump = 0.1 * np.exp(-(x**2 + y**2) / 0.1**2)
    >>> surface = TriSurface(np.stack([x, y, bump], axis=1), flat.faces)
    >>> angles = angles_without_details(no_features(surface), 0.5)
    >>> smooth = curvatures_of(surface.triangulation, angles)
    >>> inner = ~surface.boundary_vertices
    >>> bool(np.abs(smooth[inner]).max() < 0.1 * np.abs(surface.angle_defects[inner]).max())
    True
    >>> ball = sphere(subdivisions=2)
    >>> angles = angles_without_details(no_features(ball), 0.5)
    >>> smooth = curvatures_of(ball.triangulation, angles)
    >>> np.allclose(smooth, ball.angle_defects, rtol=0.1)
    True
    """
    surface = features.surface
    t = surface.triangulation
    fixed = surface.boundary_vertices.copy()
    fixed[features.ends] = True
    marked = np.isin(t.face_edges.reshape(-1), features.edges)
    diffused = _diffused(t, fixed, (scale / 2) ** 2 / 2)
    sector = corner_sectors(t, marked)
    count = int(sector.max()) + 1
    change = np.zeros(count)
    change[sector] = (diffused - t.curvatures)[t.tail]  # 0 in the sectors of what is fixed
    phi = _potential(t, sector, change)[sector].reshape(-1, 3)
    cotangents = t.cotangents
    after, before = np.roll(phi, -1, axis=1) - phi, np.roll(phi, 1, axis=1) - phi
    turn = np.roll(cotangents, 1, axis=1) * after + np.roll(cotangents, -1, axis=1) * before
    return np.asarray(t.angles + 0.5 * turn)


def settled(features: Features, index: IntArray, scale: float) -> IntArray:
    """Return indices with those near a vertex moved there whose own curvature asks for them.

    The corner of a cube is no detail, but its curvature is spread like any other.

    Parameters
    ----------
    features : Features
        Of the surface of n vertices and m triangles; no index moves on or across them.
    index : (n + m,) int array
        Of the vertices and the triangles.
    scale : float
        How far they move at most, along edges.

    Returns
    -------
    (n + m,) int array
        With the same sum; a curvature of pi/2 asks for 1.

    Examples
    --------
    The corners of a tetrahedron have the curvature pi each and ask for 2, the middle of an edge
    for nothing:

    >>> import numpy as np
    >>> from solvers.features import no_features
    >>> from solvers.fields.details import settled
    >>> from solvers.surface import TriSurface
    >>> points = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1], [0, 0, -1.0]])
    >>> faces = [[0, 1, 4], [0, 4, 2], [0, 2, 3], [0, 3, 1], [1, 3, 4], [4, 3, 2]]
    >>> surface = TriSurface(points, np.array(faces))
    >>> index = np.array([2, 0, 0, 2, 2, 0, 0, 0, 0, 2, 0])
    >>> settled(no_features(surface), index, 1.0).tolist()
    [2, 2, 0, 2, 2, 0, 0, 0, 0, 0, 0]
    >>> settled(no_features(surface), index, 1.5).tolist()
    [2, 2, 2, 2, 0, 0, 0, 0, 0, 0, 0]
    """
    surface = features.surface
    t, n = surface.triangulation, surface.n_vertices
    barred = surface.boundary_vertices.copy()
    barred[surface.edges[features.edges]] = True
    asked = np.where(barred, 0, np.rint(t.curvatures / (np.pi / 2))).astype(np.int64)
    ends = surface.edges[~barred[surface.edges].any(axis=1)]
    length = np.linalg.norm(np.subtract(*surface.vertices[ends].transpose(1, 0, 2)), axis=1)
    graph = csr_array((length, (ends[:, 0], ends[:, 1])), shape=(n, n))
    index = index.copy()
    sites = np.flatnonzero(index)
    for site in sites[(sites >= n) | (asked[sites % n] != index[sites])].tolist():
        start = [site] if site < n else surface.faces[site - n]
        away = dijkstra(graph, directed=False, indices=start, limit=scale, min_only=True)
        away[(index[:n] != 0) | (asked != index[site])] = np.inf
        nearest = int(np.argmin(away))
        if np.isfinite(away[nearest]):
            index[nearest], index[site] = index[site], 0
    return index


def curvatures_of(triangulation: IntrinsicTriangulation, angles: FloatArray) -> FloatArray:
    """Return the curvatures of the vertices if the corners had other angles.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        Of n vertices and m triangles.
    angles : (m, 3) float array
        Radians.

    Returns
    -------
    (n,) float array
    """
    t = triangulation
    return t.curvatures - np.bincount(t.tail, (angles - t.angles).reshape(-1), t.n_vertices)


def _diffused(t: IntrinsicTriangulation, fixed: BoolArray, time: float) -> FloatArray:
    """Return the curvatures after a time, what is fixed neither giving nor taking any."""
    h = t.edge_halfedges
    h = h[~(fixed[t.tail[h]] | fixed[t.head[h]])]
    # Negative weights would let curvature grow.
    weights = np.maximum(t.weights[h], 0.0)
    mass = lumped_mass(t)
    step = time / STEPS * laplacian(t.n_vertices, t.tail[h], t.head[h], weights)
    factor = factorized((step + diags_array(mass)).tocsc())
    density = t.curvatures / mass
    for _ in range(STEPS):
        density = factor.solve(mass * density)
    return np.where(fixed, t.curvatures, mass * density)


def _potential(t: IntrinsicTriangulation, sector: IntArray, right: FloatArray) -> FloatArray:
    """Return phi of all sectors, with no flow from one to another across features."""
    n = len(right)
    h = np.arange(len(t.twin))
    half = 0.5 * np.roll(t.cotangents, 1, axis=1).reshape(-1)  # opposite each halfedge
    stiff = laplacian(n, sector[h], sector[next_halfedge(h)], half)
    mass = np.bincount(sector, np.repeat(t.areas / 3, 3), n)
    shift = SHIFT / float(t.areas.sum())
    return factorized((stiff + diags_array(shift * mass)).tocsc()).solve(right)
