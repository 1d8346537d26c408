"""Shortest paths over the triangles of a surface, not only along its edges."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import FloatArray, IntArray, IntrinsicTriangulation
from solvers.surface.trisurface import TriSurface

LEFT, RIGHT = 1, -1
"""Sides of a strip."""

GAIN = 1e-12
"""Share of its length by which a path has to get shorter to go on; above what rounding does."""


def shortest_path(surface: TriSurface, start: SurfacePoint, end: SurfacePoint) -> FloatArray:
    """Return a path between two points of a surface that none beside it is shorter than.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    start, end : SurfacePoint
        Where the path begins and ends.

    Returns
    -------
    (k, 3) float array
        Corners of the path in space, both ends among them; each piece is in one triangle.

    Raises
    ------
    CrossviewError
        If a point is of another surface.

    Notes
    -----
    The strip of triangles between both points is laid into the plane, where a funnel finds the
    shortest path inside it (Lee and Preparata 1984). Where the path bends round a vertex that has
    less than 180 degrees on the strip's other side, the strip goes round that side, until there is
    no such vertex. Of paths that differ by a way round a hole or a hill, the first strip decides:
    a shortest one over barycentres.

    Examples
    --------
    In the plane it is straight:

    >>> import numpy as np
    >>> from solvers.primitives import square
    >>> from solvers.surface import shortest_path
    >>> surface = square(n=4, size=2.0)
    >>> start, end = surface.closest_point([-1, -1, 0]), surface.closest_point([1, 0.5, 0])
    >>> path = shortest_path(surface, start, end)
    >>> float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    2.5
    """
    surface.require_own([start, end])
    strip = _Strip.unfolded(surface, _first(surface, start.face, end.face), start, end)
    while True:
        other = _Strip.unfolded(surface, strip.rerouted(), start, end)
        if not other.length < (1 - GAIN) * strip.length:
            return strip.in_space(surface, start, end)
        strip = other


@dataclass(frozen=True)
class _Bend:
    """A corner of a path: the vertex on one side of a portal, or an end of the path."""

    place: complex
    portal: int
    side: int = 0


@dataclass(frozen=True, eq=False)
class _Strip:
    """Triangles one after the other, in the plane; `halfedges` lead from each to the next."""

    triangulation: IntrinsicTriangulation
    halfedges: list[int]
    left: list[complex]
    right: list[complex]
    corners: list[_Bend]

    @classmethod
    def unfolded(
        cls, surface: TriSurface, halfedges: list[int], start: SurfacePoint, end: SurfacePoint
    ) -> _Strip:
        """Lay the triangles into the plane, the first as its own frame has it."""
        t = surface.triangulation
        across = t.twin[np.array(halfedges, dtype=np.int64)]
        faces = np.concatenate([[start.face], across // 3])
        here, *others = (t.corner_positions[faces] @ np.array([1.0, 1j])).tolist()
        begin = sum(w * z for w, z in zip(start.barycentric, here, strict=True))
        left, right = [], []
        for h, k, own in zip(halfedges, (across % 3).tolist(), others, strict=True):
            tail, head = here[h % 3], here[(h + 1) % 3]
            right.append(tail)
            left.append(head)
            turn = (tail - head) / (own[(k + 1) % 3] - own[k])
            here[k], here[(k + 1) % 3] = head, tail
            here[(k + 2) % 3] = head + turn * (own[(k + 2) % 3] - own[k])
        finish = sum(w * z for w, z in zip(end.barycentric, here, strict=True))
        return cls(t, halfedges, left, right, _pulled(begin, left, right, finish))

    @property
    def length(self) -> float:
        """Of the shortest path in it."""
        places = [bend.place for bend in self.corners]
        return sum(abs(b - a) for a, b in pairwise(places))

    def rerouted(self) -> list[int]:
        """Return the halfedges with the other way round each vertex where that is shorter."""
        halfedges, free = list(self.halfedges), len(self.halfedges)
        for before, bend, after in reversed(
            list(zip(self.corners, self.corners[1:], self.corners[2:], strict=False))
        ):
            ends = self.triangulation.head if bend.side == LEFT else self.triangulation.tail
            vertex = int(ends[self.halfedges[bend.portal]])
            to, back = after.place - bend.place, before.place - bend.place
            turn = to / back if bend.side == LEFT else back / to
            inside = math.atan2(turn.imag, turn.real) % (2 * math.pi)
            if math.pi - self.triangulation.curvatures[vertex] >= inside:
                continue
            first = last = bend.portal
            while first > 0 and ends[self.halfedges[first - 1]] == vertex:
                first -= 1
            while last + 1 < len(self.halfedges) and ends[self.halfedges[last + 1]] == vertex:
                last += 1
            fan = self._other_way(first, last, bend.side)
            if last < free and fan:
                halfedges[first : last + 1] = fan
                free = first
        return _onward(halfedges, self.triangulation.twin)

    def _other_way(self, first: int, last: int, side: int) -> list[int]:
        """Return the halfedges on the vertex's other side; none if a boundary is there."""
        twin = self.triangulation.twin
        goal = int(twin[self.halfedges[last]]) // 3
        fan, h = [], self.halfedges[first]
        while True:
            h = h - h % 3 + (h + side) % 3
            fan.append(h)
            h = int(twin[h])
            if h < 0:
                return []
            if h // 3 == goal:
                return fan

    def in_space(self, surface: TriSurface, start: SurfacePoint, end: SurfacePoint) -> FloatArray:
        """Return where the shortest path begins, meets the portals and ends."""
        t, points = self.triangulation, [surface.position(start)]
        leg = 0
        for i, h in enumerate(self.halfedges):
            while self.corners[leg + 1].portal < i:
                leg += 1
            one, other = self.corners[leg].place, self.corners[leg + 1].place
            low = _cross(other - one, self.right[i] - one)
            high = _cross(other - one, self.left[i] - one)
            if high - low > 0:
                share = min(max(-low / (high - low), 0.0), 1.0)
            else:  # along the edge, or of no length
                share = float(abs(self.left[i] - other) < abs(self.right[i] - other))
            tail, head = surface.vertices[t.tail[h]], surface.vertices[t.head[h]]
            points.append(tail + share * (head - tail))
        path = np.array([*points, surface.position(end)])
        steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
        return path[np.r_[True, steps > 1e-14 * surface.diagonal]]


def _first(surface: TriSurface, start: int, end: int) -> list[int]:
    """Return the halfedges of a strip that is short from barycentre to barycentre."""
    t = surface.triangulation
    inner = np.flatnonzero(t.twin >= 0)
    centres = surface.barycentres
    middles = (surface.vertices[t.tail[inner]] + surface.vertices[t.head[inner]]) / 2
    here, there = inner // 3, t.twin[inner] // 3
    lengths = np.linalg.norm(middles - centres[here], axis=1)
    lengths += np.linalg.norm(middles - centres[there], axis=1)
    graph = csr_array((lengths, (there, here)), shape=(t.n_faces, t.n_faces))
    onward = dijkstra(graph, indices=end, return_predecessors=True)[1]
    strip, face = [], start
    while face != end:
        h = next(h for h in range(3 * face, 3 * face + 3) if t.twin[h] // 3 == onward[face])
        strip.append(h)
        face = int(onward[face])
    return strip


def _onward(halfedges: list[int], twin: IntArray) -> list[int]:
    """Return a strip without triangles that it leaves by the side it came in."""
    strip: list[int] = []
    for h in halfedges:
        if strip and twin[strip[-1]] == h:
            strip.pop()
        else:
            strip.append(h)
    return strip


def _pulled(
    begin: complex, left: list[complex], right: list[complex], finish: complex
) -> list[_Bend]:
    """Return the corners of the shortest path through portals."""
    lefts, rights = [*left, finish], [*right, finish]
    apex = low = high = begin
    at_low = at_high = -1
    corners = [_Bend(begin, -1)]
    i = 0
    while i <= len(left):
        if _cross(low - apex, rights[i] - apex) >= 0:
            if low == apex or _cross(high - apex, rights[i] - apex) < 0:
                low, at_low = rights[i], i
            else:
                corners.append(_Bend(high, at_high, LEFT))
                apex = low = high
                at_low, i = at_high, at_high + 1
                continue
        if _cross(high - apex, lefts[i] - apex) <= 0:
            if high == apex or _cross(low - apex, lefts[i] - apex) > 0:
                high, at_high = lefts[i], i
            else:
                corners.append(_Bend(low, at_low, RIGHT))
                apex = high = low
                at_high, i = at_low, at_low + 1
                continue
        i += 1
    corners.append(_Bend(finish, len(left)))
    # a vertex is met at each of its portals, the end is one, too
    return [corners[0], *(b for a, b in pairwise(corners) if b.place != a.place)]


def _cross(a: complex, b: complex) -> float:
    """Return the cross product: above 0 if `b` is to the left of `a`."""
    return (a.conjugate() * b).imag
