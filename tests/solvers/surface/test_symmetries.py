"""Isometries of meshes: groups, their orders, and what they do."""

import numpy as np
import pytest

from solvers.primitives import BUILTIN
from solvers.surface.symmetries import isometries
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import SURFACES


@pytest.mark.parametrize(
    ("name", "order", "mirrors"),
    [
        ("square", 8, 4),
        ("rectangle", 4, 2),
        ("cube_sphere", 48, 24),
        ("ellipsoid", 8, 4),
        ("torus", 16, 8),  # of those of a cube; a torus has more
        ("l_shape", 1, 0),
        ("blob", 1, 0),
    ],
)
def test_known_groups_are_found(name: str, order: int, mirrors: int) -> None:
    group = isometries(BUILTIN[name]())
    assert (len(group), sum(g.mirrors for g in group)) == (order, mirrors)


def test_an_icosphere_has_those_that_cube_and_icosahedron_share() -> None:
    assert len(isometries(SURFACES["sphere"]())) == 24


def directed(faces: np.ndarray) -> set[tuple[int, ...]]:
    """The sides of triangles, each with its direction."""
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2)
    return set(map(tuple, sides.reshape(-1, 2).tolist()))


@pytest.mark.parametrize("name", SURFACES)
def test_they_are_a_group_that_keeps_places_lengths_and_sides(name: str) -> None:
    surface = SURFACES[name]()
    group = isometries(surface)
    assert np.array_equal(group[0].vertices, np.arange(surface.n_vertices))
    known = {g.vertices.tobytes() for g in group}
    for g in group:
        assert {g.vertices[h.vertices].tobytes() for h in group} == known
        x = surface.vertices
        assert np.abs(g.image(x) - x[g.vertices]).max() < 1e-5 * surface.diagonal
        ends = np.sort(g.vertices[surface.edges], axis=1)
        assert np.array_equal(ends, np.sort(surface.edges[g.edges], axis=1))
        turned = g.vertices[surface.faces]
        assert directed(turned[:, ::-1] if g.mirrors else turned) == directed(surface.faces)


def test_a_moved_and_turned_surface_has_as_many() -> None:
    surface = BUILTIN["ellipsoid"](subdivisions=2)
    turn = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    moved = TriSurface(surface.vertices @ turn.T + [1, 2, 3], surface.faces)
    assert len(isometries(moved)) == len(isometries(surface)) == 8


def test_one_vertex_off_breaks_the_symmetry() -> None:
    sphere = BUILTIN["cube_sphere"](n=4)
    x = sphere.vertices * np.where(np.arange(sphere.n_vertices) == 5, 1.01, 1.0)[:, None]
    assert len(isometries(TriSurface(x, sphere.faces))) < 48
