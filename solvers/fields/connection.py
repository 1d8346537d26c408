"""What a surface contributes to every solve: its working triangulation, loops and walk."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from solvers.features.edges import Features, no_features
from solvers.surface.delaunay import intrinsic_delaunay
from solvers.surface.homology import DualTree, handle_loops
from solvers.surface.points import SurfacePoint
from solvers.surface.shaping import parted, shaped
from solvers.surface.triangulation import (
    QUARTER,
    BoolArray,
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
    wrap,
)
from solvers.surface.trisurface import TriSurface
from solvers.surface.working import Located

CLEARANCE = 1e-6
"""Least barycentric weight of a point in a triangle, for no part of a split to be without area.

Chosen, above what rounding makes of angles. A point with two weights below is on the vertex.
"""

ASIDE = 1e-9
"""Distance from a triangle's barycentre of the place that stands for it, in parts of the triangle.

Chosen, above rounding.
"""


@dataclass(frozen=True)
class Condition:
    """One of the 2 g + max(b - 1, 0) conditions a configuration must meet to be valid.

    Parameters
    ----------
    kind : {"boundary", "loop"}
        Alignment with a further boundary, or closing along a handle loop.
    label : str
        In plain words.
    path : (k,) int array
        Vertices of the loop or boundary, the first repeated at the end.
    halfedge : int
        Where it is read off: a halfedge of the loop or boundary.

    Examples
    --------
    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.primitives import annulus, torus
    >>> for surface in (annulus(n=24), torus(n=12)):
    ...     print([c.label for c in IsotropicSolver(surface).holonomy.conditions])
    ['around the inner boundary']
    ['handle 1, first loop', 'handle 1, second loop']
    """

    kind: Literal["boundary", "loop"]
    label: str
    path: IntArray
    halfedge: int


class Discretization:
    """The working triangulation of a surface and the tree to walk it by.

    Intrinsic Delaunay, its poor triangles refined. Handle loops and features are edges of the
    surface and of the triangulation; the walk does not cross handle loops.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    features : Features, optional
        Of the surface; by default none.

    Attributes
    ----------
    surface : TriSurface
        The surface.
    features : Features
        Those given.
    feature_halfedges : (k,) int array
        One halfedge of each edge of the triangulation on a feature, in the order of the features'
        edges, and along each that was split.
    feature_edge : (k,) int array
        The feature edge that each is part of, a position in `Features.edges`.
    boundary_loops : tuple of int array
        The boundary halfedges of the triangulation, loop by loop, each from its first vertex.
    handles : HandleLoops
        Handle loops of the surface.
    conditions : tuple of Condition
        The holonomy conditions, handles first; halfedges are the triangulation's.
    working : WorkingTriangulation
        The moves from the surface to the triangulation.
    triangulation : IntrinsicTriangulation
        What everything is solved on; the surface's vertices keep their numbers.
    chain : (2 g, 3 m) int array
        Halfedges of the handle loops on the triangulation, as in `HandleLoops`.
    tree : DualTree
        The walk, from the reference boundary halfedge (or face 0 of a closed surface).
    reference : int
        Halfedge of the longest boundary the crosses are aligned with; -1 on closed surfaces.

    Examples
    --------
    Sheared triangles have negative weights; inside, their Delaunay triangulation has none (Bobenko
    and Springborn 2007):

    >>> from solvers.fields import Discretization
    >>> from solvers.primitives import annulus
    >>> from solvers.surface import TriSurface
    >>> flat = annulus(n=24)
    >>> sheared = TriSurface(flat.vertices + flat.vertices[:, [1]] * [2.0, 0.0, 0.0], flat.faces)
    >>> discretization = Discretization(sheared)
    >>> for t in (sheared.triangulation, discretization.triangulation):
    ...     print(bool(t.weights[t.twin >= 0].min() > -1e-9))
    False
    True
    """

    def __init__(self, surface: TriSurface, *, features: Features | None = None) -> None:
        self.surface = surface
        self.features = no_features(surface) if features is None else features.require_on(surface)
        own = surface.triangulation
        self.handles = handle_loops(own, surface.boundary_loops)
        numbered = [_numbered(h, own) for h in (self.features.halfedges, self.handles.closing)]
        chain = np.concatenate([self.handles.chain, *numbered])
        shaped_ = shaped(intrinsic_delaunay(own, chain))
        self.working = parted(shaped_, len(chain) - 2) if len(self.features) else shaped_
        self.triangulation: IntrinsicTriangulation = self.working.triangulation
        self.chain = self.working.marks[:-2]
        self.feature_halfedges, self.feature_edge = self._feature_pieces(self.working.marks[-2])
        first = [int(loop[0]) for loop in surface.boundary_loops]
        self.boundary_loops = self.triangulation.boundary_loops_from(first)
        starts = [int(loop[0]) for loop in self.boundary_loops]
        self.reference = starts[0] if starts else -1
        closing = _first_places(self.working.marks[-1]).tolist()
        self.conditions = tuple(self._conditions(starts, closing))
        self.tree = DualTree(self.triangulation, max(self.reference, 0) // 3, self.chain != 0)

    def with_features(self, kept: BoolArray) -> Discretization:
        """Return the same with some of the features.

        Parameters
        ----------
        kept : (k,) bool array
            Which of `feature_halfedges`; all on an edge of the surface or none.
        """
        other = copy(self)
        edges, other.feature_edge = np.unique(self.feature_edge[kept], return_inverse=True)
        other.features = Features(self.surface, self.features.edges[edges])
        other.feature_halfedges = self.feature_halfedges[kept]
        return other

    def _feature_pieces(self, row: IntArray) -> tuple[IntArray, IntArray]:
        """Return the halfedges on features, edge by edge and along each, and the edge of each."""
        own = self.surface.triangulation
        h = np.flatnonzero(row)
        edge = row[h] - 1
        start = np.zeros((len(h), 3))
        start[np.arange(len(h)), h % 3] = 1.0
        face, weights = self.working.lift_points(h // 3, start)
        place = np.einsum("ki,kij->kj", weights, self.surface.vertices[self.surface.faces[face]])
        first = self.surface.vertices[own.tail[self.features.halfedges[edge]]]
        order = np.lexsort((np.linalg.norm(place - first, axis=1), edge))
        return h[order], edge[order]

    def _conditions(self, starts: list[int], closing: list[int]) -> Iterator[Condition]:
        for i, (h, path) in enumerate(zip(closing, self.handles.paths, strict=True)):
            which = "first" if i % 2 == 0 else "second"
            yield Condition("loop", f"handle {i // 2 + 1}, {which} loop", path, h)
        loops = self.surface.boundary_loops
        for i, (h, loop) in enumerate(zip(starts[1:], loops[1:], strict=True), start=2):
            label = "around the inner boundary" if len(loops) == 2 else f"around boundary {i}"
            yield Condition("boundary", label, np.append(loop, loop[0]), h)

    def dual_path(self, condition: Condition) -> IntArray:
        """Return the path over which a condition is read off, as a closed 1-form.

        Parameters
        ----------
        condition : Condition
            One of `conditions`.

        Returns
        -------
        (3 m,) int array
            How often the path crosses each halfedge from its triangle outwards, less inwards.
        """
        tree, h = self.tree, condition.halfedge
        across = np.array([h])
        if condition.kind == "loop":
            back = tree.path(int(self.triangulation.twin[h]) // 3)
            return tree.form([(tree.path(h // 3), 1), (across, 1), (back, -1)])
        start = np.array([self.reference])
        return tree.form([(start, -1), (tree.path(h // 3), 1), (across, 1)])

    @cached_property
    def boundary_loop_of(self) -> tuple[IntArray, IntArray]:
        """The boundary halfedges of the triangulation, and the loop each lies on."""
        if not self.boundary_loops:
            return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
        sizes = [len(loop) for loop in self.boundary_loops]
        return np.concatenate(self.boundary_loops), np.repeat(np.arange(len(sizes)), sizes)

    def locate(self, points: Sequence[SurfacePoint]) -> Located:
        """Return where points of the surface, and the frames of their triangles, lie.

        Parameters
        ----------
        points : sequence of SurfacePoint
            Points of the surface.
        """
        points = self.surface.require_own(points)
        faces = np.array([p.face for p in points], dtype=np.int64)
        weights = np.array([p.barycentric for p in points]).reshape(-1, 3)
        return self.working.locate(faces, self.surface.triangulation.places(faces, weights))

    def place(self, points: Sequence[SurfacePoint]) -> tuple[IntArray, FloatArray]:
        """Return where points of the surface lie on the triangulation.

        Parameters
        ----------
        points : sequence of SurfacePoint
            Points of the surface.

        Returns
        -------
        faces : (k,) int array
            A triangle of each.
        weights : (k, 3) float array
            Barycentric weights in it; exactly 1 and 0 for vertices, at least `CLEARANCE` (less
            rounding) otherwise.
        """
        t, located = self.triangulation, self.locate(points)
        inside = np.maximum(t.weights_at(located.face, located.place), CLEARANCE)
        inside /= inside.sum(axis=1)[:, None]
        at_vertex = (inside <= CLEARANCE).sum(axis=1) == 2
        inside[at_vertex] = np.rint(inside[at_vertex])
        return located.face, inside

    def gradients(self, values: FloatArray, at: Located) -> FloatArray:
        """Return gradients of functions that are linear in each triangle of the triangulation.

        Parameters
        ----------
        values : (c, k, 3) float array
            Of each function, at the corners of the triangle that each point is in.
        at : Located
            The points, as `locate` returns them.

        Returns
        -------
        (c, k, 2) float array
            In the frames of the points' triangles on the surface.
        """
        flat = np.einsum("cki,kid->dck", values, self.triangulation.hat_gradients[at.face])
        gradient = (flat[0] + 1j * flat[1]) * np.exp(-1j * at.turn)
        return np.stack([gradient.real, gradient.imag], axis=2)

    @cached_property
    def vertex_points(self) -> tuple[IntArray, FloatArray]:
        """Triangles and weights on the surface of the vertices of the triangulation."""
        t = self.triangulation
        corner = np.empty(t.n_vertices, dtype=np.int64)
        corner[t.tail] = np.arange(len(t.twin))
        weights = np.zeros((t.n_vertices, 3))
        weights[np.arange(t.n_vertices), corner % 3] = 1.0
        return self.working.lift_points(corner // 3, weights)

    @cached_property
    def barycentres(self) -> Located:
        """Where the barycentre and frame of each triangle of the surface lie.

        Just beside it: a triangle that was halved has its barycentre on the cut, and rounding would
        choose the side.
        """
        faces = np.arange(self.surface.n_faces)
        weights = np.tile(1 / 3 + ASIDE * np.array([0.0, 1.0, -1.0]), (len(faces), 1))
        return self.working.locate(faces, self.surface.triangulation.places(faces, weights))

    def walk(self, offsets: FloatArray) -> FloatArray:
        """Carry the cross from the reference to every triangle.

        Parameters
        ----------
        offsets : (m, 3) float array
            How far the field turns from each triangle's barycentre to its edge midpoints.

        Returns
        -------
        (m,) float array
            theta at the barycentres in the frames of the triangulation, radians. At the
            reference halfedge u points along the boundary; on a closed surface theta is 0 in
            the first triangle.
        """
        t, offset = self.triangulation, offsets.reshape(-1)
        crossing = self.tree.crossing
        steps = self._tree_transport + offset[crossing] - offset[t.twin[crossing]]
        h = self.reference
        start = float(t.directions[h] - offset[h]) if h >= 0 else 0.0
        return self.tree.accumulate(start, steps)

    @cached_property
    def _tree_transport(self) -> FloatArray:
        return np.asarray(self.triangulation.transport[self.tree.crossing])

    def closing(self, theta: FloatArray, offsets: FloatArray, h: IntArray) -> FloatArray:
        """Return by how much theta fails to continue over halfedges, in (-pi/4, pi/4].

        Over inner halfedges: how far the cross carried over from the left turns against the
        cross on the right. On the boundary: how far it turns against the boundary.

        Parameters
        ----------
        theta : (m,) float array
            Angles at the barycentres, as `walk` returns them, radians.
        offsets : (m, 3) float array
            How far the field turns from each triangle's barycentre to its edge midpoints.
        h : (k,) int array
            Halfedges of the triangulation.

        Returns
        -------
        (k,) float array
            Radians.
        """
        t, offset = self.triangulation, offsets.reshape(-1)
        g = t.twin[h]
        beyond = np.where(g >= 0, theta[g // 3] + offset[g] - t.transport[h], t.directions[h])
        return wrap(theta[h // 3] + offset[h] - beyond, QUARTER)

    def defects(self, theta: FloatArray, offsets: FloatArray) -> FloatArray:
        """Return the holonomy defects of a walk, in the order of the conditions.

        Parameters
        ----------
        theta : (m,) float array
            As of `closing`.
        offsets : (m, 3) float array
            As of `closing`.

        Returns
        -------
        (2 g + max(b - 1, 0),) float array
            Radians in (-pi/4, pi/4].
        """
        h = np.array([c.halfedge for c in self.conditions], dtype=np.int64)
        return self.closing(theta, offsets, h)

    def max_closing_error(
        self, theta: FloatArray, offsets: FloatArray, defects: FloatArray
    ) -> float:
        """Return the largest failure to close over all inner edges.

        Edges on handle loops are expected to close up to the defects of those loops. Those the
        walk has crossed close by its construction; the others are measured.

        Parameters
        ----------
        theta : (m,) float array
            As of `closing`.
        offsets : (m, 3) float array
            As of `closing`.
        defects : (2 g + max(b - 1, 0),) float array
            As of `defects`.

        Returns
        -------
        float
            Radians.
        """
        offset = offsets.reshape(-1)
        h, g, left, right, apart = self._uncrossed
        error = theta[left] - theta[right] + (offset[h] - offset[g] + apart)
        if len(self.chain):
            error -= defects[: len(self.chain)] @ self.chain[:, h]
        return float(np.abs(wrap(error, QUARTER)).max(initial=0.0))

    @cached_property
    def _uncrossed(self) -> tuple[IntArray, IntArray, IntArray, IntArray, FloatArray]:
        """Inner edges off the walk: both halfedges, both triangles, and the transport."""
        t = self.triangulation
        off = t.twin >= 0
        crossed = self.tree.crossing[1:]
        off[crossed] = off[t.twin[crossed]] = False
        h = t.edge_halfedges[off[t.edge_halfedges]]
        g = t.twin[h]
        return h, g, h // 3, g // 3, t.transport[h]

    def boundary_misalignment(self, theta: FloatArray, offsets: FloatArray) -> FloatArray:
        """Return the largest angle, with its sign, between crosses and each boundary loop.

        Parameters
        ----------
        theta : (m,) float array
            As of `closing`.
        offsets : (m, 3) float array
            As of `closing`.

        Returns
        -------
        (b,) float array
            Radians in (-pi/4, pi/4], in the order of the surface's boundary loops.
        """
        h, loop = self.boundary_loop_of
        return _largest(self.closing(theta, offsets, h), loop, len(self.surface.boundary_loops))

    def feature_angles(self, theta: FloatArray, offsets: FloatArray) -> FloatArray:
        """Return by how much the field turns against each feature edge at its midpoint.

        Parameters
        ----------
        theta : (m,) float array
            As of `closing`.
        offsets : (m, 3) float array
            As of `closing`.

        Returns
        -------
        (k,) float array
            Radians in (-pi/4, pi/4], in the order of `feature_halfedges`.
        """
        h = self.feature_halfedges
        turned = theta[h // 3] + offsets.reshape(-1)[h] - self.triangulation.directions[h]
        return wrap(turned, QUARTER)

    def turn_to_features(self, theta: FloatArray, offsets: FloatArray) -> float:
        """Return the one turn of all crosses that brings them nearest to the features.

        Parameters
        ----------
        theta : (m,) float array
            As of `closing`.
        offsets : (m, 3) float array
            As of `closing`.

        Returns
        -------
        float
            Radians in (-pi/4, pi/4]; of the mean fourth power, weighted by length.
        """
        lengths = self.triangulation.lengths.reshape(-1)[self.feature_halfedges]
        power = lengths @ np.exp(4j * self.feature_angles(theta, offsets))
        return -float(np.angle(power)) / 4

    def feature_misalignment(self, theta: FloatArray, offsets: FloatArray) -> FloatArray:
        """Return the largest angle, with its sign, between crosses and each feature curve.

        Parameters
        ----------
        theta : (m,) float array
            As of `closing`.
        offsets : (m, 3) float array
            As of `closing`.

        Returns
        -------
        (c,) float array
            Radians in (-pi/4, pi/4], in the order of the features' curves.
        """
        angle = self.feature_angles(theta, offsets)
        curve = self.features.curve_of[self.feature_edge]
        return _largest(angle, curve, len(self.features.curves))


def _numbered(h: IntArray, triangulation: IntrinsicTriangulation) -> IntArray:
    """Return a row (1, 3 m) of numbers on halfedges: 1, 2, ... on those given, in order."""
    row = np.zeros((1, len(triangulation.twin)), dtype=np.int64)
    row[0, h] = np.arange(1, len(h) + 1)
    return row


def _first_places(row: IntArray) -> IntArray:
    """Return where each of the numbers 1, 2, ... is first in a row of numbers on halfedges."""
    place = np.flatnonzero(row)
    return place[np.unique(row[place], return_index=True)[1]]


def _largest(angle: FloatArray, group: IntArray, count: int) -> FloatArray:
    """Return the largest of the angles (k,) in each group, with its sign."""
    largest = np.zeros(count)
    by_size = np.argsort(np.abs(angle), kind="stable")
    largest[group[by_size]] = angle[by_size]
    return largest
