"""Merge coincident vertices, and mend triangles without area while keeping the surface whole."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from solvers.errors import SurfaceError, counted
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray, next_halfedge
from solvers.surface.validation import HalfedgePairs, degenerate_faces

COINCIDENT = 1e-6
"""Distance of vertices that count as one, in diagonals of the bounding box.

From single precision, in which many formats store coordinates: ten of its roundings.
"""

ROUNDS = 20
"""How often flat triangles are looked for again after mending some. Chosen."""


def merge_coincident(points: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray, str]:
    """Return the arrays with one vertex for all at the same place, and a note.

    Triangles that shrink to an edge or a point by it are dropped.

    Parameters
    ----------
    points : (n, 3) float array
        Coordinates, finite; places are the same up to `COINCIDENT`.
    triangles : (m, 3) int array
        Corners.

    Returns
    -------
    points, triangles : arrays
        The first vertex of each place is kept.
    note : str
        What was done; empty for nothing.

    Examples
    --------
    Two triangles that share a side, each with vertices of its own:

    >>> import numpy as np
    >>> from solvers.repair.flat_triangles import merge_coincident
    >>> points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> points, triangles, note = merge_coincident(points, np.array([[0, 1, 2], [3, 4, 5]]))
    >>> triangles.tolist(), note
    ([[0, 1, 2], [1, 3, 2]], 'merged 2 coincident vertices')
    """
    places, number = np.unique(points, axis=0, return_inverse=True)
    reach = COINCIDENT * float(np.linalg.norm(np.ptp(points, axis=0)))
    pairs = cKDTree(places).query_pairs(reach, output_type="ndarray")
    group = first_of_joined(len(places), pairs)[number.reshape(-1)]
    lowest = _first_of_each(group)
    kept = lowest == np.arange(len(points))
    if kept.all():
        return points, triangles, ""
    faces = (np.cumsum(kept) - 1)[lowest][triangles]
    whole = _three_corners(faces)
    note = f"merged {counted(int((~kept).sum()), 'coincident vertex')}"
    if not whole.all():
        note += f", dropped {counted(int((~whole).sum()), 'triangle')} that vanished by it"
    return points[kept], faces[whole], note


def mend_flat_triangles(
    points: FloatArray, triangles: IntArray
) -> tuple[FloatArray, IntArray, str]:
    """Return the arrays without degenerate triangles, and a note.

    The ends of a very short edge become one vertex; a flat triangle with three apart corners is
    flipped with the neighbour over its longest edge, or dropped on the boundary.

    Parameters
    ----------
    points : (n, 3) float array
        Coordinates.
    triangles : (m, 3) int array
        Corners.

    Returns
    -------
    points, triangles : arrays
        The points are those given.
    note : str
        What was done; empty for nothing.

    Raises
    ------
    SurfaceError
        If no triangle has an area.
    """
    flat_ones = degenerate_faces(points, triangles)
    if len(triangles) and flat_ones.all():
        raise SurfaceError(
            "there are only triangles without area",
            counted(len(triangles), "triangle"),
            elements=np.arange(len(triangles)),
            kind="faces",
        )
    count = int(flat_ones.sum())
    for _ in range(ROUNDS):
        flat = np.flatnonzero(degenerate_faces(points, triangles))
        if not len(flat):
            break
        corners = points[triangles[flat]]
        length = np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
        short = length <= COINCIDENT * length.max(axis=1, keepdims=True)
        if short.any():
            which, side = np.nonzero(short)
            ends = np.stack([triangles[flat[which], side], triangles[flat[which], side - 2]], 1)
            triangles = first_of_joined(len(points), ends)[triangles]
            triangles = triangles[_three_corners(triangles)]
        else:
            triangles = _flip(len(points), triangles, 3 * flat + length.argmax(axis=1))
    triangles = triangles[~degenerate_faces(points, triangles)]
    note = f"mended {counted(count, 'triangle')} without area" if count else ""
    return points, triangles, note


def _flip(n_points: int, triangles: IntArray, longest: IntArray) -> IntArray:
    """Flip the given halfedges of flat triangles; drop the triangles of those on the boundary.

    Of flips that share a triangle only the first is made.
    """
    twin = HalfedgePairs(n_points, triangles).twin[longest]
    drop = longest[twin < 0] // 3
    longest, twin = longest[twin >= 0], twin[twin >= 0]
    turn = np.arange(len(longest))
    first = np.full(len(triangles), len(longest))
    for face in (longest // 3, twin // 3):
        np.minimum.at(first, face, turn)
    alone = (first[longest // 3] == turn) & (first[twin // 3] == turn)
    longest, twin = longest[alone], twin[alone]
    corner = triangles.reshape(-1)
    a, b = corner[longest], corner[next_halfedge(longest)]
    apex, opposite = (corner[next_halfedge(next_halfedge(h))] for h in (longest, twin))
    result = triangles.copy()
    result[longest // 3] = np.stack([a, opposite, apex], axis=1)
    result[twin // 3] = np.stack([opposite, b, apex], axis=1)
    return np.delete(result, np.setdiff1d(drop, twin // 3), axis=0)


def first_of_joined(n: int, pairs: IntArray) -> IntArray:
    """Return for each of n items the lowest item that the pairs join it to."""
    graph = coo_array((np.ones(len(pairs), dtype=np.int8), tuple(pairs.T)), (n, n))
    return _first_of_each(connected_components(graph, directed=False)[1])


def _first_of_each(label: IntArray) -> IntArray:
    """Return for each item the first item with the same label."""
    first, of_item = np.unique(label, return_index=True, return_inverse=True)[1:]
    return np.asarray(first[of_item])


def _three_corners(triangles: IntArray) -> BoolArray:
    return np.asarray((triangles != triangles[:, [1, 2, 0]]).all(axis=1))
