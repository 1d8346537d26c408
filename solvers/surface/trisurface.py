"""The surface: a validated, frozen, embedded triangulation."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from hashlib import blake2b

import numpy as np
import numpy.typing as npt

from solvers.errors import CrossviewError
from solvers.frozen import frozen_property
from solvers.kind_checks import all_of_kind
from solvers.number_checks import real_numbers, whole_number, whole_numbers
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import FloatArray, IntArray, IntrinsicTriangulation
from solvers.surface.validation import HalfedgePairs, as_arrays, problems


class TriSurface:
    """A connected, oriented, manifold triangle surface, with or without boundary.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
        Coordinates, in any unit of length; all lengths and areas are in it and its square.
    faces : (m, 3) array_like of int
        Corner vertices, counter-clockwise seen from outside.
    trusted : bool, optional
        Skip validation, for surfaces derived from a valid one.

    Raises
    ------
    SurfaceError
        If the arrays are anything else; it names the offending elements.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.surface import TriSurface
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> surface = TriSurface(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> surface.n_vertices, surface.n_faces, surface.euler_characteristic, surface.genus
    (4, 4, 2, 0)
    >>> bool(np.isclose(surface.area, 3 / 2 + np.sqrt(3) / 2))
    True
    >>> round(float(surface.angle_defects.sum() / np.pi), 6)  # Gauss-Bonnet: 2 pi chi
    4.0
    >>> surface.position(surface.closest_point([1, 1, 1])).round(3).tolist()
    [0.333, 0.333, 0.333]
    >>> TriSurface([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    Traceback (most recent call last):
    solvers.errors.SurfaceError: 1 degenerate triangle without area (triangles 0): ...
    """

    def __init__(
        self, vertices: npt.ArrayLike, faces: npt.ArrayLike, *, trusted: bool = False
    ) -> None:
        self.vertices: FloatArray
        self.faces: IntArray
        self.vertices, self.faces = as_arrays(vertices, faces)
        if not trusted:
            for problem in problems(self.vertices, self.faces):
                raise problem
        self.vertices.flags.writeable = False
        self.faces.flags.writeable = False

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    @property
    def n_faces(self) -> int:
        """Number of triangles."""
        return len(self.faces)

    @frozen_property
    def triangulation(self) -> IntrinsicTriangulation:
        """The surface's own connectivity and edge lengths."""
        corners = self.vertices[self.faces]
        lengths = np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
        twin = HalfedgePairs(self.n_vertices, self.faces).twin
        return IntrinsicTriangulation(self.n_vertices, self.faces, twin, lengths)

    @frozen_property
    def edges(self) -> IntArray:
        """(ne, 2) end vertices of each edge."""
        t = self.triangulation
        return np.stack([t.tail, t.head], axis=1)[t.edge_halfedges]

    @property
    def face_edges(self) -> IntArray:
        """(m, 3) the edge that joins corner i and corner i + 1 of each face."""
        return self.triangulation.face_edges

    @frozen_property
    def edge_faces(self) -> IntArray:
        """(ne, 2) the faces left and right of each edge; -1 on the boundary."""
        t = self.triangulation
        right = t.twin[t.edge_halfedges]
        return np.stack([t.edge_halfedges // 3, np.where(right >= 0, right // 3, -1)], axis=1)

    @property
    def euler_characteristic(self) -> int:
        """V - E + F = 2 - 2 genus - boundary loops."""
        return self.n_vertices - len(self.triangulation.edge_halfedges) + self.n_faces

    @property
    def genus(self) -> int:
        """Number of handles."""
        return (2 - self.euler_characteristic - len(self.boundary_loops)) // 2

    @frozen_property
    def boundary_loops(self) -> tuple[IntArray, ...]:
        """The vertices of each boundary loop, the surface on the left, the longest loop first."""
        t = self.triangulation
        following = dict(
            zip(
                t.tail[t.boundary_halfedges].tolist(),
                t.head[t.boundary_halfedges].tolist(),
                strict=True,
            )
        )
        loops = []
        while following:
            start = min(following)
            loop = [start]
            vertex = following.pop(start)
            while vertex != start:
                loop.append(vertex)
                vertex = following.pop(vertex)
            loops.append(np.array(loop, dtype=np.int64))
        # Equal lengths may differ by rounding; such loops keep the order of their first vertices.
        return tuple(
            sorted(loops, key=lambda loop: -round(self.loop_length(loop) / self.diagonal, 9))
        )

    def loop_length(self, loop: IntArray) -> float:
        """Return the length of the closed polygon through vertices.

        Parameters
        ----------
        loop : (k,) int array
            The vertices in order, none repeated.

        Raises
        ------
        CrossviewError
            If there is no vertex of such a number.
        """
        p = self.vertices[self.require_vertices(loop)]
        return float(np.linalg.norm(np.roll(p, -1, axis=0) - p, axis=1).sum())

    @frozen_property
    def boundary_vertices(self) -> npt.NDArray[np.bool_]:
        """(n,) whether each vertex lies on the boundary."""
        mask = np.zeros(self.n_vertices, dtype=bool)
        mask[self.triangulation.tail[self.triangulation.boundary_halfedges]] = True
        return mask

    @frozen_property
    def area_vectors(self) -> FloatArray:
        """(m, 3) normal of each face, as long as its area."""
        a, b, c = (self.vertices[self.faces[:, i]] for i in range(3))
        return 0.5 * np.cross(b - a, c - a)

    @frozen_property
    def face_areas(self) -> FloatArray:
        """(m,) area of each triangle."""
        return np.asarray(np.linalg.norm(self.area_vectors, axis=1))

    @property
    def area(self) -> float:
        """Total area."""
        return float(self.face_areas.sum())

    @frozen_property
    def face_normals(self) -> FloatArray:
        """(m, 3) unit normals."""
        return self.area_vectors / self.face_areas[:, None]

    @frozen_property
    def vertex_normals(self) -> FloatArray:
        """(n, 3) area-weighted unit normals."""
        total = np.stack(
            [
                np.bincount(
                    self.faces.reshape(-1), np.repeat(self.area_vectors[:, i], 3), self.n_vertices
                )
                for i in range(3)
            ],
            axis=1,
        )
        return np.asarray(total / np.maximum(np.linalg.norm(total, axis=1), 1e-300)[:, None])

    @frozen_property
    def face_frames(self) -> tuple[FloatArray, FloatArray]:
        """Two (m, 3) unit vectors of each face, along its first edge and 90 degrees further."""
        along = self.vertices[self.faces[:, 1]] - self.vertices[self.faces[:, 0]]
        along /= np.linalg.norm(along, axis=1)[:, None]
        return along, np.cross(self.face_normals, along)

    @frozen_property
    def barycentres(self) -> FloatArray:
        """(m, 3) centre of each triangle."""
        return np.asarray(self.vertices[self.faces].mean(axis=1))

    @property
    def angle_defects(self) -> FloatArray:
        """(n,) integrated Gauss curvature (inside) or geodesic curvature (on the boundary)."""
        return self.triangulation.curvatures

    @frozen_property
    def diagonal(self) -> float:
        """Length of the bounding box's diagonal."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    @frozen_property
    def triangle_quality(self) -> FloatArray:
        """(m,) 4 sqrt(3) area / sum of squared edges, from 0 (degenerate) to 1 (equilateral)."""
        squares = (self.triangulation.lengths**2).sum(axis=1)
        return np.asarray(4 * np.sqrt(3) * self.face_areas / squares)

    @frozen_property
    def mark(self) -> int:
        """What tells the points of this surface from those of others, a digest of its triangles.

        The same for surfaces whose vertices alone differ: there the same points are meant.
        """
        return int.from_bytes(blake2b(self.faces.tobytes(), digest_size=8).digest(), "big")

    def point(self, face: int, barycentric: Sequence[float]) -> SurfacePoint:
        """Return a point of this surface.

        Parameters
        ----------
        face : int
            The triangle it lies in.
        barycentric : sequence of 3 float
            Weights of the triangle's corners, non-negative, with sum 1.

        Raises
        ------
        CrossviewError
            If there is no such triangle, or the weights are no such numbers.
        """
        weights = real_numbers("the barycentric weights of a point", barycentric, (3,))
        a, b, c = weights.tolist()
        (made,) = self.require_own([SurfacePoint(face, (a, b, c), self.mark)])
        return made

    def require_own(self, points: Iterable[SurfacePoint]) -> tuple[SurfacePoint, ...]:
        """Return points of this surface as a tuple, and refuse those of others.

        Parameters
        ----------
        points : iterable of SurfacePoint
            On this surface; those made by hand count as such if it has their triangles.

        Raises
        ------
        CrossviewError
            If one is no point, is a point of another surface, or lies in no triangle of this one.
        """
        own = all_of_kind("points", points, SurfacePoint)
        for point in own:
            if point.mark not in (None, self.mark) or point.face >= self.n_faces:
                raise CrossviewError(
                    "a point of another surface is given",
                    f"triangle {point.face}; this surface has {self.n_faces}",
                    "take it to this one first, with Refinement.lift or closest_point",
                )
        return own

    def require_vertices(self, vertices: npt.ArrayLike) -> IntArray:
        """Return numbers of vertices of this surface as a new array, and refuse others.

        Parameters
        ----------
        vertices : (k,) array_like of int
            Rows of `vertices`.

        Raises
        ------
        CrossviewError
            If there is no vertex of such a number.
        """
        return whole_numbers("the numbers of vertices", vertices, (None,), below=self.n_vertices)

    def require_edges(self, edges: npt.ArrayLike) -> IntArray:
        """Return numbers of edges of this surface as a new array, and refuse others.

        Parameters
        ----------
        edges : (k,) array_like of int
            Rows of `edges`.

        Raises
        ------
        CrossviewError
            If there is no edge of such a number.
        """
        return whole_numbers("the numbers of edges", edges, (None,), below=len(self.edges))

    def position(self, point: SurfacePoint) -> FloatArray:
        """Return the (3,) coordinates of a surface point.

        Parameters
        ----------
        point : SurfacePoint
            On this surface.

        Raises
        ------
        CrossviewError
            If it is a point of another surface.
        """
        self.require_own([point])
        return np.asarray(np.asarray(point.barycentric) @ self.vertices[self.faces[point.face]])

    def positions(self, points: Iterable[SurfacePoint]) -> FloatArray:
        """Return the (k, 3) coordinates of surface points.

        Parameters
        ----------
        points : iterable of SurfacePoint
            On this surface, any number.

        Raises
        ------
        CrossviewError
            If one is a point of another surface.
        """
        own = self.require_own(points)
        return np.array([self.position(point) for point in own]).reshape(-1, 3)

    def point_at_vertex(self, vertex: int) -> SurfacePoint:
        """Return a vertex as a surface point.

        Parameters
        ----------
        vertex : int
            Its number.

        Raises
        ------
        CrossviewError
            If there is none of this number.
        """
        h = int(self._halfedge_from[whole_number("the vertex", vertex, 0, self.n_vertices - 1)])
        weights = [0.0, 0.0, 0.0]
        weights[h % 3] = 1.0
        return self.point(h // 3, weights)

    def nearest_vertex(self, point: SurfacePoint) -> int:
        """Return the corner of a point's triangle that the point is at, or weighs most.

        Parameters
        ----------
        point : SurfacePoint
            A point of the surface.

        Raises
        ------
        CrossviewError
            If it is a point of another surface.
        """
        self.require_own([point])
        return int(self.faces[point.face, int(np.argmax(point.barycentric))])

    @frozen_property
    def _halfedge_from(self) -> IntArray:
        h = np.empty(self.n_vertices, dtype=np.int64)
        h[self.triangulation.tail[::-1]] = np.arange(3 * self.n_faces)[::-1]
        return h

    def closest_point(self, position: npt.ArrayLike) -> SurfacePoint:
        """Return the surface point nearest to a place in space.

        Parameters
        ----------
        position : (3,) array_like
            Coordinates.

        Raises
        ------
        CrossviewError
            Unless they are three finite numbers.
        """
        x = real_numbers("the position", position, (3,), finite=True)
        to_centre = np.linalg.norm(self.barycentres - x, axis=1)
        reach = self.triangulation.lengths.max(axis=1)
        candidates = np.flatnonzero(to_centre - reach <= (to_centre + reach).min())
        weights = closest_barycentric(self.vertices[self.faces[candidates]], x)
        places = np.einsum("ki,kij->kj", weights, self.vertices[self.faces[candidates]])
        best = int(np.argmin(np.linalg.norm(places - x, axis=1)))
        return self.point(int(candidates[best]), weights[best].tolist())


def barycentric(triangles: FloatArray, position: FloatArray) -> FloatArray:
    """Return the weights of the foot of the perpendicular from a place to planes of triangles.

    Parameters
    ----------
    triangles : (k, 3, 3) float array
        Corners.
    position : (3,) or (k, 3) float array
        The place, or one for each triangle.

    Returns
    -------
    (k, 3) float array
        Weights with sum 1; negative where the foot lies outside.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.surface import barycentric
    >>> triangle = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]])
    >>> barycentric(triangle, np.array([0.25, 0.5, 7.0])).tolist()
    [[0.25, 0.25, 0.5]]
    """
    u = triangles[:, 1] - triangles[:, 0]
    v = triangles[:, 2] - triangles[:, 0]
    normal = np.cross(u, v)
    squared = (normal**2).sum(axis=1)
    to_x = position - triangles[:, 0]
    second = (np.cross(to_x, v) * normal).sum(axis=1) / squared
    third = (np.cross(u, to_x) * normal).sum(axis=1) / squared
    return np.stack([1 - second - third, second, third], axis=1)


def closest_barycentric(corners: FloatArray, x: FloatArray) -> FloatArray:
    """Return the weights of the point of each triangle that is nearest to a place.

    Parameters
    ----------
    corners : (k, 3, 3) float array
        Corners of triangles.
    x : (3,) or (k, 3) float array
        The place, or one for each triangle.

    Returns
    -------
    (k, 3) float array
        Non-negative weights with sum 1; zeros are exact where the point lies on the border.
    """
    best = barycentric(corners, x)
    distance = np.where((best >= 0).all(axis=1), 0.0, np.inf)
    for i in range(3):
        a, b = corners[:, i], corners[:, (i + 1) % 3]
        along = b - a
        t = np.clip(((x - a) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
        gap = np.linalg.norm(a + t[:, None] * along - x, axis=1)
        weights = np.zeros_like(best)
        weights[:, i] = 1 - t
        weights[:, (i + 1) % 3] = t
        best = np.where((gap < distance)[:, None], weights, best)
        distance = np.minimum(distance, gap)
    return best
