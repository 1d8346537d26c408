"""The surfaces and configurations that the tests of the solvers share."""

from collections.abc import Callable, Sequence

import numpy as np

from solvers.primitives import BUILTIN
from solvers.singularities.budget import Singularity, default_corners
from solvers.surface.trisurface import TriSurface

SURFACES: dict[str, Callable[[], TriSurface]] = {
    "sphere": lambda: BUILTIN["sphere"](subdivisions=3),
    "disk": lambda: BUILTIN["disk"](edge_length=0.1),
    "square": lambda: BUILTIN["square"](n=12),
    "l_shape": lambda: BUILTIN["l_shape"](edge_length=0.15),
    "annulus": lambda: BUILTIN["annulus"](n=48),
    "plate": lambda: BUILTIN["plate_with_holes"](holes=3, edge_length=0.2),
    "cylinder": lambda: BUILTIN["cylinder"](n=32),
    "torus": lambda: BUILTIN["torus"](n=36),
    "torus_with_hole": lambda: BUILTIN["torus_with_hole"](n=36),
    "double_torus": lambda: BUILTIN["genus"](handles=2, subdivisions=2),
    "slivers": lambda: slivers(),
}


def slivers() -> TriSurface:
    """A bent sheet with a hole whose triangles are far from Delaunay: sheared and stretched."""
    flat = BUILTIN["annulus"](n=48)
    x, y, _ = flat.vertices.T
    return TriSurface(np.stack([x + 4 * y, 0.3 * y, 0.05 * np.sin(3 * x)], axis=1), flat.faces)


def polar_annulus(around: int, rings: int, inner: float = 0.4) -> TriSurface:
    """An annulus of radius 1 cut along circles and spokes, however long that makes triangles."""
    radius, angle = np.meshgrid(
        np.linspace(inner, 1, rings), 2 * np.pi * np.arange(around) / around, indexing="ij"
    )
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    number = np.arange(rings * around).reshape(rings, around)
    after = np.roll(number, -1, axis=1)
    a, b, c, d = (n.ravel() for n in (number[:-1], after[:-1], number[1:], after[1:]))
    faces = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
    return TriSurface(np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1), faces)


def at_vertices(
    surface: TriSurface, vertices: Sequence[int], valences: Sequence[int]
) -> list[Singularity]:
    return [
        Singularity(surface.point_at_vertex(int(v)), k)
        for v, k in zip(vertices, valences, strict=True)
    ]


def random_configuration(surface: TriSurface, seed: int, pairs: int = 2) -> list[Singularity]:
    """Singularities at random inner vertices that meet the index budget."""
    missing = 4 * surface.euler_characteristic - sum(default_corners(surface).values())
    valences = [4 - int(np.sign(missing))] * abs(missing) + [3, 5] * pairs
    inner = np.flatnonzero(~surface.boundary_vertices)
    chosen = np.random.default_rng(seed).choice(inner, len(valences), replace=False)
    return at_vertices(surface, chosen.tolist(), valences)


def separated(surface: TriSurface, seed: int, valences: list[int], gap: float) -> list[Singularity]:
    """Singularities at random vertices that keep a distance from each other and the boundary."""
    rng = np.random.default_rng(seed)
    inner = np.flatnonzero(~surface.boundary_vertices)
    if surface.boundary_loops:
        rim = surface.vertices[surface.boundary_vertices]
        away = np.linalg.norm(surface.vertices[inner][:, None] - rim[None], axis=2).min(axis=1)
        inner = inner[away > 0.5 * gap]
    for _ in range(10_000):
        chosen = rng.choice(inner, len(valences), replace=False)
        distance = np.linalg.norm(
            surface.vertices[chosen][:, None] - surface.vertices[chosen][None], axis=2
        )
        if (distance + np.eye(len(chosen)) * 9).min() > gap:
            return at_vertices(surface, chosen.tolist(), valences)
    raise ValueError("no room for the singularities")
