"""What makes a triangle soup unfit to be a surface, found element by element."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.errors import SurfaceError, counted, listed
from solvers.number_checks import LARGEST, real_numbers, whole_numbers
from solvers.remedies import RepairSurface, TakeLargest
from solvers.surface.triangulation import FloatArray, IntArray, next_halfedge

DEGENERATE = 1e-7
"""Twice the area over the squared longest edge, a pure number, at which a triangle is degenerate.

From double precision: its square, 1e-14, is what edge lengths can still tell from 0.
"""


def problems(vertices: FloatArray, faces: IntArray) -> tuple[SurfaceError, ...]:
    """Return every reason why the arrays are not one connected oriented manifold surface.

    Parameters
    ----------
    vertices : (n, 3) array
        Coordinates.
    faces : (m, 3) array
        Corner vertices.

    Returns
    -------
    tuple of SurfaceError
        Empty for a good surface; the first is the one to mend first. Checks that need sound
        indices are left out when indices are not sound.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.surface import problems
    >>> vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    >>> problems(vertices, np.array([[0, 1, 2], [2, 1, 3]]))
    ()
    >>> (problem,) = problems(vertices, np.array([[0, 1, 2], [1, 2, 3]]))  # one is turned over
    >>> problem.what, problem.kind, problem.elements.tolist()
    ('neighbouring triangles are oriented against each other at 1 edges', 'edges', [[1, 2]])
    """
    broken = tuple(array_problems(vertices, faces))
    if broken:
        return broken
    found = list(_element_problems(vertices, faces))
    pairs = HalfedgePairs(len(vertices), faces)
    found += _edge_problems(faces, pairs)
    if not found:
        found += _connection_problems(len(vertices), faces, pairs.twin)
    return tuple(found)


class HalfedgePairs:
    """Halfedges grouped by their undirected edge.

    Attributes
    ----------
    order : (3 m,) int array
        Halfedges sorted by edge.
    count : (3 m,) int array
        How many halfedges share each halfedge's edge.
    twin : (3 m,) int array
        The partner where exactly two halfedges share an edge, else -1.
    """

    def __init__(self, n_vertices: int, faces: IntArray) -> None:
        tail = faces.reshape(-1)
        head = faces[:, [1, 2, 0]].reshape(-1)
        key = np.minimum(tail, head) * np.int64(n_vertices) + np.maximum(tail, head)
        self.order = np.argsort(key, kind="stable")
        ordered = key[self.order]
        first = np.flatnonzero(np.r_[True, ordered[1:] != ordered[:-1]])
        size = np.diff(np.r_[first, len(ordered)])
        self.count = np.empty(len(key), dtype=np.int64)
        self.count[self.order] = np.repeat(size, size)
        start = first[size == 2]
        self.twin = np.full(len(key), -1, dtype=np.int64)
        one, other = self.order[start], self.order[start + 1]
        self.twin[one] = other
        self.twin[other] = one


def fan_labels(twin: IntArray) -> tuple[int, IntArray]:
    """Group the corners of a triangulation into fans, corners joined around a vertex.

    Parameters
    ----------
    twin : (3 m,) int array
        Twin of each halfedge, -1 without.

    Returns
    -------
    count : int
        Number of fans; a manifold has one for each vertex.
    label : (3 m,) int array
        The fan of each corner.
    """
    h = np.flatnonzero(twin >= 0)
    around = next_halfedge(twin[h])
    graph = coo_array((np.ones(len(h), dtype=np.int8), (h, around)), shape=(len(twin),) * 2)
    count, label = connected_components(graph, directed=False)
    return int(count), label.astype(np.int64)


def as_arrays(vertices: npt.ArrayLike, faces: npt.ArrayLike) -> tuple[FloatArray, IntArray]:
    """Return new arrays of what is to be a surface.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
        Coordinates.
    faces : (m, 3) array_like of int
        Corner vertices.

    Raises
    ------
    SurfaceError
        If they are no numbers, or corners no whole ones; what else they are is not asked.
    """
    # a single number has no rows to look at
    return (
        np.atleast_1d(real_numbers("the coordinates of vertices", vertices, error=SurfaceError)),
        np.atleast_1d(whole_numbers("the corners of triangles", faces, error=SurfaceError)),
    )


def array_problems(vertices: FloatArray, faces: IntArray) -> Iterator[SurfaceError]:
    """Yield what keeps the arrays from being coordinates and vertex numbers at all.

    Parameters
    ----------
    vertices : (n, 3) float array
        Coordinates.
    faces : (m, 3) int array
        Corner vertices.

    Yields
    ------
    SurfaceError
        The first is the one to mend first.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.surface import array_problems
    >>> for problem in array_problems(np.eye(3), np.array([[0, 1, 5]])):
    ...     print(problem.what, problem.elements.tolist())
    triangles name vertices outside 0..2 [0]
    """
    if vertices.ndim != 2 or vertices.shape[1] != 3 or faces.ndim != 2 or faces.shape[1] != 3:
        yield SurfaceError(
            "vertices and faces must have three columns",
            f"got shapes {vertices.shape} and {faces.shape}",
        )
        return
    if len(faces) == 0 or len(vertices) == 0:
        yield SurfaceError(
            "the surface is empty",
            f"{len(vertices)} vertices, {len(faces)} triangles",
            "give at least one triangle",
        )
        return
    bad = np.flatnonzero(~(np.abs(vertices) < LARGEST).all(axis=1))
    if len(bad):
        yield SurfaceError(
            f"coordinates are not finite numbers below {LARGEST:g}",
            f"vertices {listed(bad)}",
            "mend the file they come from",
            bad,
            "vertices",
        )
    bad = np.flatnonzero(((faces < 0) | (faces >= len(vertices))).any(axis=1))
    if len(bad):
        yield SurfaceError(
            f"triangles name vertices outside 0..{len(vertices) - 1}",
            f"triangles {listed(bad)}",
            "mend the file they come from",
            bad,
            "faces",
        )


def degenerate_faces(vertices: FloatArray, faces: IntArray) -> npt.NDArray[np.bool_]:
    """Return the (m,) mask of triangles without area, or too flat to have a direction."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    double_area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    longest = np.max([((q - p) ** 2).sum(axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    return np.asarray(double_area <= DEGENERATE * longest)


def duplicate_faces(faces: IntArray) -> npt.NDArray[np.bool_]:
    """Return the (m,) mask of triangles with the corners of an earlier one."""
    ordered = np.sort(faces, axis=1)
    by_corner = np.lexsort(ordered.T)
    same = (ordered[by_corner[1:]] == ordered[by_corner[:-1]]).all(axis=1)
    mask = np.zeros(len(faces), dtype=bool)
    mask[by_corner[1:][same]] = True
    return mask


def _element_problems(vertices: FloatArray, faces: IntArray) -> Iterator[SurfaceError]:
    bad = np.flatnonzero(degenerate_faces(vertices, faces))
    if len(bad):
        yield SurfaceError(
            f"{counted(len(bad), 'degenerate triangle')} without area",
            f"triangles {listed(bad)}",
            elements=bad,
            kind="faces",
            remedies=[RepairSurface("repair the surface, which drops them")],
        )
    bad = np.flatnonzero(duplicate_faces(faces))
    if len(bad):
        yield SurfaceError(
            counted(len(bad), "duplicate triangle"),
            f"triangles {listed(bad)}",
            elements=bad,
            kind="faces",
            remedies=[RepairSurface("repair the surface, which drops them")],
        )
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    bad = np.flatnonzero(~used)
    if len(bad):
        yield SurfaceError(
            f"{counted(len(bad), 'vertex')} of no triangle",
            f"vertices {listed(bad)}",
            elements=bad,
            kind="vertices",
            remedies=[RepairSurface("repair the surface, which drops them")],
        )


def _edge_problems(faces: IntArray, pairs: HalfedgePairs) -> Iterator[SurfaceError]:
    tail = faces.reshape(-1)
    head = faces[:, [1, 2, 0]].reshape(-1)
    ends = np.sort(np.stack([tail, head], axis=1), axis=1)
    crowded = np.flatnonzero(pairs.count > 2)
    if len(crowded):
        edges = np.unique(ends[crowded], axis=0)
        yield SurfaceError(
            f"{counted(len(edges), 'non-manifold edge')} with more than two triangles",
            f"edges {listed(edges)}",
            elements=edges,
            kind="edges",
            remedies=[RepairSurface("repair the surface, which cuts it apart there")],
        )
    h = np.flatnonzero(pairs.twin >= 0)
    wrong = h[tail[h] == tail[pairs.twin[h]]]
    if len(wrong):
        edges = np.unique(ends[wrong], axis=0)
        yield SurfaceError(
            f"neighbouring triangles are oriented against each other at {len(edges)} edges",
            f"edges {listed(edges)}",
            elements=edges,
            kind="edges",
            remedies=[RepairSurface("repair the surface, which turns them where that can be done")],
        )


def _connection_problems(n_vertices: int, faces: IntArray, twin: IntArray) -> list[SurfaceError]:
    found = []
    tail = faces.reshape(-1)
    count, label = fan_labels(twin)
    if count > n_vertices:
        vertex_of_fan = np.empty(count, dtype=np.int64)
        vertex_of_fan[label] = tail
        bad = np.flatnonzero(np.bincount(vertex_of_fan, minlength=n_vertices) > 1)
        found.append(
            SurfaceError(
                f"{counted(len(bad), 'non-manifold vertex')} where separate sheets touch",
                f"vertices {listed(bad)}",
                elements=bad,
                kind="vertices",
                remedies=[RepairSurface("repair the surface, which cuts it apart there")],
            )
        )
    sizes = component_sizes(n_vertices, faces)
    if len(sizes) > 1:
        found.append(
            SurfaceError(
                f"the surface has {len(sizes)} separate components",
                f"of {listed(sizes)} triangles",
                "solve each on its own",
                remedies=[TakeLargest("choose the largest")],
            )
        )
    return found


def face_components(n_vertices: int, faces: IntArray) -> IntArray:
    """Return the component of each face, numbered from the largest (most faces) down.

    Parameters
    ----------
    n_vertices : int
        Number of vertices.
    faces : (m, 3) int array
        Corner vertices; faces that share a vertex belong together.

    Returns
    -------
    (m,) int array
    """
    rows = faces[:, [0, 1]].reshape(-1)
    columns = faces[:, [1, 2]].reshape(-1)
    graph = coo_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), (n_vertices,) * 2)
    _, label = connected_components(graph, directed=False)
    of_face = label[faces[:, 0]]
    size = np.bincount(of_face, minlength=label.max() + 1)
    rank = np.empty(len(size), dtype=np.int64)
    rank[np.argsort(-size, kind="stable")] = np.arange(len(size))
    return np.asarray(rank[of_face])


def component_sizes(n_vertices: int, faces: IntArray) -> IntArray:
    """Return the number of faces of each component, the largest first."""
    return np.bincount(face_components(n_vertices, faces))
