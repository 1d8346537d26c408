"""Which faces meet at a vertex, and which sides of faces are one edge."""

from __future__ import annotations

import numpy as np

from solvers.surface.triangulation import BoolArray, IntArray


class CornersAround:
    """The corners of faces at each vertex.

    Parameters
    ----------
    faces : (m, k) int array
        Vertices of the faces.
    n_vertices : int
        How many vertices there are.
    """

    def __init__(self, faces: IntArray, n_vertices: int) -> None:
        corner = faces.reshape(-1)
        self._corner = np.argsort(corner, kind="stable")
        self._start = np.concatenate([[0], np.cumsum(np.bincount(corner, minlength=n_vertices))])

    def pairs(self, vertices: IntArray) -> tuple[IntArray, IntArray]:
        """Return position in `vertices` and corner, for all corners at all of them in order."""
        start = self._start[vertices]
        count = self._start[vertices + 1] - start
        step = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        position = np.repeat(np.arange(len(vertices)), count)
        return position, self._corner[np.repeat(start, count) + step]


def edge_table(quads: IntArray) -> tuple[IntArray, IntArray]:
    """Return the edges (e, 2), smaller number first, and the edge of each side (4 q,) of quads."""
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)
    ends.sort(axis=1)
    n = int(quads.max(initial=0)) + 1
    key, edge_of = np.unique(ends[:, 0] * n + ends[:, 1], return_inverse=True)
    return np.stack([key // n, key % n], axis=1), edge_of.reshape(-1)


def paired_sides(edge_of: IntArray) -> IntArray:
    """Return pairs (2, k) of sides of quads that are one edge, given the edge of each side."""
    order = np.argsort(edge_of, kind="stable")
    paired = np.flatnonzero(np.diff(edge_of[order]) == 0)
    return np.stack([order[paired], order[paired + 1]])


def grown(quads: IntArray, some: BoolArray, rings: int) -> BoolArray:
    """Return some quads (q,) and so many rings of others around them."""
    for _ in range(rings):
        touched = np.zeros(int(quads.max(initial=0)) + 1, dtype=bool)
        touched[quads[some]] = True
        some = np.asarray(touched[quads].any(axis=1))
    return some
