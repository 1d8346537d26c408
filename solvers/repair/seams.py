"""Join boundary edges that lie on each other: seams of files that repeat vertices along them."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from solvers.errors import counted
from solvers.repair.flat_triangles import COINCIDENT, first_of_joined, merge_coincident
from solvers.surface.triangulation import FloatArray, IntArray, next_halfedge
from solvers.surface.validation import HalfedgePairs, array_problems


def share_vertices(
    points: FloatArray, triangles: IntArray, *, merge: bool
) -> tuple[FloatArray, IntArray, str]:
    """Return the arrays with neighbouring triangles sharing vertices, and a note.

    Parameters
    ----------
    points : (n, 3) float array
        Coordinates.
    triangles : (m, 3) int array
        Corners; arrays that are no triangles at all come back as they are.
    merge : bool
        Make one vertex of all at the same place; else only along seams, as `join_seams` does.

    Returns
    -------
    points : (k, 3) float array
        Without those that became one with another.
    triangles : (l, 3) int array
        Corners; without triangles that vanish, where all are merged.
    note : str
        What was done; empty for nothing.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.repair import share_vertices
    >>> points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> points, triangles, note = share_vertices(
    ...     points, np.array([[0, 1, 2], [3, 4, 5]]), merge=False
    ... )
    >>> triangles.tolist(), note
    ([[0, 1, 2], [1, 3, 2]], 'joined 1 pair of boundary edges that lay on each other')
    """
    if any(array_problems(points, triangles)):
        return points, triangles, ""
    return (merge_coincident if merge else join_seams)(points, triangles)


def join_seams(points: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray, str]:
    """Return the arrays with boundary edges that lie on each other made one, and a note.

    Two boundary edges with the same ends are a seam, unless their triangles lie on each other, too,
    or are oriented against each other: across a seam of the second kind a surface may be one-sided,
    so it stays open and the note says so.

    Parameters
    ----------
    points : (n, 3) float array
        Coordinates, finite; places are the same up to `COINCIDENT`.
    triangles : (m, 3) int array
        Corners.

    Returns
    -------
    points : (k, 3) float array
        Without those that became one with another.
    triangles : (m, 3) int array
        Corners.
    note : str
        What was done and left; empty for nothing.
    """
    border = np.flatnonzero(HalfedgePairs(len(points), triangles).count == 1)
    corner = triangles.reshape(-1)
    follow = next_halfedge(border)
    tail, head, apex = corner[border], corner[follow], corner[next_halfedge(follow)]
    place = _places(points, np.unique(np.concatenate([tail, head, apex])))
    one, other = _pairs(place[tail], place[head])
    apart = place[apex[one]] != place[apex[other]]
    one, other = one[apart], other[apart]
    against = place[tail[one]] == place[tail[other]]
    left = int(against.sum())
    one, other = one[~against], other[~against]
    ends = np.concatenate(
        [np.stack([tail[one], head[other]], 1), np.stack([head[one], tail[other]], 1)]
    )
    lowest = first_of_joined(len(points), ends)
    kept = lowest == np.arange(len(points))
    joined = (np.cumsum(kept) - 1)[lowest][triangles]
    if (HalfedgePairs(int(kept.sum()), joined).count[border] > 2).any():
        return points, triangles, ""
    said = []
    if len(one):
        said.append(f"joined {counted(len(one), 'pair')} of boundary edges that lay on each other")
    if left:
        said.append(
            f"left {counted(left, 'pair')} of boundary edges apart that lie on each other, "
            "since their triangles are oriented against each other"
        )
    return points[kept], joined, ", ".join(said)


def _places(points: FloatArray, vertices: IntArray) -> IntArray:
    """For each point the first of those vertices at its place; itself for the others."""
    reach = COINCIDENT * float(np.linalg.norm(np.ptp(points, axis=0)))
    near = cKDTree(points[vertices]).query_pairs(reach, output_type="ndarray")
    return first_of_joined(len(points), vertices[near])


def _pairs(tail: IntArray, head: IntArray) -> tuple[IntArray, IntArray]:
    """The two of each pair of edges with the same ends; edges alone or of three are in none."""
    ends = np.sort(np.stack([tail, head], axis=1), axis=1)
    _, edge, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    edge = edge.reshape(-1)
    order = np.argsort(edge, kind="stable")
    paired = order[(count[edge[order]] == 2) & (tail[order] != head[order])]
    return paired[::2], paired[1::2]
