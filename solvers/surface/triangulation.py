"""Triangulations known by connectivity and edge lengths alone.

Halfedge ``h = 3 f + i`` runs in face ``f`` from corner ``i`` to corner ``i + 1``; the surface lies
to its left. Everything the discretisation needs (angles, cotangents, Levi-Civita transport) follows
from lengths, so the same operators serve an embedded surface and its intrinsic Delaunay flips.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from solvers.frozen import frozen_property, read_only

IntArray = npt.NDArray[np.int64]
FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

QUARTER = np.pi / 2
"""A quarter turn, radians: turned by it a cross is the same."""


def next_halfedge(h: IntArray) -> IntArray:
    """Return the halfedge after `h` in its face."""
    return np.asarray(h + 1 - 3 * (h % 3 == 2))


def previous_halfedge(h: IntArray) -> IntArray:
    """Return the halfedge before `h` in its face."""
    return np.asarray(h - 1 + 3 * (h % 3 == 0))


def wrap(angle: FloatArray, period: float) -> FloatArray:
    """Return `angle` modulo `period`, in (-period / 2, period / 2]."""
    return np.asarray(angle - period * np.ceil(angle / period - 0.5))


def laid_out(lengths: FloatArray) -> FloatArray:
    """Lay triangles out in the plane.

    Parameters
    ----------
    lengths : (k, 3) float array
        Length of each side, from corner i to corner i + 1.

    Returns
    -------
    (k, 3, 2) float array
        Corners: the first at the origin, the second on the x axis, the third above it.
    """
    first, second, third = lengths.T
    flat = np.zeros((len(lengths), 3, 2))
    flat[:, 1, 0] = first
    # The difference of squares as a product: exact enough where the first side is short.
    flat[:, 2, 0] = first / 2 + (third - second) * (third + second) / (2 * first)
    flat[:, 2, 1] = 2 * heron(lengths) / first
    return flat


def heron(lengths: FloatArray) -> FloatArray:
    """Return the areas of triangles with sides (k, 3), by Kahan's stable form of the formula."""
    a, b, c = np.sort(lengths, axis=1).T[::-1]
    product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))
    return np.asarray(0.25 * np.sqrt(np.maximum(product, 0.0)))


class IntrinsicTriangulation:
    """An oriented manifold triangulation with edge lengths.

    Parameters
    ----------
    n_vertices : int
        Number of vertices.
    faces : (m, 3) int array
        Corner vertices, counter-clockwise.
    twin : (3 m,) int array
        The halfedge on the other side; -1 on the boundary.
    lengths : (m, 3) float array
        Length of each halfedge.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.surface import IntrinsicTriangulation
    >>> alone = np.full(3, -1)
    >>> t = IntrinsicTriangulation(3, np.array([[0, 1, 2]]), alone, np.array([[3.0, 4.0, 5.0]]))
    >>> float(t.areas[0]), float(np.degrees(t.angles[0, 1]).round(6))
    (6.0, 90.0)
    >>> corner_values = t.corner_positions[:, :, 0]  # the function x has the gradient (1, 0)
    >>> t.gradients(corner_values).round(6).tolist()
    [[1.0, 0.0]]
    """

    def __init__(
        self, n_vertices: int, faces: IntArray, twin: IntArray, lengths: FloatArray
    ) -> None:
        self.n_vertices = n_vertices
        self.faces = read_only(faces)
        self.twin = read_only(twin)
        self.lengths = read_only(lengths)

    @property
    def n_faces(self) -> int:
        """Number of triangles."""
        return len(self.faces)

    @frozen_property
    def tail(self) -> IntArray:
        """(3 m,) vertex each halfedge starts at."""
        return self.faces.reshape(-1)

    @frozen_property
    def head(self) -> IntArray:
        """(3 m,) vertex each halfedge ends at."""
        return self.faces[:, [1, 2, 0]].reshape(-1)

    @frozen_property
    def edge_halfedges(self) -> IntArray:
        """(ne,) the representing halfedge of each edge, the lower-numbered of the two."""
        h = np.arange(len(self.twin))
        return np.flatnonzero((self.twin < 0) | (h < self.twin))

    @frozen_property
    def face_edges(self) -> IntArray:
        """(m, 3) the edge that joins corner i and corner i + 1 of each face."""
        h = self.edge_halfedges
        edge = np.empty(len(self.twin), dtype=np.int64)
        edge[h] = np.arange(len(h))
        inner = self.twin[h] >= 0
        edge[self.twin[h[inner]]] = np.flatnonzero(inner)
        return edge.reshape(-1, 3)

    @frozen_property
    def boundary_halfedges(self) -> IntArray:
        """Halfedges without a twin."""
        return np.flatnonzero(self.twin < 0)

    @frozen_property
    def areas(self) -> FloatArray:
        """(m,) triangle areas."""
        return heron(self.lengths)

    @frozen_property
    def cotangents(self) -> FloatArray:
        """(m, 3) cotangent of the angle at each corner."""
        s = self.lengths**2
        at_0 = s[:, 0] + s[:, 2] - s[:, 1]
        at_1 = s[:, 1] + s[:, 0] - s[:, 2]
        at_2 = s[:, 2] + s[:, 1] - s[:, 0]
        return np.stack([at_0, at_1, at_2], axis=1) / (4.0 * self.areas)[:, None]

    @frozen_property
    def angles(self) -> FloatArray:
        """(m, 3) interior angle at each corner, radians."""
        return np.asarray(np.arctan2(1.0, self.cotangents))

    @frozen_property
    def weights(self) -> FloatArray:
        """(3 m,) cotangent weight of each halfedge's edge (half the sum of opposite cotangents)."""
        half = 0.5 * self.cotangents[:, [2, 0, 1]].reshape(-1)
        across = np.where(self.twin >= 0, half[self.twin], 0.0)
        return np.asarray(half + across)

    @frozen_property
    def directions(self) -> FloatArray:
        """(3 m,) angle of each halfedge in its face's frame (x along the face's first halfedge)."""
        angles = self.angles
        zero = np.zeros(self.n_faces)
        return np.stack([zero, np.pi - angles[:, 1], np.pi + angles[:, 0]], axis=1).reshape(-1)

    @frozen_property
    def transport(self) -> FloatArray:
        """(3 m,) Levi-Civita transport over each halfedge, radians.

        What to add to an angle in the frame of the halfedge's face to get the angle of the same
        direction in the frame of the twin's face; 0 on the boundary.
        """
        turn = self.directions[self.twin] + np.pi - self.directions
        return np.where(self.twin >= 0, wrap(turn, 2 * np.pi), 0.0)

    @frozen_property
    def corner_positions(self) -> FloatArray:
        """(m, 3, 2) corners of each face laid out in its own frame."""
        return laid_out(self.lengths)

    @frozen_property
    def curvatures(self) -> FloatArray:
        """(n,) integrated curvature of each vertex.

        Gauss curvature 2 pi - sum of angles inside, geodesic curvature pi - sum of angles on the
        boundary.
        """
        total = np.bincount(self.tail, self.angles.reshape(-1), self.n_vertices)
        full = np.full(self.n_vertices, 2 * np.pi)
        full[self.tail[self.boundary_halfedges]] = np.pi
        return np.asarray(full - total)

    @frozen_property
    def hat_gradients(self) -> FloatArray:
        """(m, 3, 2) gradients of the corners' hat functions in each face's frame.

        In memory the faces lie along the fast axis, so that each component is one run.
        """
        p = self.corner_positions.transpose(1, 2, 0)
        opposite = p[[2, 0, 1]] - p[[1, 2, 0]]
        turned = np.stack([-opposite[:, 1], opposite[:, 0]], axis=1)
        return np.asarray((turned / (2 * self.areas)).transpose(2, 0, 1))

    def boundary_loops_from(self, vertices: Sequence[int]) -> tuple[IntArray, ...]:
        """Return the halfedges of boundary loops, in order.

        Parameters
        ----------
        vertices : sequence of int
            A vertex of each; it starts there.

        Returns
        -------
        tuple of (k,) int array
        """
        h = self.boundary_halfedges
        leaving = dict(zip(self.tail[h].tolist(), h.tolist(), strict=True))
        head, loops = self.head, []
        for vertex in vertices:
            loop = [leaving[vertex]]
            while head[loop[-1]] != vertex:
                loop.append(leaving[int(head[loop[-1]])])
            loops.append(np.array(loop, dtype=np.int64))
        return tuple(loops)

    def places(self, face: IntArray, weights: FloatArray) -> FloatArray:
        """Return points of triangles in these triangles' frames.

        Parameters
        ----------
        face : (k,) int array
            Their triangles.
        weights : (k, 3) float array
            Their barycentric weights.

        Returns
        -------
        (k, 2) float array
        """
        return np.asarray(np.einsum("ki,kij->kj", weights, self.corner_positions[face]))

    def weights_at(self, face: IntArray, place: FloatArray) -> FloatArray:
        """Return the barycentric weights of points of triangles.

        Parameters
        ----------
        face : (k,) int array
            Their triangles.
        place : (k, 2) float array
            Where, in these triangles' frames.

        Returns
        -------
        (k, 3) float array
            With sum 1; negative outside.
        """
        corners = self.corner_positions[face]
        third = place[:, 1] / corners[:, 2, 1]
        second = (place[:, 0] - third * corners[:, 2, 0]) / corners[:, 1, 0]
        return np.stack([1 - second - third, second, third], axis=1)

    def gradients(self, values: FloatArray) -> FloatArray:
        """Return the gradient of piecewise linear functions in each face's frame.

        Parameters
        ----------
        values : (m, 3) float array
            Value at each corner.

        Returns
        -------
        (m, 2) float array
        """
        return np.asarray(np.einsum("mi,mid->md", values, self.hat_gradients))
