"""Singularities as vertices of a mesh that is finer around them.

The paper's adapted mesh (section "Preliminary results", step 2). Triangles near a singularity are
split in four, level by level in ever smaller neighbourhoods, their neighbours in two or three so
that no vertex hangs; the point is then inserted, and edges inside the flat original triangles are
flipped to Delaunay. The surface's shape and boundary stay as they are.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from solvers.frozen import freeze_arrays
from solvers.number_checks import whole_number
from solvers.surface.delaunay import intrinsic_delaunay
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray
from solvers.surface.trisurface import TriSurface, barycentric, closest_barycentric

SNAP = 1e-5
"""Distance from an edge or vertex below which a point is moved onto it, in longest edges of the
triangle.

From double precision: nearer ones would make triangles too flat for their angles to be known.
"""

LEVELS = 3
"""How many times edges are halved around singularities, if nothing else is said. Chosen."""

RINGS = 2
"""How many rings of triangles around a point are split at each level. Chosen."""


@dataclass(frozen=True, eq=False)
class Refinement:
    """A refined surface, and where it came from.

    Parameters
    ----------
    coarse : TriSurface
        The original surface.
    surface : TriSurface
        The refined one; the original's vertices keep their numbers.
    vertices : (k,) int array
        The vertex of the refined surface at each of the inserted points.
    parent_face : (m,) int array
        The original triangle that each refined triangle is part of.
    points : tuple of SurfacePoint, optional
        The inserted points, on the original surface.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import square
    >>> from solvers.surface import refine_everywhere
    >>> refinement = refine_everywhere(square(n=2))
    >>> np.bincount(refinement.parent_face).tolist()  # four triangles of each
    [4, 4, 4, 4, 4, 4, 4, 4]
    >>> fine = refinement.surface.point_at_vertex(9)  # a new one
    >>> lifted = refinement.lift(fine)
    >>> np.allclose(refinement.coarse.position(lifted), refinement.surface.position(fine))
    True
    >>> refinement.surface.nearest_vertex(refinement.locate(lifted))
    9
    """

    coarse: TriSurface
    surface: TriSurface
    vertices: IntArray
    parent_face: IntArray
    points: tuple[SurfacePoint, ...] = ()

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @classmethod
    def none(cls, surface: TriSurface) -> Refinement:
        """Return the surface as a refinement of itself.

        Parameters
        ----------
        surface : TriSurface
            The surface.
        """
        return cls(surface, surface, np.empty(0, dtype=np.int64), np.arange(surface.n_faces))

    def locate(self, point: SurfacePoint) -> SurfacePoint:
        """Return a point of the original surface as a point of the refined one.

        Parameters
        ----------
        point : SurfacePoint
            On `coarse`; one that was inserted becomes its vertex.

        Raises
        ------
        CrossviewError
            If it is a point of another surface.
        """
        position = self.coarse.position(point)
        if self.surface is self.coarse:
            return point
        if point in self._inserted:
            return self.surface.point_at_vertex(self._inserted[point])
        first, last = self._first_part[point.face : point.face + 2]
        parts = self._parts[first:last]
        corners = self.surface.vertices[self.surface.faces[parts]]
        weights = closest_barycentric(corners, position)
        places = np.einsum("ki,kij->kj", weights, corners)
        nearest = int(np.argmin(np.linalg.norm(places - position, axis=1)))
        return self.surface.point(int(parts[nearest]), weights[nearest].tolist())

    @cached_property
    def _inserted(self) -> dict[SurfacePoint, int]:
        return dict(zip(self.points, self.vertices.tolist(), strict=True))

    @cached_property
    def _parts(self) -> IntArray:
        """The refined triangles, those of each original triangle together."""
        return np.argsort(self.parent_face, kind="stable")

    @cached_property
    def _first_part(self) -> IntArray:
        counts = np.bincount(self.parent_face, minlength=self.coarse.n_faces)
        return np.concatenate([[0], np.cumsum(counts)])

    def lift(self, point: SurfacePoint) -> SurfacePoint:
        """Return a point of the refined surface as a point of the original.

        Parameters
        ----------
        point : SurfacePoint
            On `surface`.

        Raises
        ------
        CrossviewError
            If it is a point of another surface.
        """
        position = self.surface.position(point)
        if self.surface is self.coarse:
            return point
        parent = int(self.parent_face[point.face])
        corners = self.coarse.vertices[self.coarse.faces[parent]]
        weights = barycentric(corners[None], position)[0]
        inside = np.maximum(weights, 0.0)
        return self.coarse.point(parent, (inside / inside.sum()).tolist())


def refine_at(
    surface: TriSurface,
    points: Iterable[SurfacePoint],
    levels: int = LEVELS,
    feature_edges: npt.ArrayLike | None = None,
) -> Refinement:
    """Return the surface with vertices at the given points and smaller triangles around them.

    Parameters
    ----------
    surface : TriSurface
        What to refine.
    points : iterable of SurfacePoint
        Where; on vertices, on edges or inside triangles.
    levels : int, optional
        How many times edges are halved near the points; 0 only inserts them.
    feature_edges : (k,) array_like of int, optional
        Edges of the surface that crosses are to follow. Triangles with more than one of these and
        boundary edges are split, for no cross can follow two sides of one triangle.

    Returns
    -------
    Refinement
        With a vertex for each of the points.

    Raises
    ------
    CrossviewError
        If a point or an edge is none of the surface, or the levels are no whole number.

    Notes
    -----
    The paper's adapted mesh (section "Preliminary results", step 2).

    Examples
    --------
    >>> from solvers.primitives import square
    >>> from solvers.surface import SurfacePoint, refine_at
    >>> surface = square(n=2)
    >>> point = SurfacePoint(0, (0.5, 0.25, 0.25))
    >>> refinement = refine_at(surface, [point], levels=2)
    >>> (vertex,) = refinement.vertices
    >>> bool((refinement.surface.vertices[vertex] == surface.position(point)).all())
    True
    >>> surface.n_faces < refinement.surface.n_faces, round(refinement.surface.area, 9)
    (True, 1.0)
    """
    levels = whole_number("levels of refinement", levels, 0)
    points = surface.require_own(points)
    mesh = _Mesh(surface, points)
    if feature_edges is not None and len(edges := surface.require_edges(feature_edges)):
        mesh.split_between(surface, edges)
    for _ in range(levels if points else 0):
        mesh.split_in_four(mesh.neighbourhood())
    inserted = np.array([mesh.insert(i) for i in range(len(points))], dtype=np.int64)
    mesh.flip_inside_parents()
    refined = TriSurface(mesh.vertices, mesh.faces, trusted=True)
    return Refinement(surface, refined, inserted, mesh.parent, tuple(points))


def refine_everywhere(surface: TriSurface) -> Refinement:
    """Return the surface with every triangle split in four at its edges' midpoints.

    Parameters
    ----------
    surface : TriSurface
        What to refine; its vertices keep their numbers.

    Returns
    -------
    Refinement
        Without inserted points.

    Examples
    --------
    >>> from solvers.primitives import sphere
    >>> from solvers.surface import refine_everywhere
    >>> refinement = refine_everywhere(sphere(subdivisions=0))
    >>> refinement.coarse.n_faces, refinement.surface.n_faces
    (20, 80)
    """
    mesh = _Mesh(surface, [])
    mesh.split_in_four(np.arange(surface.n_faces))
    refined = TriSurface(mesh.vertices, mesh.faces, trusted=True)
    return Refinement(surface, refined, np.empty(0, dtype=np.int64), mesh.parent)


class _Mesh:
    """The arrays while they change, and where the points are among them."""

    def __init__(self, surface: TriSurface, points: Sequence[SurfacePoint]) -> None:
        self.vertices = surface.vertices
        self.faces = surface.faces
        self.parent = np.arange(surface.n_faces)
        self.at = [p.face for p in points]
        self.weights = [np.asarray(p.barycentric) for p in points]
        self.positions = surface.positions(points)

    def neighbourhood(self) -> IntArray:
        """Return the triangles within a few rings of any of the points.

        Rings begin at the vertex, the edge or the triangle that a point lies on, whichever
        triangle it is given in.
        """
        touched = np.zeros(len(self.vertices), dtype=bool)
        for face, weights in zip(self.at, self.weights, strict=True):
            touched[self.faces[face, _snapped(weights, self.vertices[self.faces[face]]) > 0]] = True
        near = np.flatnonzero(touched[self.faces].any(axis=1))
        for _ in range(RINGS - 1):
            touched[self.faces[near]] = True
            near = np.flatnonzero(touched[self.faces].any(axis=1))
        return near

    def split_in_four(self, red: IntArray) -> None:
        """Split triangles at their edges' midpoints, and their neighbours to conform."""
        on_edge = np.zeros(len(self.vertices), dtype=bool)
        on_edge[self.faces[red]] = True
        nearby = np.flatnonzero(on_edge[self.faces].sum(axis=1) >= 2)
        faces = self.faces[nearby]
        ends = np.sort(np.stack([faces, faces[:, [1, 2, 0]]], axis=2), axis=2).reshape(-1, 2)
        key = ends[:, 0] * len(self.vertices) + ends[:, 1]
        _, first, edge = np.unique(key, return_index=True, return_inverse=True)
        edge = edge.reshape(-1, 3)
        marked = np.zeros(len(first), dtype=bool)
        marked[edge[np.isin(nearby, red)]] = True
        self._halve(nearby, edge, ends[first], marked)

    def split_between(self, surface: TriSurface, feature_edges: IntArray) -> None:
        """Split triangles with several edges that crosses are to follow; before all else.

        Those with two at their third edge, those with three at their middle.
        """
        edge = surface.face_edges
        follows = surface.edge_faces[:, 1] < 0
        follows[feature_edges] = True
        count = follows[edge].sum(axis=1)
        marked = np.zeros(len(follows), dtype=bool)
        marked[edge[(count == 2)[:, None] & ~follows[edge]]] = True
        enclosed = np.flatnonzero(count == 3)
        beside = np.flatnonzero(marked[edge].any(axis=1))
        self._halve(beside, edge[beside], surface.edges, marked)
        enclosed = np.flatnonzero(np.isin(self.parent, enclosed))
        middle = len(self.vertices) + np.arange(len(enclosed))
        corners = self.faces[enclosed]
        self.vertices = np.concatenate([self.vertices, self.vertices[corners].mean(axis=1)])
        around = [(corners[:, i], corners[:, (i + 1) % 3], middle) for i in range(3)]
        pieces = np.concatenate([np.stack(piece, axis=1) for piece in around])
        self._replace(enclosed, pieces, np.tile(enclosed, 3))

    def _halve(self, faces: IntArray, edge: IntArray, ends: IntArray, marked: BoolArray) -> None:
        """Split the marked edges (given by their ends), and the faces whose edges they are.

        Each row of `edge` holds the edges of one of the faces.
        """
        midpoint = np.full(len(ends), -1, dtype=np.int64)
        midpoint[marked] = len(self.vertices) + np.arange(marked.sum())
        self.vertices = np.concatenate([self.vertices, self.vertices[ends[marked]].mean(axis=1)])
        pieces, whole = _subdivided(self.faces[faces], midpoint[edge], self.vertices)
        self._replace(faces, pieces, faces[whole])

    def insert(self, i: int) -> int:
        """Make a vertex of point i and return its number."""
        face = self.at[i]
        corners = self.faces[face]
        weights = _snapped(self.weights[i], self.vertices[corners])
        if weights.max() == 1:
            return int(corners[np.argmax(weights)])
        new = len(self.vertices)
        position = self.positions[i] if weights.all() else weights @ self.vertices[corners]
        self.vertices = np.concatenate([self.vertices, position[None]])
        if weights.all():
            a, b, c = corners
            self._replace(
                np.array([face]),
                np.array([[a, b, new], [b, c, new], [c, a, new]]),
                np.array([face] * 3),
            )
            return new
        opposite = int(corners[np.argmin(weights)])
        ends = corners[corners != opposite]
        beside = np.flatnonzero(np.isin(self.faces, ends).sum(axis=1) == 2)
        halves = [
            np.where(self.faces[beside] == ends[1 - side], new, self.faces[beside])
            for side in (0, 1)
        ]
        self._replace(beside, np.concatenate(halves), np.tile(beside, 2))
        return new

    def _replace(self, old: IntArray, pieces: IntArray, whole: IntArray) -> None:
        """Put pieces (k, 3), each part of the face `whole`, in the place of the old faces."""
        keep = np.ones(len(self.faces), dtype=bool)
        keep[old] = False
        number = np.cumsum(keep) - 1
        kept = int(keep.sum())
        for i, face in enumerate(self.at):
            if keep[face]:
                self.at[i] = int(number[face])
                continue
            among = np.flatnonzero(whole == face)
            weights = barycentric(self.vertices[pieces[among]], self.positions[i])
            best = int(np.argmax(weights.min(axis=1)))
            self.at[i] = kept + int(among[best])
            self.weights[i] = np.maximum(weights[best], 0.0) / np.maximum(weights[best], 0.0).sum()
        self.faces = np.concatenate([self.faces[keep], pieces])
        self.parent = np.concatenate([self.parent[keep], self.parent[whole]])

    def flip_inside_parents(self) -> None:
        """Flip edges between parts of the same original triangle, which is flat, to Delaunay."""
        hosts = np.unique(self.parent[self.at])
        inside = np.flatnonzero(np.isin(self.parent, hosts))
        if len(inside) == 0:
            return
        patch = TriSurface(self.vertices, self.faces[inside], trusted=True).triangulation
        owner = self.parent[inside]
        h = np.arange(len(patch.twin))
        border = (patch.twin < 0) | (owner[patch.twin // 3] != owner[h // 3])
        flipped = intrinsic_delaunay(patch, border[None].astype(np.int64)).triangulation
        self.faces = self.faces.copy()
        self.faces[inside] = flipped.faces


def _subdivided(
    faces: IntArray, midpoint: IntArray, vertices: FloatArray
) -> tuple[IntArray, IntArray]:
    """Split faces (k, 3) at the midpoints (k, 3; -1 for none) of their edges.

    Returns the pieces, and the row of the face each is a part of.
    """
    count = (midpoint >= 0).sum(axis=1)
    rows = np.arange(len(faces))
    pieces: list[IntArray] = [faces[count == 0]]
    whole: list[IntArray] = [rows[count == 0]]
    # Turn each face so that its first edge is the (first) split one, followed by the second.
    shift = np.where(count == 1, np.argmax(midpoint >= 0, axis=1), 0)
    shift = np.where(count == 2, (np.argmin(midpoint, axis=1) + 1) % 3, shift)
    turned = (shift[:, None] + np.arange(3)) % 3
    v = np.take_along_axis(faces, turned, axis=1).T
    m = np.take_along_axis(midpoint, turned, axis=1).T
    diagonal = np.linalg.norm(vertices[m[0]] - vertices[v[2]], axis=1)
    other = np.linalg.norm(vertices[v[0]] - vertices[m[1]], axis=1)
    patterns = (
        (count == 1, ((v[0], m[0], v[2]), (m[0], v[1], v[2]))),
        (
            (count == 2) & (diagonal <= other),
            ((m[0], v[1], m[1]), (v[0], m[0], v[2]), (m[0], m[1], v[2])),
        ),
        (
            (count == 2) & (diagonal > other),
            ((m[0], v[1], m[1]), (v[0], m[0], m[1]), (v[0], m[1], v[2])),
        ),
        (
            count == 3,
            ((v[0], m[0], m[2]), (m[0], v[1], m[1]), (m[2], m[1], v[2]), (m[0], m[1], m[2])),
        ),
    )
    for chosen, parts in patterns:
        for part in parts:
            pieces.append(np.stack(part, axis=1)[chosen])
            whole.append(rows[chosen])
    return np.concatenate(pieces), np.concatenate(whole)


def _snapped(weights: FloatArray, corners: FloatArray) -> FloatArray:
    """Return the weights of a point of a triangle (3, 3), 0 for sides that it is next to."""
    sides = corners[[2, 0, 1]] - corners[[1, 2, 0]]  # opposite each corner
    lengths = np.linalg.norm(sides, axis=1)
    double_area = np.linalg.norm(np.cross(sides[0], sides[1]))
    distance = weights * double_area / (lengths * lengths.max())
    nearest = int(np.argmin(distance))
    if distance[nearest] > SNAP:
        return weights
    tail, head = (nearest + 1) % 3, (nearest + 2) % 3
    along = ((weights @ corners - corners[tail]) @ sides[nearest]) / lengths[nearest] ** 2
    margin = min(SNAP * lengths.max() / lengths[nearest], 0.5)
    along = 0.0 if along <= margin else 1.0 if along >= 1 - margin else along
    on_side = np.zeros(3)
    on_side[tail], on_side[head] = 1 - along, along
    return on_side
