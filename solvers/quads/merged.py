"""Which vertices and edges of the quads become one where arcs of a T-mesh get no edges.

Two rectangles side by side, with their nodes 0 to 5 and arcs a to g:

    3 --c-- 4 --d-- 5
    |       |       |
    e       f       g
    |       |       |
    0 --a-- 1 --b-- 2

Give a and c one edge each, e, f and g two, and b and d none. Then the right rectangle has no
quads. Its nodes 1 and 2 are one, because of arc b alone, and so are 4 and 5, because of d. The
other two of its sides, f and g, lie on each other: the vertex in the middle of f is the one in
the middle of g, and the edges of f are those of g, because its side b has no edge. What is left
are two quads above each other.

A *join* says that two points (or two edges) are one, and its *cause*: an arc, or a side of a
rectangle. A *piece* is all points that joins make one. It is the only structure here: joins are
arrays, one row for each, and a cause is a number, that of the arc, or behind the arcs that of the
side.

>>> import numpy as np
>>> from solvers.layouts.tmesh import TMesh
>>> arcs = np.array([[0, 1], [1, 2], [3, 4], [4, 5], [0, 3], [1, 4], [2, 5]])
>>> on_boundary = np.array([True, True, True, True, True, False, True])
>>> corner = np.array([True, False, True, True, False, True])
>>> sides = np.array([0, 10, 5, 9, 2, 12, 7, 11])  # a, f, c and e backwards; b, g, d, f
>>> tmesh = TMesh(
...     arcs, np.ones(7), on_boundary, np.array([2, 3, 2, 2, 3, 2]), corner, np.full(6, True),
...     np.arange(9), sides,
... )
>>> vertices, edges = merged(tmesh, np.array([1, 0, 1, 0, 2, 2, 2]))
>>> [piece.tolist() for piece in vertices.groups]  # 6 to 8: the middles of e, f and g
[[0], [1, 2], [3], [4, 5], [6], [7, 8]]
>>> [piece.tolist() for piece in edges.groups]  # 0 and 1: a and c; then two of e, f and g each
[[0], [1], [2], [3], [4, 6], [5, 7]]
>>> vertices.arcs(vertices.within(np.array([vertices.label[1]]))).tolist()  # 1 and 2: arc b
[1]
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.layouts.tmesh import TMesh
from solvers.surface.triangulation import BoolArray, IntArray


@dataclass(frozen=True, eq=False)
class Causes:
    """What can have no edge: an arc, or a side of a rectangle, all of its arcs.

    Parameters
    ----------
    tmesh : TMesh
        Its arcs are numbered first, then the sides, four of each rectangle.
    """

    tmesh: TMesh

    def side(self, rectangle: int, number: int) -> int:
        """Return the number of a side of a rectangle."""
        return self.tmesh.n_arcs + 4 * rectangle + number

    def arcs(self, causes: IntArray) -> IntArray:
        """Return the arcs of causes, each once, in order."""
        n = self.tmesh.n_arcs
        sides = (np.unique(causes[causes >= n]) - n).tolist()
        of_sides = [self.tmesh.side(*divmod(side, 4)) // 2 for side in sides]
        return np.unique(np.concatenate([causes[causes < n], *of_sides]))


@dataclass(frozen=True, eq=False)
class Joins:
    """Pairs that become one.

    Parameters
    ----------
    pairs : (k, 2) int array
        The two of each.
    cause : (k,) int array
        Why, as `Causes` numbers it.
    along_boundary : (k,) bool array
        Whether they are joined along the boundary.
    """

    pairs: IntArray
    cause: IntArray
    along_boundary: BoolArray

    @classmethod
    def of(cls, pairs: IntArray, cause: IntArray | int) -> Joins:
        """Return joins that do not run along the boundary, of one cause or each of its own."""
        causes = np.broadcast_to(np.asarray(cause, dtype=np.int64), len(pairs))
        return cls(pairs, causes, np.zeros(len(pairs), dtype=bool))

    @classmethod
    def together(cls, several: Sequence[Joins]) -> Joins:
        """Return all of several, at least one."""
        return cls(
            np.concatenate([joins.pairs for joins in several]),
            np.concatenate([joins.cause for joins in several]),
            np.concatenate([joins.along_boundary for joins in several]),
        )


@dataclass(frozen=True, eq=False)
class Merged:
    """Points that become pieces, and why.

    Parameters
    ----------
    causes : Causes
        What the causes of joins are.
    joins : Joins
        Of points, by their numbers.
    on_boundary : (n,) bool array
        Which of the points lie on the boundary.
    filled : (f,) int array
        A point of each rectangle that vanishes altogether.
    """

    causes: Causes
    joins: Joins
    on_boundary: BoolArray
    filled: IntArray

    @cached_property
    def label(self) -> IntArray:
        """(n,) the piece of each point."""
        n, pairs = len(self.on_boundary), self.joins.pairs
        graph = coo_array((np.ones(len(pairs), dtype=np.int8), pairs.T), shape=(n, n))
        return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)

    @cached_property
    def count(self) -> int:
        """Number of pieces."""
        return int(self.label.max(initial=-1)) + 1

    @property
    def groups(self) -> list[IntArray]:
        """The points of each piece."""
        order = np.argsort(self.label, kind="stable")
        return np.split(order, np.cumsum(self.holding(np.arange(len(order))))[:-1])

    def holding(self, points: IntArray) -> IntArray:
        """Return how many of the points each piece holds."""
        return np.bincount(self.label[points], minlength=self.count)

    def within(self, pieces: IntArray) -> IntArray:
        """Return the numbers of the joins within pieces."""
        return np.flatnonzero(np.isin(self.label[self.joins.pairs[:, 0]], pieces))

    def arcs(self, joins: IntArray) -> IntArray:
        """Return the arcs that are the cause of joins, given by their numbers."""
        return self.causes.arcs(self.joins.cause[joins])

    @property
    def torn(self) -> IntArray:
        """The pieces that would change the topology.

        Sound are trees, rectangles that vanish altogether taken for whole, that meet the boundary
        in one stretch or not at all.
        """
        joins = self.joins
        characteristic = np.bincount(self.label, minlength=self.count)
        characteristic += self.holding(self.filled) - self.holding(joins.pairs[:, 0])
        rim = self.holding(np.flatnonzero(self.on_boundary))
        stretches = rim - self.holding(joins.pairs[joins.along_boundary, 0])
        return np.flatnonzero((characteristic != 1) | ((rim > 0) & (stretches != 1)))


@dataclass(frozen=True, eq=False)
class Numbering:
    """Numbering for the vertices and edges along all arcs: nodes first, then those inside arcs.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    counts : (A,) int array
        Edges along each arc, the same on opposite sides of every rectangle.
    """

    tmesh: TMesh
    counts: IntArray

    @cached_property
    def sides(self) -> IntArray:
        """(R, 4) edges along the sides of rectangles."""
        return np.rint(self.tmesh.side_totals(self.counts.astype(float))).astype(np.int64)

    @cached_property
    def _first_vertex(self) -> IntArray:
        inner = np.concatenate([[0], np.cumsum(np.maximum(self.counts - 1, 0))])
        return np.asarray(self.tmesh.n_nodes + inner)

    @cached_property
    def _first_edge(self) -> IntArray:
        return np.concatenate([[0], np.cumsum(self.counts)])

    def along(self, halfarcs: IntArray) -> tuple[IntArray, IntArray]:
        """Return the vertices (w + 1,) and the edges (w,) along half-arcs that follow another."""
        n = self.counts[halfarcs // 2]
        arc, backwards = np.repeat(halfarcs // 2, n), np.repeat(halfarcs % 2, n)
        step = np.arange(n.sum()) - np.repeat(np.cumsum(n) - n, n)
        edge = np.where(backwards, np.repeat(n, n) - 1 - step, step)
        start = self.tmesh.arcs[halfarcs[0] // 2, halfarcs[0] % 2]
        vertices = np.append(start, self._vertex(arc, edge + 1 - backwards))
        return vertices, self._first_edge[arc] + edge

    def edges(self) -> tuple[IntArray, IntArray]:
        """Return the ends (e, 2) and the arc (e,) of every edge along an arc."""
        arc = np.repeat(np.arange(self.tmesh.n_arcs), self.counts)
        step = np.arange(len(arc)) - self._first_edge[arc]
        ends = np.stack([self._vertex(arc, step), self._vertex(arc, step + 1)], axis=1)
        return ends, arc

    def _vertex(self, arc: IntArray, step: IntArray) -> IntArray:
        tmesh = self.tmesh
        inner = self._first_vertex[arc] + step - 1
        end = np.where(step == 0, tmesh.arcs[arc, 0], tmesh.arcs[arc, 1])
        return np.where((step > 0) & (step < self.counts[arc]), inner, end)

    def across(self, rectangle: int, side: int) -> tuple[IntArray, IntArray]:
        """Return pairs of what faces another from a side of a rectangle to the opposite one.

        Returns
        -------
        vertices : (w - 1, 2) int array
            Without the rectangle's corners.
        edges : (w, 2) int array
        """
        near = self.along(self.tmesh.side(rectangle, side))
        far = self.along(self.tmesh.side(rectangle, side + 2))
        vertices = np.stack([near[0], far[0][::-1]], axis=1)
        return vertices[1:-1], np.stack([near[1], far[1][::-1]], axis=1)


def merged(tmesh: TMesh, counts: IntArray) -> tuple[Merged, Merged]:
    """Return which vertices, and which edges, become one.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    counts : (A,) int array
        Edges along each arc, the same on opposite sides of every rectangle.
    """
    numbers, causes = Numbering(tmesh, counts), Causes(tmesh)
    sides, rim = numbers.sides, tmesh.arc_on_boundary
    without = np.flatnonzero(counts == 0)
    vertices = [Joins(tmesh.arcs[without], without, rim[without])]
    edges = [Joins.of(np.zeros((0, 2), dtype=np.int64), 0)]
    # A rectangle whose side 1 - k has no edge joins side k to the side opposite to it.
    for r, k in np.argwhere((sides[:, [1, 0]] == 0) & (sides[:, :2] > 0)).tolist():
        inner, faced = numbers.across(r, k)
        vertices.append(Joins.of(inner, causes.side(r, 1 - k)))
        edges.append(Joins.of(faced, causes.side(r, 1 - k)))
    gone = np.flatnonzero((sides[:, :2] == 0).all(axis=1))
    start = tmesh.side_halfarcs[tmesh.side_offsets[4 * gone]]
    filled = tmesh.arcs[start // 2, start % 2]
    inside = np.repeat(rim, np.maximum(counts - 1, 0))
    on_rim = np.concatenate([tmesh.node_on_boundary, inside])
    none = np.zeros(0, dtype=np.int64)
    return (
        Merged(causes, Joins.together(vertices), on_rim, filled),
        Merged(causes, Joins.together(edges), np.repeat(rim, counts), none),
    )
