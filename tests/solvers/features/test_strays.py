"""What sharp edges the triangles make, and what the shape does."""

import numpy as np
import pytest

from solvers.features.dihedral import dihedral_angles, sharp_edges
from solvers.features.edges import Features, no_features
from solvers.features.strays import SHORT, without_strays
from solvers.primitives import BUILTIN
from solvers.surface.edge_paths import EdgePaths
from solvers.surface.trisurface import TriSurface

LEAST = np.radians(40)


def on_grid(*corners: tuple[int, int]) -> Features:
    """A path on a square of 16 cells a side through given vertices, along the cells."""
    surface = BUILTIN["square"](n=16, size=16.0)
    grid = surface.vertices[:, :2] + 8
    vertices = [int(np.argmin(np.linalg.norm(grid - corner, axis=1))) for corner in corners]
    return no_features(surface).united(EdgePaths(surface).through(np.array(vertices)))


def kept(features: Features, degrees: float) -> int:
    """How many edges are left if all bend by so much."""
    bends = np.full(len(features.surface.edges), np.radians(degrees))
    return len(without_strays(features, bends, LEAST))


def test_a_short_end_stays_if_it_is_sharp() -> None:
    short = on_grid((4, 8), (4 + SHORT - 1, 8))
    assert kept(short, 45) == 0
    assert kept(short, 70) == SHORT - 1
    assert kept(on_grid((4, 8), (4 + SHORT, 8)), 45) == SHORT


def test_a_zigzag_is_no_feature_however_sharp_but_a_bent_line_is() -> None:
    steps = [(3 + (i + 1) // 2, 3 + i // 2) for i in range(17)]
    assert kept(on_grid(*steps), 90) == 0
    assert kept(on_grid((3, 3), (11, 3), (11, 11)), 90) == 16


def test_what_has_no_loose_end_stays() -> None:
    loop = on_grid((7, 7), (8, 7), (8, 8), (7, 8), (7, 7))
    assert kept(loop, 41) == 4
    across = on_grid((0, 8), (16, 8))
    assert kept(across, 41) == 16
    assert kept(on_grid((0, 8), (16, 8), (8, 8), (8, 10)), 41) == 16  # less a spur
    assert kept(on_grid((0, 8), (3, 8)), 41) == 0  # one end on the boundary, one loose


@pytest.mark.parametrize("n", [2, 4])
def test_the_edges_of_a_block_are_all_features_however_coarse_it_is(n: int) -> None:
    sphere = BUILTIN["cube_sphere"](n=n)
    reach = np.abs(sphere.vertices).max(axis=1)
    block = TriSurface(sphere.vertices / reach[:, None] * [3.0, 1.0, 0.4], sphere.faces)
    assert len(sharp_edges(block, 40)) == 12 * n


@pytest.mark.parametrize("seed", range(4))
def test_noise_makes_few_features_of_its_own(seed: int) -> None:
    """On a rough sheet edges bend by chance; what crosses it by 90 degrees stays as it is."""
    flat = BUILTIN["square"](n=24)
    rng = np.random.default_rng(seed)
    x, y, _ = flat.vertices.T
    rough = np.where(np.abs(x) > 1e-9, rng.normal(scale=0.01, size=len(x)), 0.0)
    rough[flat.boundary_vertices] = 0.0
    roof = TriSurface(np.stack([x, y, -np.abs(x) + rough], axis=1), flat.faces)
    fold = np.flatnonzero((np.abs(roof.vertices[roof.edges][:, :, 0]) < 1e-9).all(axis=1))
    found = sharp_edges(roof, 40)
    assert np.isin(fold, found).all()
    by_chance = np.count_nonzero(dihedral_angles(roof) > LEAST) - len(fold)
    assert len(found) - len(fold) <= by_chance / 2


@pytest.mark.parametrize("degrees", [35, 45, 60, 90])
def test_the_edges_of_a_wedge_are_all_features(degrees: float) -> None:
    """They are sharp, so that narrow sectors between them are the shape's."""
    a = np.radians(degrees)
    base = np.array([[0, 0, 0], [1, 0, 0], [np.cos(a), np.sin(a), 0]])
    faces = [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]
    wedge = TriSurface(np.concatenate([base, base + [0, 0, 1]]), faces)
    assert len(sharp_edges(wedge, 40)) == 9
