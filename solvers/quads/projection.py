"""Nearest points of a surface, for many places at once."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from solvers.quads.incidence import CornersAround
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface, closest_barycentric

FARTHER = 1e-13
"""Difference of distances, in diagonals of the surface, that counts as none.

Chosen, above rounding: without, places on an edge would walk to and fro over it.
"""


class Projection:
    """Nearest points of one surface.

    Parameters
    ----------
    surface : TriSurface
        Where.
    """

    def __init__(self, surface: TriSurface) -> None:
        self._surface = surface
        self._corners = surface.vertices[surface.faces]
        self._around_vertex = CornersAround(surface.faces, surface.n_vertices)

    def slide(self, faces: IntArray, places: FloatArray) -> tuple[IntArray, FloatArray]:
        """Walk from triangle to triangle as long as that leads nearer to a place.

        Another sheet of the surface that happens to be near in space is not jumped to.

        Parameters
        ----------
        faces : (k,) int array
            Where to start.
        places : (k, 3) float array
            Where to go.

        Returns
        -------
        faces : (k,) int array
            Triangles of the points found.
        weights : (k, 3) float array
            Their barycentric weights.
        """
        faces = faces.copy()
        weights = closest_barycentric(self._corners[faces], places)
        distance = self._distances(faces, weights, places)
        active = np.flatnonzero(weights.min(axis=1) <= 0)
        while len(active):
            point, face = self._around(active, faces[active], weights[active])
            found = closest_barycentric(self._corners[face], places[point])
            gap = self._distances(face, found, places[point])
            order = np.lexsort((face, gap, point))
            best = order[np.r_[True, np.diff(point[order]) > 0]] if len(order) else order
            best = best[gap[best] < distance[point[best]] - FARTHER * self._surface.diagonal]
            active = point[best]
            faces[active], weights[active], distance[active] = face[best], found[best], gap[best]
            active = active[weights[active].min(axis=1) <= 0]
        return faces, weights

    def nearest(self, places: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the triangles (k,) and weights (k, 3) of the nearest points of all to places.

        Parameters
        ----------
        places : (k, 3) float array
            Coordinates.
        """
        centres = self._corners.mean(axis=1)
        reach = np.linalg.norm(self._corners - centres[:, None], axis=2).max(axis=1)
        bound = cKDTree(self._surface.vertices).query(places)[0]
        faces = np.zeros(len(places), dtype=np.int64)
        weights = np.zeros((len(places), 3))
        distance = np.full(len(places), np.inf)
        # Triangles of like size together, so that large ones do not widen the search for small.
        size = np.floor(np.log2(reach)).astype(np.int64)
        for k in np.unique(size):
            members = np.flatnonzero(size == k)
            radii = np.minimum(bound, distance) + reach[members].max()
            lists = cKDTree(centres[members]).query_ball_point(places, radii * (1 + 1e-12))
            point = np.repeat(np.arange(len(places)), [len(found) for found in lists])
            face = members[np.concatenate([np.asarray(f, dtype=np.int64) for f in lists])]
            found = closest_barycentric(self._corners[face], places[point])
            gap = self._distances(face, found, places[point])
            order = np.lexsort((face, gap, point))
            best = order[np.r_[True, np.diff(point[order]) > 0]] if len(order) else order
            best = best[gap[best] < distance[point[best]]]
            at = point[best]
            faces[at], weights[at], distance[at] = face[best], found[best], gap[best]
        return faces, weights

    def positions(self, faces: IntArray, weights: FloatArray) -> FloatArray:
        """Return the (k, 3) places of points given by triangles (k,) and weights (k, 3)."""
        return np.asarray(np.einsum("ki,kij->kj", weights, self._corners[faces]))

    def _distances(self, faces: IntArray, weights: FloatArray, places: FloatArray) -> FloatArray:
        return np.asarray(np.linalg.norm(self.positions(faces, weights) - places, axis=1))

    def _around(
        self, points: IntArray, faces: IntArray, weights: FloatArray
    ) -> tuple[IntArray, IntArray]:
        """Return pairs of a point on the border of its triangle and a triangle it touches too."""
        nonzero = weights > 0
        on_edge = nonzero.sum(axis=1) == 2
        i = np.argmin(nonzero[on_edge], axis=1)
        twin = self._surface.triangulation.twin[3 * faces[on_edge] + (i + 1) % 3]
        across = twin >= 0
        i = np.argmax(nonzero[~on_edge], axis=1)
        vertex = self._surface.faces[faces[~on_edge], i]
        at, star = self._around_vertex.pairs(vertex)
        return (
            np.concatenate([points[on_edge][across], points[~on_edge][at]]),
            np.concatenate([twin[across] // 3, star // 3]),
        )
