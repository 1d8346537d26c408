"""A closed surface with any number of handles."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from solvers.primitives.checks import affordable, whole
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface


def genus(handles: int = 2, subdivisions: int = 3) -> TriSurface:
    """Return a smooth closed surface of the given genus: a bar with a row of holes through it.

    A coarse block of cubes, one missing for each handle, refined by Catmull-Clark subdivision.

    Parameters
    ----------
    handles : int, optional
        The genus.
    subdivisions : int, optional
        How often each square is split in four.

    Returns
    -------
    TriSurface
        Closed.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, or there would be too many vertices.

    Notes
    -----
    Catmull and Clark 1978.

    Examples
    --------
    >>> from solvers.primitives import genus
    >>> surface = genus(handles=3, subdivisions=1)
    >>> surface.genus, surface.euler_characteristic
    (3, -4)
    """
    handles = whole("handles", handles, 1)
    subdivisions = whole("subdivisions", subdivisions, 1)
    affordable(32.0 * handles * 4.0 ** min(subdivisions, 99))
    cubes = np.ones((2 * handles + 1, 3, 1), dtype=bool)
    cubes[1::2, 1] = False
    vertices, quads = _shell(cubes)
    for _ in range(subdivisions):
        vertices, quads = _catmull_clark(vertices, quads)
    return TriSurface(vertices, _split(vertices, quads))


def _shell(cubes: npt.NDArray[np.bool_]) -> tuple[FloatArray, IntArray]:
    """Return the outside of a block of cubes: vertices about the origin, and outward squares."""
    filled = np.pad(cubes, 1)
    squares = []
    for axis in range(3):
        u, v = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        change = np.diff(filled.astype(int), axis=axis)
        for outward, corners in ((-1, [0 * u, u, u + v, v]), (1, [0 * u, v, u + v, u])):
            place = np.argwhere(change == outward)
            place[:, axis] += 1
            squares.append(place[:, None, :] + np.array(corners))
    places, number = np.unique(np.concatenate(squares).reshape(-1, 3), axis=0, return_inverse=True)
    return places - 0.5 * np.array(filled.shape), number.reshape(-1, 4)


def _catmull_clark(vertices: FloatArray, quads: IntArray) -> tuple[FloatArray, IntArray]:
    """Return one Catmull-Clark subdivision of a closed quad mesh."""
    n = len(vertices)
    ends = np.sort(quads[:, [[0, 1], [1, 2], [2, 3], [3, 0]]].reshape(-1, 2), axis=1)
    edges, number = np.unique(ends, axis=0, return_inverse=True)
    side = number.reshape(-1, 4)
    face_points = vertices[quads].mean(axis=1)
    middles = vertices[edges].mean(axis=1)
    around_edge = _mean(side, face_points, len(edges))
    edge_points = 0.5 * (middles + around_edge)
    valence = np.bincount(quads.reshape(-1), minlength=n)[:, None]
    around = _mean(quads, face_points, n)
    spokes = _mean(edges, middles, n)
    moved = (around + 2 * spokes + (valence - 3) * vertices) / valence
    edge_number = n + side
    face_number = n + len(edges) + np.arange(len(quads))
    finer = np.stack(
        [
            np.stack([quads[:, i], edge_number[:, i], face_number, edge_number[:, i - 1]], axis=1)
            for i in range(4)
        ],
        axis=1,
    )
    return np.concatenate([moved, edge_points, face_points]), finer.reshape(-1, 4)


def _mean(cells: IntArray, values: FloatArray, n: int) -> FloatArray:
    """Return the mean over the cells at each of n corners of the cells' (k, 3) values."""
    corner = cells.reshape(-1)
    repeated = np.repeat(values, cells.shape[1], axis=0)
    sums = np.stack([np.bincount(corner, repeated[:, i], n) for i in range(3)], axis=1)
    return np.asarray(sums / np.bincount(corner, minlength=n)[:, None])


def _split(vertices: FloatArray, quads: IntArray) -> IntArray:
    """Return two triangles for each quad, along its shorter diagonal."""
    a, b, c, d = quads.T
    p, q, r, s = (vertices[corner] for corner in (a, b, c, d))
    short = np.linalg.norm(p - r, axis=1) <= np.linalg.norm(q - s, axis=1)
    first = np.where(short[:, None], np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(short[:, None], np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.stack([first, second], axis=1).reshape(-1, 3)
