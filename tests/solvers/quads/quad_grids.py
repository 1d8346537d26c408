"""Quad meshes with closed forms, for the tests of quads."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from solvers.primitives import BUILTIN
from solvers.quads.projection import Projection
from solvers.quads.quadmesh import QuadMesh
from solvers.quads.rails import boundary_rails
from solvers.surface.trisurface import TriSurface

Array = npt.NDArray[np.float64]


def on_surface(
    surface: TriSurface, places: Array, quads: npt.NDArray[np.int64], fixed: list[int]
) -> QuadMesh:
    """Quads whose vertices are put on the surface, those of the boundary on its nearest loop."""
    projection = Projection(surface)
    faces, weights = projection.nearest(places)
    held = np.zeros(len(places), dtype=bool)
    held[fixed] = True
    loop, patch = np.full(len(places), -1), np.zeros(len(quads), dtype=np.int64)
    mesh = QuadMesh(surface, places, quads, patch, faces, weights, held, loop)
    on = np.flatnonzero(mesh.on_boundary)
    rails = boundary_rails(surface)
    if rails:
        gaps = [places[on] - rail.positions(rail.nearest(places[on])) for rail in rails]
        loop[on] = np.argmin(np.linalg.norm(gaps, axis=2), axis=0)
    for number, rail in enumerate(rails):
        on = np.flatnonzero(loop == number)
        faces[on], weights[on] = rail.points(rail.nearest(places[on]))
    return replace(mesh, vertices=projection.positions(faces, weights))


def lattice(
    columns: int, rows: int, *, around: bool = False, closed: bool = False
) -> npt.NDArray[np.int64]:
    """Quads of a lattice numbered row by row; the columns, and the rows, may close up."""
    width = columns if around else columns + 1
    height = rows if closed else rows + 1
    j, i = np.divmod(np.arange(columns * rows), columns)
    right, up = (i + 1) % width, (j + 1) % height
    return np.stack([j * width + i, j * width + right, up * width + right, up * width + i], axis=1)


def annulus(around: int = 60, rows: int = 12, noise: float = 0.0) -> QuadMesh:
    surface = BUILTIN["annulus"](n=96)
    angle = 2 * np.pi * np.arange(around) / around
    radius = 0.4 ** (1 - np.arange(rows + 1) / rows)
    rng = np.random.default_rng(0)
    r, a = (x.reshape(-1) for x in np.meshgrid(radius, -angle, indexing="ij"))
    inner = (r > 0.4 + 1e-9) & (r < 1 - 1e-9)
    a = a + noise * rng.uniform(-1, 1, len(a)) * 2 * np.pi / around
    r = np.where(inner, r * (1 + noise * rng.uniform(-1, 1, len(r)) * 2 * np.pi / around), r)
    places = np.stack([r * np.cos(a), r * np.sin(a), 0 * r], axis=1)
    return on_surface(surface, places, lattice(around, rows, around=True), [0])


def torus(around: int = 60, rows: int = 24, noise: float = 0.0) -> QuadMesh:
    surface = BUILTIN["torus"](n=48)
    rng = np.random.default_rng(0)
    v, u = (
        x.reshape(-1)
        for x in np.meshgrid(np.arange(rows) / rows, np.arange(around) / around, indexing="ij")
    )
    u = 2 * np.pi * (u + noise * rng.uniform(-1, 1, len(u)) / around)
    v = 2 * np.pi * (v + noise * rng.uniform(-1, 1, len(v)) / rows)
    r = 1 + 0.4 * np.cos(v)
    places = np.stack([r * np.cos(u), r * np.sin(u), 0.4 * np.sin(v)], axis=1)
    return on_surface(surface, places, lattice(around, rows, around=True, closed=True), [])


def sphere(n: int = 12, noise: float = 0.0) -> QuadMesh:
    """A cube blown up: eight vertices of valence 3."""
    surface = BUILTIN["sphere"](subdivisions=4)
    grid = 2 * np.arange(n + 1) - n
    y, x = (a.reshape(-1) for a in np.meshgrid(grid, grid, indexing="ij"))
    face = np.stack([x, y, np.full_like(x, n)], axis=1)
    turns = [np.roll(np.eye(3, dtype=int), k, axis=1) for k in range(3)]
    turns += [turn * [[-1], [1], [-1]] for turn in turns]
    places, number = np.unique(
        np.concatenate([face @ turn for turn in turns]), axis=0, return_inverse=True
    )
    quads = number.reshape(-1)[np.concatenate([lattice(n, n) + k * len(face) for k in range(6)])]
    fixed = np.flatnonzero((np.abs(places) == n).all(axis=1))
    rng = np.random.default_rng(0)
    moved = np.where(
        (np.abs(places) == n).all(axis=1)[:, None], 0, rng.uniform(-1, 1, places.shape)
    )
    out = np.tan(np.pi / 4 * (places + 2 * noise * moved) / n)
    out /= np.linalg.norm(out, axis=1)[:, None]
    return on_surface(surface, out, quads, fixed.tolist())


def square(n: int = 10, noise: float = 0.0) -> QuadMesh:
    surface = BUILTIN["square"](n=16)
    rng = np.random.default_rng(0)
    y, x = (a.reshape(-1) for a in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
    at_x, at_y = (x == 0) | (x == n), (y == 0) | (y == n)
    x = x + np.where(at_x, 0, noise * rng.uniform(-1, 1, len(x)))
    y = y + np.where(at_y, 0, noise * rng.uniform(-1, 1, len(y)))
    places = np.stack([x / n - 0.5, y / n - 0.5, 0 * x], axis=1)
    return on_surface(surface, places, lattice(n, n), np.flatnonzero(at_x & at_y).tolist())


GRIDS: dict[str, Callable[..., QuadMesh]] = {
    "annulus": annulus,
    "torus": torus,
    "sphere": sphere,
    "square": square,
}
