"""What goes wrong where arcs of a T-mesh get no edges, and the conditions that rule it out.

Where two opposite sides of a rectangle have no edge, the other two become one. So each vertex of
the quad mesh, and each edge, is a whole piece of the T-mesh (`solvers.quads.merged` has a picture).
The mesh has the topology of the surface when every piece is a tree (up to rectangles that vanish
altogether) and meets the boundary in one stretch or not at all. It has its singularities when no
piece holds two of them, or one and a part of the boundary.

Of one rectangle with corners 0 to 3 and arcs a to d around it,

    3 --c-- 2
    |       |
    d       b
    |       |
    0 --a-- 1

a and c may not be without edges, for then corners that quads are to keep apart are one:

>>> import numpy as np
>>> from solvers.layouts.tmesh import TMesh
>>> every, arcs = np.ones(4, dtype=bool), np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
>>> tmesh = TMesh(
...     arcs, np.ones(4), every, np.full(4, 2), every, every, np.arange(5), 2 * np.arange(4)
... )
>>> sorted({(*cut.arcs.tolist(), cut.least) for cut in broken(tmesh, np.array([0, 2, 0, 2]))})
[(0, 1), (2, 1)]
>>> broken(tmesh, np.array([1, 2, 1, 2]))
[]
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import breadth_first_order

from solvers.layouts.tmesh import TMesh
from solvers.quads.merged import Causes, Merged, Numbering, merged
from solvers.surface.graphs import HalfedgeGraph, walk_back
from solvers.surface.triangulation import IntArray

MOST_CUTS = 50
"""Double edges that are looked at together. Chosen."""


@dataclass(frozen=True, eq=False)
class Condition:
    """A condition: arcs that need so many edges together.

    Parameters
    ----------
    arcs : (k,) int array
        The arcs.
    least : int
        Their least sum.

    Examples
    --------
    Of a rectangle of 2 by 1, as in `solvers.layouts.TMesh`, the long side gets five edges at least:

    >>> import numpy as np
    >>> from solvers.layouts import TMesh
    >>> from solvers.quads import Condition, quantize
    >>> every, ends = np.ones(4, dtype=bool), np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> lengths, sides = np.array([2.0, 1.0, 2.0, 1.0]), 2 * np.arange(4)
    >>> tmesh = TMesh(ends, lengths, every, np.full(4, 2), every, every, np.arange(5), sides)
    >>> quantize(tmesh, 0.5, conditions=[Condition(np.array([0]), 5)]).counts.tolist()
    [5, 2, 5, 2]
    """

    arcs: IntArray
    least: int


def least_counts(tmesh: TMesh) -> IntArray:
    """Return the fewest edges (A,) of each arc: 0 where nothing speaks against it at sight.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    """
    loop = tmesh.arcs[:, 0] == tmesh.arcs[:, 1]
    held = tmesh.critical[tmesh.arcs]
    # A boundary that a singularity is not on is held against it, too.
    held |= tmesh.node_on_boundary[tmesh.arcs] & ~tmesh.arc_on_boundary[:, None]
    return np.where(loop, 3, held.all(axis=1).astype(np.int64))


def broken(tmesh: TMesh, counts: IntArray) -> list[Condition]:
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
    vertices, edges = merged(tmesh, counts)
    found = [*_torn(vertices), *_torn(edges), *_unseparated(tmesh, vertices)]
    return found or _doubles(Numbering(tmesh, counts), vertices, edges)


def _torn(points: Merged) -> list[Condition]:
    """Return a condition for each piece that would change the topology."""
    return [Condition(points.arcs(points.within(np.array([k]))), 1) for k in points.torn]


def _unseparated(tmesh: TMesh, vertices: Merged) -> list[Condition]:
    """Return a condition for each way between critical nodes, or from one to the boundary."""
    critical = np.flatnonzero(tmesh.critical)
    crowd = vertices.holding(critical)
    rim = np.flatnonzero(vertices.on_boundary)
    inner = critical[~tmesh.node_on_boundary[critical]]
    crowded = (crowd > 1) | ((vertices.holding(inner) > 0) & (vertices.holding(rim) > 0))
    if not crowded.any():
        return []
    rows, columns = np.concatenate([vertices.joins.pairs, vertices.joins.pairs[:, ::-1]]).T
    number = np.tile(np.arange(len(vertices.joins.pairs)), 2)
    graph = HalfedgeGraph(len(vertices.label), rows, columns, np.ones(len(rows)), number)
    found = []
    for start in critical[crowded[vertices.label[critical]]].tolist():
        order, before = breadth_first_order(graph.matrix, start)
        ends = [v for v in order[1:].tolist() if v < tmesh.n_nodes and tmesh.critical[v]]
        if not tmesh.node_on_boundary[start]:
            ends += order[vertices.on_boundary[order]].tolist()[:1]
        for end in ends:
            path = np.array(walk_back(before, end))
            found.append(Condition(vertices.arcs(graph.halfedges(path[:-1], path[1:])), 1))
    return found


def _doubles(numbers: Numbering, vertices: Merged, edges: Merged) -> list[Condition]:
    """Return a condition for each pair of edges with the same ends, and each with one end twice."""
    tmesh, counts = numbers.tmesh, numbers.counts
    pairs, arc = numbers.edges()
    first = np.unique(edges.label, return_index=True)[1]
    ends, cause = [pairs[first]], [arc[first]]
    causes = Causes(tmesh)
    # Inside rectangles, only edges from one side to the other can be double.
    for r, k in np.argwhere((numbers.sides[:, [1, 0]] == 1) & (numbers.sides[:, :2] > 1)).tolist():
        ends.append(numbers.across(r, k)[0])
        cause.append(np.full(len(ends[-1]), causes.side(r, 1 - k)))
    why = np.concatenate(cause)
    piece = np.sort(vertices.label[np.concatenate(ends)], axis=1)
    _, group, times = np.unique(piece, axis=0, return_inverse=True, return_counts=True)
    group = group.reshape(-1)
    found = []
    for k in np.unique(group[(times[group] > 1) | (piece[:, 0] == piece[:, 1])])[:MOST_CUTS]:
        members = np.flatnonzero(group == k)
        joining = vertices.arcs(vertices.within(piece[members[0]]))
        involved = np.union1d(joining, causes.arcs(why[members]))
        found.append(Condition(involved, int(counts[involved].sum()) + 1))
    return found
