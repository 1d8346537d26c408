"""Loops that matter: a dual spanning tree to walk on, and a basis of the handle loops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order, dijkstra, minimum_spanning_tree

from solvers.surface.graphs import HalfedgeGraph, walk_back
from solvers.surface.triangulation import FloatArray, IntArray, IntrinsicTriangulation


class DualTree:
    """A breadth-first spanning tree of the triangles, to carry angles from one to all.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        Where.
    root : int
        The triangle to start from.
    blocked : (r, 3 m) bool array
        Halfedges not to cross, in any number of rows; what is left must be connected.

    Attributes
    ----------
    order : (m,) int array
        Triangles in breadth-first order.
    parent : (m,) int array
        Position in `order` of each one's parent (0 for the root).
    crossing : (m,) int array
        The halfedge of the parent that leads to it (-1 for the root).
    """

    def __init__(
        self,
        triangulation: IntrinsicTriangulation,
        root: int,
        blocked: npt.NDArray[np.bool_],
    ) -> None:
        twin, m = triangulation.twin, triangulation.n_faces
        self._twin = twin
        open_ = (twin >= 0) & ~blocked.any(axis=0)
        h = np.flatnonzero(open_)
        count = open_.reshape(-1, 3).sum(axis=1)
        start = np.concatenate([[0], np.cumsum(count)])
        graph = csr_array((np.ones(len(h), dtype=np.int8), twin[h] // 3, start), shape=(m, m))
        order, predecessor = breadth_first_order(graph, root, return_predecessors=True)
        self.order = order.astype(np.int64)
        at = np.empty(m, dtype=np.int64)
        at[self.order] = np.arange(m)
        above = predecessor[self.order].astype(np.int64)
        above[0] = root
        self.parent = at[above]
        own = 3 * self.order[:, None] + np.arange(3)
        leads = open_[own] & (twin[own] // 3 == above[:, None])
        self.crossing = twin[own[np.arange(m), np.argmax(leads, axis=1)]]
        self.crossing[0] = -1

    @cached_property
    def _levels(self) -> list[tuple[int, int]]:
        levels = []
        start, end = 1, 1
        while start < len(self.order):
            end = int(np.searchsorted(self.parent[1:], start)) + 1
            levels.append((start, end))
            start = end
        return levels

    def accumulate(self, at_root: float, steps: FloatArray) -> FloatArray:
        """Return the sum of the steps from the root to every triangle.

        Parameters
        ----------
        at_root : float
            Value of the root.
        steps : (m,) float array
            What each triangle adds to its parent's value, in `order`.

        Returns
        -------
        (m,) float array
            By triangle.
        """
        value = np.empty(len(steps))
        value[0] = at_root
        for start, end in self._levels:
            np.take(value, self.parent[start:end], out=value[start:end])
            value[start:end] += steps[start:end]
        by_face = np.empty_like(value)
        by_face[self.order] = value
        return by_face

    def path(self, face: int) -> IntArray:
        """Return the halfedges crossed on the way from the root to a triangle.

        Parameters
        ----------
        face : int
            The triangle.

        Returns
        -------
        (k,) int array
            Each seen from the triangle that is left.
        """
        position = int(np.flatnonzero(self.order == face)[0])
        crossed = []
        while position:
            crossed.append(int(self.crossing[position]))
            position = int(self.parent[position])
        return np.array(crossed[::-1], dtype=np.int64)

    def form(self, crossed: Sequence[tuple[IntArray, int]]) -> IntArray:
        """Return a dual path as a 1-form: +1 on halfedges crossed from their face, -1 on twins.

        Parameters
        ----------
        crossed : sequence of (halfedges, sign)
            Pieces of the path; sign -1 for a piece walked backwards.
        """
        values = np.zeros(len(self._twin), dtype=np.int64)
        for halfedges, sign in crossed:
            np.add.at(values, halfedges, sign)
            inner = halfedges[self._twin[halfedges] >= 0]
            np.add.at(values, self._twin[inner], -sign)
        return values


@dataclass(frozen=True)
class HandleLoops:
    """A basis of the handle loops, along edges.

    Parameters
    ----------
    chain : (2 g, 3 m) int array
        +1 on the halfedges each loop runs along, -1 on their twins.
    closing : (2 g,) int array
        A halfedge of each loop that no other loop runs along.
    paths : tuple of int array
        The vertices of each loop in order, the first repeated at the end.

    Examples
    --------
    >>> from solvers.primitives import torus
    >>> from solvers.surface import handle_loops
    >>> surface = torus(n=24)
    >>> loops = handle_loops(surface.triangulation, surface.boundary_loops)
    >>> [bool(path[0] == path[-1]) for path in loops.paths]
    [True, True]
    >>> t = surface.triangulation  # as a 1-form, each loop changes its sign with the direction
    >>> bool((loops.chain[:, t.twin] == -loops.chain).all())
    True
    """

    chain: IntArray
    closing: IntArray
    paths: tuple[IntArray, ...]


def handle_loops(
    triangulation: IntrinsicTriangulation, boundary_loops: Sequence[IntArray]
) -> HandleLoops:
    """Return the 2 g shortest loops through one vertex that generate the handles.

    A greedy tree-cotree decomposition (Erickson and Whittlesey 2005): a shortest-path tree, a
    maximal dual tree beside it; each edge in neither closes a loop. Boundary loops count as one
    vertex each, so that only handles are left.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        The surface.
    boundary_loops : sequence of int array
        Vertices of each boundary loop.

    Returns
    -------
    HandleLoops
        The shortest first; none on a surface of genus 0.

    Examples
    --------
    >>> from solvers.primitives import genus, sphere
    >>> from solvers.surface import handle_loops
    >>> for surface in (sphere(subdivisions=1), genus(2, subdivisions=1)):
    ...     loops = handle_loops(surface.triangulation, surface.boundary_loops)
    ...     print(surface.genus, len(loops.paths))
    0 0
    2 4
    """
    t = triangulation
    euler_characteristic = t.n_vertices - len(t.edge_halfedges) + t.n_faces
    if euler_characteristic + len(boundary_loops) == 2:
        empty = np.zeros((0, len(t.twin)), dtype=np.int64)
        return HandleLoops(empty, np.zeros(0, dtype=np.int64), ())
    node = np.arange(t.n_vertices)
    for loop in boundary_loops:
        node[loop] = loop.min()
    first = _Decomposition(t, node, root=int(node[0]))
    # Loops through a vertex of the shortest loop are shorter than through an arbitrary one.
    shortest = int(first.leftover[np.argmin(first.loop_length[first.leftover])])
    best = _Decomposition(t, node, root=int(node[t.tail[shortest]]))
    order = np.argsort(best.loop_length[best.leftover], kind="stable")
    closing = best.leftover[order]
    chains, paths = zip(*(best.loop(int(h), boundary_loops) for h in closing), strict=True)
    return HandleLoops(np.array(chains), closing, paths)


class _Decomposition:
    """Tree and cotree rooted at a vertex, and the edges in neither."""

    def __init__(self, t: IntrinsicTriangulation, node: IntArray, root: int) -> None:
        self._t, self._node = t, node
        h = np.flatnonzero(t.twin >= 0)
        tail, head, length = node[t.tail], node[t.head], t.lengths.reshape(-1)
        self._graph = HalfedgeGraph(t.n_vertices, tail[h], head[h], length[h], h)
        distance, predecessor = dijkstra(self._graph.matrix, indices=root, return_predecessors=True)
        self._predecessor = predecessor.astype(np.int64)
        self.loop_length = distance[tail] + length + distance[head]
        child = np.flatnonzero(self._predecessor >= 0)
        tree = self._graph.halfedges(self._predecessor[child], child)
        rest = h[~_edge_mask(t, tree)[h]]
        # A maximal tree of the duals: long loops are closed by it, short ones are left over.
        weight = 2 * self.loop_length[rest].max(initial=0.0) - self.loop_length[rest]
        dual = HalfedgeGraph(t.n_faces, rest // 3, t.twin[rest] // 3, weight, rest)
        spanning = minimum_spanning_tree(dual.matrix).tocoo()
        cotree = dual.halfedges(spanning.row.astype(np.int64), spanning.col.astype(np.int64))
        left = rest[~_edge_mask(t, cotree)[rest]]
        self.leftover = left[left < t.twin[left]]

    def loop(self, closing: int, boundary_loops: Sequence[IntArray]) -> tuple[IntArray, IntArray]:
        """Return the loop that a halfedge closes, as a chain and as a path of vertices."""
        t = self._t
        out = self._halfedges_from_root(int(self._node[t.tail[closing]]))
        back = self._halfedges_from_root(int(self._node[t.head[closing]]))
        chain = np.zeros(len(t.twin), dtype=np.int64)
        for halfedges, sign in ((out, 1), (np.array([closing]), 1), (back, -1)):
            np.add.at(chain, halfedges, sign)
            np.add.at(chain, t.twin[halfedges], -sign)
        shared = 0
        while shared < min(len(out), len(back)) and out[shared] == back[shared]:
            shared += 1
        steps = np.concatenate([out[shared:], [closing], t.twin[back[shared:][::-1]]])
        return chain, _vertex_path(t, steps, boundary_loops)

    def _halfedges_from_root(self, node: int) -> IntArray:
        path = np.array(walk_back(self._predecessor, node)[::-1], dtype=np.int64)
        return self._graph.halfedges(path[:-1], path[1:])


def _edge_mask(t: IntrinsicTriangulation, halfedges: IntArray) -> npt.NDArray[np.bool_]:
    mask = np.zeros(len(t.twin), dtype=bool)
    mask[halfedges] = mask[t.twin[halfedges]] = True
    return mask


def _vertex_path(
    t: IntrinsicTriangulation, steps: IntArray, boundary_loops: Sequence[IntArray]
) -> IntArray:
    """Return the vertices of a closed run of halfedges, gaps filled along boundary loops."""
    path: list[int] = []
    for step, following in zip(steps, np.roll(steps, -1), strict=True):
        path.append(int(t.tail[step]))
        end, start = int(t.head[step]), int(t.tail[following])
        if end != start:
            loop = next(loop for loop in boundary_loops if end in loop)
            i, j = (int(np.flatnonzero(loop == v)[0]) for v in (end, start))
            forward = np.roll(loop, -i)[: (j - i) % len(loop)]
            backward = np.roll(loop[::-1], i + 1)[: (i - j) % len(loop)]
            path += (forward if len(forward) <= len(backward) else backward).tolist()
    path.append(path[0])
    return np.array(path, dtype=np.int64)
