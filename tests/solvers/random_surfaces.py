"""Surfaces and configurations drawn by Hypothesis: polygons triangulated, built-ins shaken."""

import numpy as np
from hypothesis import assume, reject
from hypothesis import strategies as st
from numpy.typing import NDArray

from solvers.errors import SurfaceError
from solvers.primitives import (
    annulus,
    cylinder,
    disk,
    genus,
    plate_with_holes,
    sphere,
    square,
    torus,
    torus_with_hole,
)
from solvers.primitives import planar as triangulated
from solvers.singularities.budget import Singularity
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import random_configuration

BUILT_IN = (
    square(n=6),
    disk(edge_length=0.3),
    annulus(n=20),
    plate_with_holes(holes=2, edge_length=0.22),
    cylinder(n=16),
    sphere(subdivisions=2),
    torus(n=16),
    torus_with_hole(n=36),
    genus(handles=2, subdivisions=1),
)
SEEDS = st.integers(0, 2**32 - 1)


@st.composite
def polygons(draw: st.DrawFn) -> TriSurface:
    """A polygon of 4 to 8 corners that its middle sees, not always convex; some with a hole."""
    n = draw(st.integers(4, 8))
    radius = draw(st.lists(st.floats(0.6, 1.4), min_size=n, max_size=n))
    turn = draw(st.lists(st.floats(-0.25, 0.25), min_size=n, max_size=n))
    angle = 2 * np.pi * (np.arange(n) + turn) / n
    outer = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    holes = [0.3 * outer[::-1]] if draw(st.booleans()) else []
    try:
        return triangulated(outer.tolist(), [hole.tolist() for hole in holes], edge_length=0.25)
    except SurfaceError:  # too thin somewhere for triangles of this size
        reject()


@st.composite
def shaken(draw: st.DrawFn) -> TriSurface:
    """A built-in surface whose vertices are moved by up to a fifth of their shortest edge."""
    surface = draw(st.sampled_from(BUILT_IN))
    rng = np.random.default_rng(draw(SEEDS))
    stretch = np.array(draw(st.tuples(*[st.floats(0.5, 2.0)] * 3)))
    ends = surface.vertices[surface.edges]
    shortest = np.full(surface.n_vertices, np.inf)
    lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    np.minimum.at(shortest, surface.edges, lengths[:, None])
    way = rng.normal(size=surface.vertices.shape)
    way *= 0.2 * (rng.uniform(size=len(way)) * shortest / np.linalg.norm(way, axis=1))[:, None]
    return TriSurface((surface.vertices + way) * stretch, surface.faces)


def surfaces() -> st.SearchStrategy[TriSurface]:
    return st.one_of(polygons(), shaken())


@st.composite
def configured(
    draw: st.DrawFn, on: st.SearchStrategy[TriSurface] | None = None
) -> tuple[TriSurface, list[Singularity]]:
    """A surface and singularities at inner vertices of it that meet its index budget."""
    surface = draw(surfaces() if on is None else on)
    assume(np.count_nonzero(~surface.boundary_vertices) >= 16)
    return surface, random_configuration(surface, draw(SEEDS), pairs=draw(st.integers(0, 2)))


@st.composite
def motions(draw: st.DrawFn) -> tuple[NDArray[np.float64], float]:
    """A rotation (3, 3) and a scale."""
    rng = np.random.default_rng(draw(SEEDS))
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return turn * np.sign(np.linalg.det(turn)), draw(st.floats(0.01, 100.0))
