"""Weighted graphs over vertices or triangles whose edges remember the halfedge they stand for."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from solvers.surface.triangulation import FloatArray, IntArray


class HalfedgeGraph:
    """A graph that keeps, of parallel edges, the lightest.

    Parameters
    ----------
    n : int
        Number of nodes.
    rows, columns : (k,) int array
        Ends of each edge; list both directions.
    weights : (k,) float array
        Positive weights.
    halfedges : (k,) int array
        What each edge stands for.
    """

    def __init__(
        self, n: int, rows: IntArray, columns: IntArray, weights: FloatArray, halfedges: IntArray
    ) -> None:
        self._n = np.int64(n)
        key = rows * self._n + columns
        order = np.lexsort((weights, key))
        lightest = order[np.r_[True, np.diff(key[order]) > 0]] if len(order) else order
        self._key = key[lightest]
        self._halfedges = halfedges[lightest]
        start = np.searchsorted(rows[lightest], np.arange(n + 1))
        self.matrix = csr_array((weights[lightest], columns[lightest], start), shape=(n, n))

    def halfedges(self, rows: IntArray, columns: IntArray) -> IntArray:
        """Return the halfedges of edges given by their ends."""
        return self._halfedges[np.searchsorted(self._key, rows * self._n + columns)]


def walk_back(predecessor: IntArray, node: int) -> list[int]:
    """Return the nodes from `node` back to where its shortest path started."""
    path = [node]
    while predecessor[node] >= 0:
        node = int(predecessor[node])
        path.append(node)
    return path
