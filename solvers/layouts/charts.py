"""Plane images of triangles in which their crosses are the axes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from solvers.fields.crossfield import CrossField
from solvers.surface.triangulation import (
    QUARTER,
    IntArray,
    IntrinsicTriangulation,
    previous_halfedge,
)
from solvers.surface.working import WorkingTriangulation

ComplexArray = npt.NDArray[np.complex128]

AXES = np.array([1, 1j, -1, -1j])
"""The directions of the cross in a chart, as complex numbers, in quarter turns from the first."""


@dataclass(frozen=True, eq=False)
class Chart:
    """Plane images of the triangles, and the quarter turns between them.

    Parameters
    ----------
    working : WorkingTriangulation
        The triangles, and where they lie on a surface.
    images : (m, 3) complex array
        Image of each halfedge in its triangle's frame.
    period_jumps : (3 m,) int array
        What a direction in the frame of a halfedge's triangle is turned by to become one in the
        frame of its twin's.
    """

    working: WorkingTriangulation
    images: ComplexArray
    period_jumps: IntArray

    @classmethod
    def of_field(cls, field: CrossField) -> Chart:
        """Return each triangle by itself, turned and scaled by its own cross and sizes."""
        solved = field.solved
        t, theta = solved.triangulation, solved.theta
        own = np.exp(1j * (t.directions.reshape(-1, 3) - theta[:, None])) * t.lengths
        mean, half = solved.H[t.faces].mean(axis=1), solved.half_log_aspect.mean(axis=1)
        along, across = (-h[:, None] for h in (mean - half, mean + half))
        images = np.exp(along) * own.real + 1j * np.exp(across) * own.imag
        face = np.repeat(np.arange(t.n_faces), 3)
        turn = theta[face] + t.transport - theta[t.twin // 3]
        turns = np.where(t.twin >= 0, np.rint(turn / QUARTER), 0).astype(np.int64)
        return cls(solved.working, images, turns)

    @property
    def triangulation(self) -> IntrinsicTriangulation:
        """The triangles."""
        return self.working.triangulation

    def on_surface(self, faces: IntArray) -> IntArray:
        """Return the triangles (k,) of the surface in which the middles of some of its own lie.

        Parameters
        ----------
        faces : (k,) int array
            Of the triangulation.
        """
        return self.working.lift(
            faces, self.triangulation.corner_positions[faces].mean(axis=1)
        ).face

    @cached_property
    def corners(self) -> ComplexArray:
        """(m, 3) images of the corners, the first at the origin."""
        z = self.images
        return np.stack([np.zeros(len(z)), z[:, 0], -z[:, 2]], axis=1)

    @cached_property
    def area(self) -> float:
        """Area of all images."""
        z = self.images
        return float(0.5 * np.abs((z[:, 0].conj() * -z[:, 2]).imag).sum())

    @cached_property
    def edge_length(self) -> float:
        """Length of a typical edge: of equilateral triangles of the same number and area."""
        return float(np.sqrt(4 / np.sqrt(3) * self.area / len(self.images)))

    @cached_property
    def diameter(self) -> float:
        """About the largest distance between vertices, along edges."""
        t = self.triangulation
        h = t.edge_halfedges
        length = np.abs(self.images.reshape(-1)[h])
        shape = (t.n_vertices, t.n_vertices)
        graph = coo_array((length, (t.tail[h], t.head[h])), shape=shape).tocsr()
        far = dijkstra(graph, directed=False, indices=0).argmax()
        return float(dijkstra(graph, directed=False, indices=far).max())

    def ring(self, vertex: int) -> IntArray:
        """Return the halfedges that leave a vertex, counter-clockwise from the boundary."""
        twin = self.triangulation.twin
        first = int(self._first_halfedge[vertex])
        ring, h = [first], int(twin[previous_halfedge(np.array(first))])
        while h not in (-1, first):
            ring.append(h)
            h = int(twin[previous_halfedge(np.array(h))])
        return np.array(ring)

    @cached_property
    def _first_halfedge(self) -> IntArray:
        t = self.triangulation
        first = np.empty(t.n_vertices, dtype=np.int64)
        first[t.tail] = np.arange(3 * t.n_faces)
        first[t.tail[t.boundary_halfedges]] = t.boundary_halfedges
        return first
