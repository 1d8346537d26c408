"""Shortest paths along the edges of a surface."""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import dijkstra

from solvers.errors import CrossviewError
from solvers.surface.graphs import HalfedgeGraph, walk_back
from solvers.surface.triangulation import IntArray
from solvers.surface.trisurface import TriSurface


class EdgePaths:
    """Shortest paths along the edges of a surface.

    Parameters
    ----------
    surface : TriSurface
        The surface.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import rectangle
    >>> from solvers.surface import EdgePaths
    >>> surface = rectangle(2.0, 1.0, columns=4, rows=2)
    >>> path = EdgePaths(surface).through(np.array([0, 4]))  # along the lower side
    >>> surface.edges[path].tolist()
    [[0, 1], [1, 2], [2, 3], [3, 4]]
    """

    def __init__(self, surface: TriSurface) -> None:
        self._surface = surface
        t = surface.triangulation
        h = np.arange(len(t.twin))
        border = np.flatnonzero(t.twin < 0)
        self._edge = surface.face_edges.reshape(-1)
        self._graph = HalfedgeGraph(
            t.n_vertices,
            np.concatenate([t.tail, t.head[border]]),
            np.concatenate([t.head, t.tail[border]]),
            np.concatenate([t.lengths.reshape(-1), t.lengths.reshape(-1)[border]]),
            np.concatenate([h, border]),
        )

    def through(self, vertices: IntArray) -> IntArray:
        """Return the edges of the shortest path through vertices, one after the other.

        Parameters
        ----------
        vertices : (k,) int array
            Equal ones that follow each other count once.

        Returns
        -------
        (l,) int array
            Among the surface's edges, in order.

        Raises
        ------
        CrossviewError
            If no path joins two of them, or there is no vertex of such a number.
        """
        vertices = self._surface.require_vertices(vertices)
        stops = vertices[np.flatnonzero(np.diff(vertices, prepend=-1))]
        pairs = np.stack([stops[:-1], stops[1:]], axis=1)
        steps = np.zeros(len(pairs), dtype=bool)
        if len(pairs):
            steps = np.asarray(self._graph.matrix[pairs[:, 0], pairs[:, 1]]).reshape(-1) > 0
        legs = [
            pair if step else self._between(int(pair[0]), int(pair[1]))
            for pair, step in zip(pairs, steps, strict=True)
        ]
        rows = np.concatenate([leg[:-1] for leg in legs] or [stops[:0]])
        columns = np.concatenate([leg[1:] for leg in legs] or [stops[:0]])
        return self._edge[self._graph.halfedges(rows, columns)]

    def _between(self, start: int, end: int) -> IntArray:
        _, predecessor = dijkstra(self._graph.matrix, indices=start, return_predecessors=True)
        path = np.array(walk_back(predecessor, end)[::-1], dtype=np.int64)
        if path[0] != start:
            raise CrossviewError("no path of edges joins two vertices", f"{start} and {end}")
        return path
