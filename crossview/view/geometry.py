"""Geometry of what is drawn, from plain arrays: any triangles, valid surface or not."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from crossview.view.values import Plane

FloatArray = npt.NDArray[np.floating[Any]]
IntArray = npt.NDArray[np.integer[Any]]


@dataclass(frozen=True, eq=False)
class Triangles:
    """Vertices (n, 3) and triangles (m, 3), with what several layers need of them."""

    points: FloatArray
    faces: IntArray

    @cached_property
    def diagonal(self) -> float:
        """Length of the bounding box's diagonal; 1 for a single point."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0))) or 1.0

    @property
    def corners(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Three times (m, 3)."""
        first, second, third = self.faces.T
        return self.points[first], self.points[second], self.points[third]

    @cached_property
    def barycentres(self) -> FloatArray:
        """(m, 3)."""
        a, b, c = self.corners
        return (a + b + c) / 3.0

    @cached_property
    def area_vectors(self) -> FloatArray:
        """(m, 3): normal times area."""
        a, b, c = self.corners
        return 0.5 * np.cross(b - a, c - a)

    @cached_property
    def areas(self) -> FloatArray:
        """(m,)."""
        return np.asarray(np.linalg.norm(self.area_vectors, axis=1))

    @cached_property
    def normals(self) -> FloatArray:
        """(m, 3) unit; zero for a degenerate triangle."""
        return self.area_vectors / np.where(self.areas > 0.0, self.areas, 1.0)[:, None]

    @cached_property
    def vertex_areas(self) -> FloatArray:
        """(n,): a third of the triangles around each vertex."""
        thirds = np.repeat(self.areas / 3.0, 3)
        areas = np.bincount(self.faces.ravel(), thirds, minlength=len(self.points))
        return np.asarray(areas, float)

    @cached_property
    def _edges(self) -> tuple[IntArray, IntArray, IntArray]:
        """Edges (e, 2), how many triangles have each, and the sides (3 m,) sorted by edge."""
        sides = np.sort(self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        keys = sides[:, 0].astype(np.int64) * len(self.points) + sides[:, 1]
        order = np.argsort(keys, kind="stable")
        first = np.flatnonzero(np.diff(keys[order], prepend=-1))
        counts = np.diff(first, append=len(keys))
        return sides[order[first]], counts, order

    @cached_property
    def boundary_edges(self) -> IntArray:
        """(k, 2): the edges of one triangle only."""
        edges, counts, _ = self._edges
        return np.asarray(edges[counts == 1])

    @cached_property
    def outward(self) -> int:
        """1 if closed with all normals outward, -1 if all inward, else 0."""
        a, b, c = self.faces.T
        sides = np.concatenate(
            [a * np.int64(len(self.points)) + b for a, b in ((a, b), (b, c), (c, a))]
        )
        twins = np.concatenate(
            [b * np.int64(len(self.points)) + a for a, b in ((a, b), (b, c), (c, a))]
        )
        sides.sort()
        twins.sort()
        if not np.array_equal(sides, twins) or (sides[1:] == sides[:-1]).any():
            return 0
        return int(np.sign(np.einsum("ij,ij->", self.barycentres, self.area_vectors)))

    def sharp_edges(self, degrees: float) -> IntArray:
        """(k, 2): the edges of two triangles that turn by more than an angle."""
        edges, counts, order = self._edges
        pairs = counts == 2
        at = (np.cumsum(counts) - counts)[pairs]
        left, right = (self.normals[order[i] // 3] for i in (at, at + 1))
        turned = np.einsum("ij,ij->i", left, right) < np.cos(np.radians(degrees))
        return np.asarray(edges[pairs][turned])

    @cached_property
    def plane_normal(self) -> FloatArray | None:
        """(3,) unit normal if all points lie in one plane, else None."""
        total = self.area_vectors.sum(axis=0)
        size = float(np.linalg.norm(total))
        if size == 0.0:
            return None
        normal = total / size
        flat = np.ptp(self.points @ normal) <= 1e-6 * self.diagonal
        return normal if flat else None


def dashes(
    points: FloatArray, edges: IntArray, dash: float, gap: float
) -> tuple[FloatArray, IntArray]:
    """Cut a graph of edges into dashes that run on from edge to edge.

    The phase of the pattern is the distance along the graph from one of its ends.

    Parameters
    ----------
    points : (n, 3) float
    edges : (k, 2) int
    dash, gap : float
        Lengths, in units of the points.

    Returns
    -------
    ends : (2 d, 3) float
    segments : (d, 2) int
        Index pairs into `ends`.
    """
    nodes, local = np.unique(edges, return_inverse=True)
    local = local.reshape(-1, 2)
    lengths = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)
    phase = _distances(local, lengths, len(nodes))
    near = phase[local].argmin(axis=1)
    rows = np.arange(len(edges))
    start, stop = local[rows, near], local[rows, 1 - near]
    period = dash + gap
    first = np.floor(phase[start] / period)
    number = np.ceil((phase[start] + lengths) / period) - first
    edge = np.repeat(rows, number.astype(int))
    before = np.repeat(np.cumsum(number) - number, number.astype(int))
    begin = (first[edge] + np.arange(len(edge)) - before) * period - phase[start][edge]
    end = np.minimum(begin + dash, lengths[edge])
    begin = np.maximum(begin, 0.0)
    drawn = end > begin
    edge, fractions = edge[drawn], np.stack([begin, end], axis=1)[drawn]
    fractions = fractions / lengths[edge][:, None]
    a, b = points[nodes[start[edge]]], points[nodes[stop[edge]]]
    ends = a[:, None] + fractions[:, :, None] * (b - a)[:, None]
    return ends.reshape(-1, 3), np.arange(2 * len(edge)).reshape(-1, 2)


def _distances(edges: IntArray, lengths: FloatArray, size: int) -> FloatArray:
    """Distances along the graph from an end (a node of degree 1) of every component."""
    graph = coo_array((lengths, edges.T), shape=(size, size)).tocsr()
    degree = np.bincount(edges.ravel(), minlength=size)
    distance = np.full(size, np.inf)
    while not np.isfinite(distance).all():
        left = np.flatnonzero(~np.isfinite(distance))
        source = left[np.argmin(degree[left])]
        distance = np.minimum(distance, dijkstra(graph, directed=False, indices=source))
    return distance


def section(triangles: Triangles, plane: Plane) -> FloatArray:
    """Return the ends (2 k, 3), two after each other, of where a plane meets triangles."""
    before = plane.before(triangles.points)
    sides = triangles.faces[:, [[0, 1], [1, 2], [2, 0]]]
    crossed = (before[sides] > 0).sum(axis=2) == 1
    one, other = sides[crossed].T
    share = (before[one] / (before[one] - before[other]))[:, None]
    return np.asarray((1 - share) * triangles.points[one] + share * triangles.points[other])
