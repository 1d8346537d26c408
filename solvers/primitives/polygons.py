"""A mesher for planar polygons: near-equilateral Delaunay triangles, the boundary as given."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay, QhullError, cKDTree

from solvers.errors import SurfaceError
from solvers.primitives.checks import affordable, positive
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface

SMOOTHING = 20
"""Rounds of moving the interior points. Chosen; the triangles hardly change after these."""

CLEARANCE = 0.7
"""Least distance of the first interior points from the boundary's, in edge lengths. Chosen."""

PENTAGON = ((-1.5, -1.5), (1.5, -1.5), (1.5, -0.5), (-0.5, 1.5), (-1.5, 1.5))
"""Corners (x, y) of the polygon that is meshed where none is given: a square cut at one corner."""


def planar(
    outer: npt.ArrayLike = PENTAGON,
    holes: Sequence[npt.ArrayLike] = (),
    edge_length: float = 0.08,
) -> TriSurface:
    """Mesh a polygon in the plane z = 0.

    Parameters
    ----------
    outer : (k, 2) array_like
        Corners of the outer boundary, either way round.
    holes : sequence of (k, 2) array_like, optional
        Corners of each hole.
    edge_length : float, optional
        Wanted length of the edges. Sides are divided evenly; shorter sides stay whole.

    Returns
    -------
    TriSurface
        With the polygons' corners among its vertices, in their order.

    Raises
    ------
    SurfaceError
        When a polygon crosses itself or another, or a gap is too narrow for the edge length.

    Notes
    -----
    A triangular lattice, moved towards an optimal Delaunay triangulation (Chen and Xu 2004).

    Examples
    --------
    >>> from solvers.primitives import planar
    >>> hole = [[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75]]
    >>> surface = planar([[0, 0], [3, 0], [0, 3]], [hole], edge_length=0.25)
    >>> round(surface.area, 9), len(surface.boundary_loops)
    (4.25, 2)
    """
    h = positive("edge_length", edge_length)
    if not isinstance(holes, Sequence):
        raise SurfaceError(f"holes must be a list of polygons, not {holes!r}")
    rings = [_ring(outer, 1.0), *(_ring(hole, -1.0) for hole in holes)]
    affordable(_area(rings[0]) / h / h)
    affordable(sum(float(_sides(ring)[1].sum()) for ring in rings) / h)
    loops = [_divide(ring, h) for ring in rings]
    points, faces = fill(loops, _lattice(loops, h))
    return TriSurface(np.column_stack([points, np.zeros(len(points))]), faces)


def fill(loops: Sequence[FloatArray], interior: FloatArray) -> tuple[FloatArray, IntArray]:
    """Triangulate the plane region to the left of closed polygons.

    Parameters
    ----------
    loops : sequence of (k, 2) float array
        Boundary polygons, the region on their left.
    interior : (p, 2) float array
        Points inside; they are moved for better triangles (towards an optimal Delaunay
        triangulation: each to the area-weighted mean of the circumcentres around it).

    Returns
    -------
    points : (n, 2) float array
        The loops' points in order, then the interior ones.
    faces : (m, 3) int array
        Counter-clockwise triangles.
    """
    boundary = _loop_edges(loops)
    points = np.concatenate([*loops, interior])
    free = np.arange(len(points)) >= len(boundary)
    faces = _triangulate(points, boundary)
    for _ in range(SMOOTHING if free.any() else 0):
        points = np.where(free[:, None], _optimal_positions(points, faces), points)
        faces = _triangulate(points, boundary)
    return points, faces


def _ring(corners: npt.ArrayLike, sign: float) -> FloatArray:
    try:
        ring = np.array(corners, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        ring = np.empty(0)
    if ring.ndim != 2 or ring.shape[0] < 3 or ring.shape[1] != 2 or not np.isfinite(ring).all():
        raise SurfaceError("a polygon needs three or more corners [x, y] with finite numbers")
    if _area(ring) == 0 or (np.roll(ring, -1, axis=0) == ring).all(axis=1).any():
        raise SurfaceError("a polygon has no area, or repeats a corner")
    return ring if _area(ring) * sign > 0 else ring[::-1]


def _area(ring: FloatArray) -> float:
    following = np.roll(ring, -1, axis=0)
    return 0.5 * float((ring[:, 0] * following[:, 1] - ring[:, 1] * following[:, 0]).sum())


def _sides(ring: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the vectors (k, 2) and lengths (k,) of a polygon's sides."""
    side = np.roll(ring, -1, axis=0) - ring
    return side, np.linalg.norm(side, axis=1)


def _divide(ring: FloatArray, h: float) -> FloatArray:
    side, length = _sides(ring)
    parts = np.maximum(np.rint(length / h).astype(int), 1)
    step = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    share = (step / np.repeat(parts, parts))[:, None]
    return np.asarray(np.repeat(ring, parts, axis=0) + share * np.repeat(side, parts, axis=0))


def _lattice(loops: Sequence[FloatArray], h: float) -> FloatArray:
    """Return the points of a triangular lattice inside the loops, clear of the boundary."""
    fixed = np.concatenate(loops)
    low, high = fixed.min(axis=0), fixed.max(axis=0)
    columns, rows = np.ceil((high - low) / [h, h * np.sqrt(0.75)]).astype(int) + 1
    j, i = np.mgrid[0:rows, 0:columns].reshape(2, -1)
    points = np.column_stack([i + 0.5 * (j % 2), j * np.sqrt(0.75)]) * h
    points += 0.5 * (low + high - points.min(axis=0) - points.max(axis=0))
    triangulation = _delaunay(fixed)
    # one more entry, the last, answers for points outside every triangle (-1)
    inside = np.append(_inside(triangulation, _loop_edges(loops)), False)
    clear = cKDTree(fixed).query(points)[0] > CLEARANCE * h
    return np.asarray(points[clear & inside[triangulation.find_simplex(points)]])


def _loop_edges(loops: Sequence[FloatArray]) -> IntArray:
    """Return the (k, 2) directed edges of loops whose points are numbered one after another."""
    edges = []
    first = 0
    for loop in loops:
        numbers = first + np.arange(len(loop))
        edges.append(np.stack([numbers, np.roll(numbers, -1)], axis=1))
        first += len(loop)
    return np.concatenate(edges)


def _triangulate(points: FloatArray, boundary: IntArray) -> IntArray:
    triangulation = _delaunay(points)
    return np.asarray(triangulation.simplices[_inside(triangulation, boundary)].astype(np.int64))


def _delaunay(points: FloatArray) -> Delaunay:
    try:
        return Delaunay(points)
    except QhullError:
        raise SurfaceError("the polygon's corners lie on one line") from None


def _inside(triangulation: Delaunay, boundary: IntArray) -> npt.NDArray[np.bool_]:
    """Return which triangles lie left of the directed boundary edges.

    Raises
    ------
    SurfaceError
        When a boundary edge is missing, or does not part inside from outside.
    """
    n = len(triangulation.points)
    simplices = triangulation.simplices.astype(np.int64)
    # column i: the edge opposite to corner i, counter-clockwise
    tail, head = simplices[:, [1, 2, 0]], simplices[:, [2, 0, 1]]
    left = np.isin(tail * n + head, boundary[:, 0] * n + boundary[:, 1])
    right = np.isin(tail * n + head, boundary[:, 1] * n + boundary[:, 0])
    if left.sum() != len(boundary):
        raise SurfaceError(
            f"{len(boundary) - left.sum()} boundary edges do not fit into the triangulation",
            advice="choose a smaller edge length, and polygons that do not cross",
        )
    triangle, corner = np.nonzero(~(left | right) & (triangulation.neighbors >= 0))
    links = (triangle, triangulation.neighbors[triangle, corner])
    graph = coo_array((np.ones(len(triangle), dtype=np.int8), links), (len(simplices),) * 2)
    label = connected_components(graph, directed=False)[1]
    inner, outer = label[left.any(axis=1)], label[right.any(axis=1)]
    if np.isin(outer, inner).any():
        raise SurfaceError(
            "the polygons do not bound one region", advice="keep holes inside and apart"
        )
    return np.asarray(np.isin(label, inner))


def _optimal_positions(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return for each point the area-weighted mean of the circumcentres around it."""
    a = points[faces[:, 0]]
    b, c = points[faces[:, 1]] - a, points[faces[:, 2]] - a
    double_area = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
    bb, cc = (b**2).sum(axis=1), (c**2).sum(axis=1)
    offset = np.column_stack([c[:, 1] * bb - b[:, 1] * cc, b[:, 0] * cc - c[:, 0] * bb])
    # twice the area times the circumcentre: no division, slivers do no harm
    weighted = a * double_area[:, None] + 0.5 * offset
    corner = faces.reshape(-1)
    weight = np.bincount(corner, np.repeat(double_area, 3), len(points))
    sums = [np.bincount(corner, np.repeat(weighted[:, i], 3), len(points)) for i in range(2)]
    return np.asarray(np.stack(sums, axis=1) / weight[:, None])
