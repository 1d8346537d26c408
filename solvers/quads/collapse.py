"""What goes wrong where arcs of a T-mesh get no edges, and the conditions that rule it out.

Where two opposite sides of a rectangle have no edge, the other two become one. So each vertex of
the quad mesh, and each edge, is a whole piece of the T-mesh. The mesh has the topology of the
surface when every piece is a tree (up to rectangles that vanish altogether) and meets the boundary
in one stretch or not at all. It has its singularities when no piece holds two of them, or one and
a part of the boundary.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, connected_components

from solvers.layouts.tmesh import TMesh
from solvers.surface.graphs import HalfedgeGraph, walk_back
from solvers.surface.triangulation import BoolArray, IntArray

MOST_CUTS = 50
"""Double edges that are looked at together."""


@dataclass(frozen=True, eq=False)
class Cut:
    """A condition: arcs that need so many edges together.

    Parameters
    ----------
    arcs : (k,) int array
        The arcs.
    least : int
        Their least sum.
    """

    arcs: IntArray
    least: int


def least_counts(tmesh: TMesh, *, collapse: bool) -> IntArray:
    """Return the fewest edges (A,) of each arc: 1, or 0 where nothing speaks against it at sight.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    collapse : bool
        Whether arcs may do without edges.
    """
    loop = tmesh.arcs[:, 0] == tmesh.arcs[:, 1]
    held = tmesh.critical[tmesh.arcs]
    # A boundary that a singularity is not on is held against it, too.
    held |= tmesh.node_on_boundary[tmesh.arcs] & ~tmesh.arc_on_boundary[:, None]
    return np.where(loop, 3, 1 if not collapse else held.all(axis=1).astype(np.int64))


def broken(tmesh: TMesh, counts: IntArray) -> list[Cut]:
    """Return conditions that counts break because of what they merge; none if all is well.

    Sufficiently many edges along every arc meet all of them, and 1 along every arc those that keep
    topology and singularities.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    counts : (A,) int array
        Edges along each arc, the same on opposite sides of every rectangle.
    """
    numbers = _Numbers(tmesh, counts)
    vertices, edges = numbers.pieces()
    found = [*vertices.torn(), *edges.torn(), *_unseparated(tmesh, vertices)]
    return found or _doubles(numbers, vertices, edges)


class _Pieces:
    """Points that become one, and why.

    Parameters
    ----------
    pairs : (k, 2) int array
        Points that are joined.
    causes : (k,) int array
        Entry of `arcs` that is the cause of each.
    arcs : list of int array
        Arcs without edges.
    on_boundary : (n,) bool array
        Points of the boundary.
    along_boundary : (k,) bool array
        Pairs joined along the boundary.
    filled : (f,) int array
        A point of each rectangle that vanishes altogether.
    """

    def __init__(
        self,
        pairs: IntArray,
        causes: IntArray,
        arcs: list[IntArray],
        on_boundary: BoolArray,
        along_boundary: BoolArray,
        filled: IntArray,
    ) -> None:
        self.pairs, self.causes, self._arcs = pairs, causes, arcs
        self.on_boundary, self._along, self._filled = on_boundary, along_boundary, filled
        n = len(on_boundary)
        graph = coo_array((np.ones(len(pairs), dtype=np.int8), pairs.T), shape=(n, n))
        self.count, label = connected_components(graph, directed=False)
        self.label: IntArray = label.astype(np.int64)

    def of(self, points: IntArray) -> IntArray:
        """Return how many of the points each piece holds."""
        return np.bincount(self.label[points], minlength=self.count)

    def arcs(self, pairs: IntArray) -> IntArray:
        """Return the arcs that are the cause of pairs, given by their numbers."""
        causes = [self._arcs[k] for k in np.unique(self.causes[pairs])]
        return np.unique(np.concatenate([*causes, np.zeros(0, dtype=np.int64)]))

    def inside(self, pieces: IntArray) -> IntArray:
        """Return the numbers of the pairs within pieces."""
        return np.flatnonzero(np.isin(self.label[self.pairs[:, 0]], pieces))

    def torn(self) -> list[Cut]:
        """Return a condition for each piece that would change the topology."""
        euler = np.bincount(self.label, minlength=self.count)
        euler += self.of(self._filled) - self.of(self.pairs[:, 0])
        points = self.of(np.flatnonzero(self.on_boundary))
        stretches = points - self.of(self.pairs[self._along, 0])
        bad = (euler != 1) | ((points > 0) & (stretches != 1))
        return [Cut(self.arcs(self.inside(np.array([k]))), 1) for k in np.flatnonzero(bad)]


class _Numbers:
    """Numbers for the vertices and edges along all arcs: nodes first, then those inside arcs."""

    def __init__(self, tmesh: TMesh, counts: IntArray) -> None:
        self.tmesh, self.counts = tmesh, counts
        inner = np.concatenate([[0], np.cumsum(np.maximum(counts - 1, 0))])
        self._first_vertex = tmesh.n_nodes + inner
        self._first_edge = np.concatenate([[0], np.cumsum(counts)])
        self.sides = np.rint(tmesh.side_totals(counts.astype(float))).astype(np.int64)

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

    def pieces(self) -> tuple[_Pieces, _Pieces]:
        """Return which vertices, and which edges, become one."""
        tmesh, counts = self.tmesh, self.counts
        without = np.flatnonzero(counts == 0)
        arcs = [np.array([a]) for a in without]
        vertices, edges = [tmesh.arcs[without]], [np.zeros((0, 2), dtype=np.int64)]
        by_vertices, by_edges = [np.arange(len(without))], [np.zeros(0, dtype=np.int64)]
        # A rectangle whose side 1 - k has no edge joins side k to the side opposite to it.
        for r, k in np.argwhere((self.sides[:, [1, 0]] == 0) & (self.sides[:, :2] > 0)).tolist():
            inner, faced = self.across(r, k)
            vertices.append(inner)
            edges.append(faced)
            by_vertices.append(np.full(len(inner), len(arcs)))
            by_edges.append(np.full(len(faced), len(arcs)))
            arcs.append(tmesh.side(r, 1 - k) // 2)
        gone = np.flatnonzero((self.sides[:, :2] == 0).all(axis=1))
        start = tmesh.side_halfarcs[tmesh.side_offsets[4 * gone]]
        filled = tmesh.arcs[start // 2, start % 2]
        rim = tmesh.arc_on_boundary
        on_rim = np.concatenate([tmesh.node_on_boundary, np.repeat(rim, np.maximum(counts - 1, 0))])
        pairs = np.concatenate(vertices)
        along = np.zeros(len(pairs), dtype=bool)
        along[: len(without)] = rim[without]
        joined = np.concatenate(edges)
        return (
            _Pieces(pairs, np.concatenate(by_vertices), arcs, on_rim, along, filled),
            _Pieces(
                joined,
                np.concatenate(by_edges),
                arcs,
                np.repeat(rim, counts),
                np.zeros(len(joined), dtype=bool),
                np.zeros(0, dtype=np.int64),
            ),
        )


def _unseparated(tmesh: TMesh, vertices: _Pieces) -> list[Cut]:
    """Return a condition for each way between critical nodes, or from one to the boundary."""
    critical = np.flatnonzero(tmesh.critical)
    crowd = vertices.of(critical)
    rim = np.flatnonzero(vertices.on_boundary)
    inner = critical[~tmesh.node_on_boundary[critical]]
    crowded = (crowd > 1) | ((vertices.of(inner) > 0) & (vertices.of(rim) > 0))
    if not crowded.any():
        return []
    rows, columns = np.concatenate([vertices.pairs, vertices.pairs[:, ::-1]]).T
    number = np.tile(np.arange(len(vertices.pairs)), 2)
    graph = HalfedgeGraph(len(vertices.label), rows, columns, np.ones(len(rows)), number)
    found = []
    for start in critical[crowded[vertices.label[critical]]].tolist():
        order, before = breadth_first_order(graph.matrix, start)
        ends = [v for v in order[1:].tolist() if v < tmesh.n_nodes and tmesh.critical[v]]
        if not tmesh.node_on_boundary[start]:
            ends += order[vertices.on_boundary[order]].tolist()[:1]
        for end in ends:
            path = np.array(walk_back(before, end))
            found.append(Cut(vertices.arcs(graph.halfedges(path[:-1], path[1:])), 1))
    return found


def _doubles(numbers: _Numbers, vertices: _Pieces, edges: _Pieces) -> list[Cut]:
    """Return a condition for each pair of edges with the same ends, and each with one end twice."""
    tmesh, counts = numbers.tmesh, numbers.counts
    pairs, arc = numbers.edges()
    first = np.unique(edges.label, return_index=True)[1]
    ends, causes = [pairs[first]], [arc[first]]
    arcs = list(np.arange(tmesh.n_arcs)[:, None])
    # Inside rectangles, only edges from one side to the other can be double.
    for r, k in np.argwhere((numbers.sides[:, [1, 0]] == 1) & (numbers.sides[:, :2] > 1)).tolist():
        ends.append(numbers.across(r, k)[0])
        causes.append(np.full(len(ends[-1]), len(arcs)))
        arcs.append(tmesh.side(r, 1 - k) // 2)
    cause = np.concatenate(causes)
    piece = np.sort(vertices.label[np.concatenate(ends)], axis=1)
    _, group, times = np.unique(piece, axis=0, return_inverse=True, return_counts=True)
    group = group.reshape(-1)
    found = []
    for k in np.unique(group[(times[group] > 1) | (piece[:, 0] == piece[:, 1])])[:MOST_CUTS]:
        members = np.flatnonzero(group == k)
        merged = vertices.arcs(vertices.inside(piece[members[0]]))
        involved = np.unique(np.concatenate([merged, *(arcs[i] for i in cause[members])]))
        found.append(Cut(involved, int(counts[involved].sum()) + 1))
    return found
