"""Connectivity of regular patterns of triangles."""

from __future__ import annotations

import numpy as np

from solvers.surface.triangulation import FloatArray, IntArray


def grid(columns: int, rows: int) -> IntArray:
    """Return the triangles of a grid whose diagonals run from each corner towards the middle.

    With even numbers of cells the pattern has the grid's own symmetry, and no triangle has two
    edges on the boundary.

    Parameters
    ----------
    columns, rows : int
        Number of cells; vertex (i, j) has number j * (columns + 1) + i.

    Returns
    -------
    (2 columns rows, 3) int array
        Counter-clockwise where i points right and j up.
    """
    j, i = np.mgrid[0:rows, 0:columns].reshape(2, -1)
    a = j * (columns + 1) + i
    b, c, d = a + 1, a + columns + 2, a + columns + 1
    rising = (2 * i < columns - 1) == (2 * j < rows - 1)
    first = np.where(rising[:, None], np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(rising[:, None], np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.stack([first, second], axis=1).reshape(-1, 3)


def rings(around: int, rows: int, *, closed: bool = False) -> tuple[IntArray, FloatArray]:
    """Return rings of vertices, every second one turned by half a step, with triangles between.

    Parameters
    ----------
    around : int
        Vertices on each ring.
    rows : int
        Number of rings; even when they close.
    closed : bool, optional
        Whether the last ring is followed by the first.

    Returns
    -------
    faces : (m, 3) int array
        Counter-clockwise where the angle grows to the right and the row upwards; vertex i of
        ring j has number j * around + i.
    angle : (rows, around) float array
        Angle of each vertex, radians.
    """
    j, i = np.mgrid[0 : rows if closed else rows - 1, 0:around].reshape(2, -1)
    above = (j + 1) % rows
    following = (i + 1) % around
    a, b = j * around + i, j * around + following
    c, d = above * around + following, above * around + i
    turned = (j % 2 == 1)[:, None]
    first = np.where(turned, np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(turned, np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    row, column = np.mgrid[0:rows, 0:around]
    angle = (column + 0.5 * (row % 2)) * (2 * np.pi / around)
    return np.stack([first, second], axis=1).reshape(-1, 3), angle


def hexagon(n: int) -> tuple[IntArray, IntArray, FloatArray]:
    """Return a middle vertex within n rings of 6, 12, ..., 6 n vertices.

    Parameters
    ----------
    n : int
        Number of rings.

    Returns
    -------
    faces : (6 n^2, 3) int array
        Counter-clockwise.
    ring : (1 + 3 n (n + 1),) int array
        Ring of each vertex.
    angle : (1 + 3 n (n + 1),) float array
        Its angle in radians.
    """

    def number(k: IntArray, sector: IntArray, place: IntArray) -> IntArray:
        around = np.maximum(6 * k, 1)
        return np.where(k == 0, 0, 1 + 3 * k * (k - 1) + (sector * k + place) % around)

    k, place = (a[:, None] for a in np.tril_indices(n))
    k, sector = k + 1, np.arange(6)
    outward = [number(k - 1, sector, place), number(k, sector, place)]
    up = np.stack([*outward, number(k, sector, place + 1)], axis=-1)
    inner = (place < k - 1)[:, 0]
    k, place = k[inner], place[inner]
    inward = [number(k - 1, sector, place), number(k, sector, place + 1)]
    down = np.stack([*inward, number(k - 1, sector, place + 1)], axis=-1)
    ring = np.repeat(np.arange(n + 1), np.maximum(6 * np.arange(n + 1), 1))
    start = 1 + 3 * ring * (ring - 1)
    angle = np.where(ring > 0, (np.arange(len(ring)) - start) * np.pi / 3 / np.maximum(ring, 1), 0)
    return np.concatenate([up.reshape(-1, 3), down.reshape(-1, 3)]), ring, angle


def subdivide(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Return the triangles split in four at their edges' middles."""
    ends = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, number = np.unique(ends, axis=0, return_inverse=True)
    ab, bc, ca = (len(vertices) + number.reshape(-1, 3)).T
    a, b, c = faces.T
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    finer = np.stack([np.stack(part, axis=1) for part in parts], axis=1).reshape(-1, 3)
    return np.concatenate([vertices, vertices[edges].mean(axis=1)]), finer
