"""Which edges a hand means that points at the surface."""

from __future__ import annotations

import numpy as np

from solvers.surface import EdgePaths, IntArray, SurfacePoint, TriSurface


class EdgePicker:
    """Finds edges of one surface near points of it.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    """

    def __init__(self, surface: TriSurface) -> None:
        self.surface = surface
        self._paths = EdgePaths(surface)

    def edge_at(self, point: SurfacePoint) -> int:
        """Return the edge of the point's triangle that is nearest to it."""
        lengths = self.surface.triangulation.lengths[point.face]
        # Weight of a corner: distance from the opposite side in heights, which are as 1 / length.
        distance = np.asarray(point.barycentric)[[2, 0, 1]] / lengths
        return int(self.surface.face_edges[point.face, int(np.argmin(distance))])

    def vertex_at(self, point: SurfacePoint) -> int:
        """Return the corner of the point's triangle that is nearest to it."""
        corners = self.surface.faces[point.face]
        gap = np.linalg.norm(self.surface.vertices[corners] - self.surface.position(point), axis=1)
        return int(corners[np.argmin(gap)])

    def path(self, start: int, point: SurfacePoint) -> IntArray:
        """Return the edges of the shortest path from a vertex to the one nearest to a point."""
        return self._paths.through(np.array([start, self.vertex_at(point)]))

    def vertices_along(self, start: int | None, edges: IntArray) -> IntArray:
        """Return the vertices of a path of edges in order, from `start` if it is given."""
        ends = self.surface.edges[edges]
        if start is None:
            return np.asarray(ends[0])
        path = [start]
        for one, other in ends.tolist():
            path.append(other if path[-1] == one else one)
        return np.array(path, dtype=np.int64)
