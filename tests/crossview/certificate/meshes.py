"""Meshes and surfaces with closed forms, made of nothing but arithmetic."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from crossview.certificate import Faces, Reference

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def lattice(columns: int, rows: int, around: bool = False) -> Ints:
    """Quads of a lattice numbered row by row; the columns may close up."""
    width = columns if around else columns + 1
    j, i = np.divmod(np.arange(columns * rows), columns)
    right = (i + 1) % width
    quads = [j * width + i, j * width + right, (j + 1) * width + right, (j + 1) * width + i]
    return np.stack(quads, axis=1)


def halved(quads: Ints) -> Ints:
    """Two triangles of each quad."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def flat(n: int) -> Floats:
    """The places of a lattice of n x n squares on the unit square."""
    t = np.linspace(0, 1, n + 1)
    y, x = np.repeat(t, n + 1), np.tile(t, n + 1)
    return np.stack([x, y, 0 * x], axis=1)


def square(n: int = 8) -> Faces:
    """The unit square in n x n quads."""
    return Faces.of_one_size(flat(n), lattice(n, n))


def unit_square(n: int = 5) -> Reference:
    """The unit square as a surface."""
    return Reference(Faces.of_one_size(flat(n), halved(lattice(n, n))))


def rings(around: int, rows: int) -> Floats:
    """Places on circles of radius 1/2 to 1 whose quads are similar, counter-clockwise."""
    angle = 2 * np.pi * np.arange(around) / around
    radius = 0.5 ** (1 - np.arange(rows + 1) / rows)
    r, a = np.repeat(radius, around), np.tile(-angle, rows + 1)
    return np.stack([r * np.cos(a), r * np.sin(a), 0 * r], axis=1)


def annulus(around: int = 60, rows: int = 6) -> Faces:
    return Faces.of_one_size(rings(around, rows), lattice(around, rows, around=True))


def ring(around: int = 240, rows: int = 12) -> Reference:
    """The annulus as a surface."""
    quads = lattice(around, rows, around=True)
    return Reference(Faces.of_one_size(rings(around, rows), halved(quads)))


def with_points(mesh: Faces, points: Floats) -> Faces:
    return replace(mesh, points=points)


def moved(mesh: Faces, vertex: int, place: npt.ArrayLike) -> Faces:
    """The same with one vertex elsewhere."""
    points = mesh.points.copy()
    points[vertex] = place
    return with_points(mesh, points)


def with_faces(mesh: Faces, faces: npt.ArrayLike) -> Faces:
    """The same vertices with other quads."""
    return Faces.of_one_size(mesh.points, faces)


def quads_of(mesh: Faces) -> Ints:
    return mesh.corners.reshape(-1, 4).copy()


def roof(degrees: float) -> Reference:
    """Two slopes that meet along the y axis, for |x| and |y| up to 2."""
    points = on_roof(degrees, [(x, y) for x in (-2, 0, 2) for y in (-2, 2)])
    faces = [[0, 2, 1], [2, 3, 1], [2, 4, 3], [4, 5, 3]]
    return Reference(Faces.of_one_size(points, faces))


def on_roof(degrees: float, places: npt.ArrayLike) -> Floats:
    """The places (k, 2) of the plane, on the roof."""
    x, y = np.array(places, dtype=float).T
    return np.stack([x, y, -np.tan(np.radians(degrees)) * np.abs(x)], axis=1)
