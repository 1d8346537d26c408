"""The cut graph: edges that open the surface to a disk and meet every singularity.

The paper's branch cut (section "Retrieving crosses orientation from H"), which it takes from
Bommes et al. 2009.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse.csgraph import dijkstra, minimum_spanning_tree

from solvers.surface.graphs import HalfedgeGraph, walk_back
from solvers.surface.triangulation import IntArray, IntrinsicTriangulation


def cut_graph(
    triangulation: IntrinsicTriangulation,
    boundary_loops: Sequence[IntArray],
    handle_chain: IntArray,
    singular_vertices: IntArray,
) -> IntArray:
    """Return a cut graph, nearly as short as can be.

    The handle loops cut the surface to genus zero; a Steiner tree (Mehlhorn 1988: shortest paths
    between neighbouring Voronoi regions) then joins them, every boundary loop and every
    singularity.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        The surface.
    boundary_loops : sequence of int array
        Vertices of each boundary loop.
    handle_chain : (2 g, 3 m) int array
        Halfedges of the handle loops, as in `HandleLoops`.
    singular_vertices : (k,) int array
        Vertices the cut has to reach.

    Returns
    -------
    (c,) int array
        One halfedge of each interior edge of the cut.

    Examples
    --------
    Cut from rim to rim, an annulus is a disk: its Euler characteristic, 0, gains an edge for each
    of the cut, and a vertex for each between its ends.

    >>> import numpy as np
    >>> from solvers.primitives import annulus
    >>> from solvers.surface import cut_graph, handle_loops
    >>> surface = annulus(n=24)
    >>> t, rims = surface.triangulation, surface.boundary_loops
    >>> cut = cut_graph(t, rims, handle_loops(t, rims).chain, np.zeros(0, dtype=np.int64))
    >>> on_cut = np.unique([t.tail[cut], t.head[cut]])
    >>> len(cut) - int((~surface.boundary_vertices[on_cut]).sum())
    1
    """
    t = triangulation
    on_handles = np.flatnonzero(handle_chain.any(axis=0))
    terminal = _terminals(t, boundary_loops, on_handles, singular_vertices)
    joined = _steiner_tree(t, terminal)
    cut = np.concatenate([on_handles, joined])
    return np.unique(np.minimum(cut, t.twin[cut]))


def _terminals(
    t: IntrinsicTriangulation,
    boundary_loops: Sequence[IntArray],
    on_handles: IntArray,
    singular_vertices: IntArray,
) -> IntArray:
    """Return the number of the piece each vertex belongs to, -1 for none.

    Pieces are the handle loops with the boundaries they touch, each other boundary loop, and
    each other singularity.
    """
    terminal = np.full(t.n_vertices, -1, dtype=np.int64)
    terminal[t.tail[on_handles]] = 0
    for number, loop in enumerate(boundary_loops, start=1):
        terminal[loop] = 0 if (terminal[loop] == 0).any() else number
    free = singular_vertices[terminal[singular_vertices] < 0]
    terminal[free] = len(boundary_loops) + 1 + np.arange(len(free))
    return terminal


def _steiner_tree(t: IntrinsicTriangulation, terminal: IntArray) -> IntArray:
    seeds = np.flatnonzero(terminal >= 0)
    if len(np.unique(terminal[seeds])) < 2:
        return np.zeros(0, dtype=np.int64)
    h = np.flatnonzero(t.twin >= 0)
    length = t.lengths.reshape(-1)
    graph = HalfedgeGraph(t.n_vertices, t.tail[h], t.head[h], length[h], h)
    distance, predecessor, source = dijkstra(
        graph.matrix, indices=seeds, min_only=True, return_predecessors=True
    )
    region = terminal[source]
    between = h[region[t.tail[h]] != region[t.head[h]]]
    joining = distance[t.tail[between]] + length[between] + distance[t.head[between]]
    n = int(terminal.max()) + 1
    regions = HalfedgeGraph(n, region[t.tail[between]], region[t.head[between]], joining, between)
    tree = minimum_spanning_tree(regions.matrix).tocoo()
    bridges = regions.halfedges(tree.row.astype(np.int64), tree.col.astype(np.int64))
    pieces = [bridges]
    for end in np.concatenate([t.tail[bridges], t.head[bridges]]):
        path = np.array(walk_back(predecessor, int(end)), dtype=np.int64)
        pieces.append(graph.halfedges(path[1:], path[:-1]))
    return np.unique(np.concatenate(pieces))
