"""Rotations and mirrors that take a surface's vertices onto vertices and edges onto edges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np
from scipy.spatial import cKDTree

from solvers.frozen import freeze_arrays
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface

NEAR = 1e-5
"""By how much a vertex may miss its image, in diagonals of the bounding box. Chosen, above the
rounding of coordinates in single precision.
"""

TRIED = 64
"""How many vertices are tried before all are. Chosen: the most that fail, fail there."""


@dataclass(frozen=True, eq=False)
class Isometry:
    """A rotation or a mirror of a surface onto itself, x to (x - centre) matrix^T + centre.

    Parameters
    ----------
    matrix : (3, 3) float array
        Orthogonal.
    centre : (3,) float array
        What stays.
    vertices : (n,) int array
        To which vertex each goes.
    edges : (ne,) int array
        To which edge each goes.
    mirrors : bool
        Whether it turns left into right on the surface.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import square
    >>> from solvers.surface import isometries
    >>> surface = square(n=2)
    >>> quarter = isometries(surface)[1]
    >>> np.allclose(quarter.image(surface.vertices), surface.vertices[quarter.vertices])
    True
    """

    matrix: FloatArray
    centre: FloatArray
    vertices: IntArray
    edges: IntArray
    mirrors: bool

    def __post_init__(self) -> None:
        freeze_arrays(self)

    def image(self, positions: FloatArray) -> FloatArray:
        """Return where positions (k, 3) go.

        Parameters
        ----------
        positions : (k, 3) float array
            In space.
        """
        return np.asarray((positions - self.centre) @ self.matrix.T + self.centre)


def isometries(surface: TriSurface) -> tuple[Isometry, ...]:
    """Return a group of isometries of space that take a surface's mesh onto itself.

    Those of a cube are tried, along the coordinate axes through the middle of the bounding box and
    along the principal axes through the centroid; the larger group counts.

    Parameters
    ----------
    surface : TriSurface
        The surface.

    Returns
    -------
    tuple of Isometry
        The identity first; of a flat surface one of each two that do the same.

    Examples
    --------
    A square has four turns and four mirrors:

    >>> from solvers.primitives import square
    >>> from solvers.surface import isometries
    >>> sum(g.mirrors for g in isometries(square(n=2))), len(isometries(square(n=2)))
    (4, 8)
    """
    return max((tuple(_group(surface, *frame)) for frame in _frames(surface)), key=len)


def _frames(surface: TriSurface) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield centres (3,) and axes (3, 3; rows)."""
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    yield 0.5 * (low + high), np.eye(3)
    centroid = surface.face_areas @ surface.barycentres / surface.area
    spread = surface.vertices - centroid
    yield centroid, np.linalg.svd(spread, full_matrices=False)[2]


def _group(surface: TriSurface, centre: FloatArray, axes: FloatArray) -> Iterator[Isometry]:
    x = surface.vertices
    n = len(x)
    tree = cKDTree(x)
    limit = NEAR * surface.diagonal
    some = np.linspace(0, n - 1, min(n, TRIED)).astype(np.int64)
    keys = _keys(surface.edges, n)
    order = np.argsort(keys)
    of_faces = _triples(surface.faces)
    found: set[bytes] = set()
    for places in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            matrix = axes.T @ (np.eye(3)[list(places)] * signs) @ axes
            image = (x - centre) @ matrix.T + centre
            if tree.query(image[some], distance_upper_bound=limit)[0].max() > limit:
                continue
            away, vertices = tree.query(image, distance_upper_bound=limit)
            if away.max() > limit or len(np.unique(vertices)) < n:
                continue
            image_keys = _keys(vertices[surface.edges], n)
            at = order[np.minimum(np.searchsorted(keys, image_keys, sorter=order), len(keys) - 1)]
            if (keys[at] != image_keys).any() or vertices.tobytes() in found:
                continue
            turned = vertices[surface.faces]
            for mirrors, faces in ((False, turned), (True, turned[:, ::-1])):
                if np.array_equal(_triples(faces), of_faces):
                    found.add(vertices.tobytes())
                    yield Isometry(matrix, centre, vertices, at, mirrors)


def _keys(edges: IntArray, n: int) -> IntArray:
    """Return a number for each edge of two of n vertices, whichever comes first."""
    ends = np.sort(edges, axis=1)
    return np.asarray(ends[:, 0] * n + ends[:, 1])


def _triples(faces: IntArray) -> IntArray:
    """Return triangles, each from its least vertex on, in ascending order."""
    first = np.argmin(faces, axis=1)[:, None]
    rolled = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
    return np.asarray(rolled[np.lexsort(rolled.T)])
