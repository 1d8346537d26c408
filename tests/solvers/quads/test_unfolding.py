"""Unfolding: its energy against differences, graded sides, a block that is mirrored in place."""

import numpy as np
import pytest

from solvers.quads.sliding import Sliding
from solvers.quads.unfolding import _Energy, graded, unfold
from tests.solvers.quads.quad_grids import lattice, on_surface, square

UP = np.array([0.0, 0.0, 1.0])


def test_the_gradient_is_that_of_differences() -> None:
    rng = np.random.default_rng(1)
    quads = lattice(3, 2)
    vertices = rng.normal(size=(12, 3))
    normals = rng.normal(size=(6, 4, 3))
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    energy = _Energy(quads, normals, rng.uniform(0.5, 2, (6, 4)), 0.3)
    gradient = energy.value(vertices)[1]
    way = rng.normal(size=vertices.shape)
    ahead, back = (energy.value(vertices + h * way)[0] for h in (1e-5, -1e-5))
    assert (ahead - back) / 2e-5 == pytest.approx((gradient * way).sum(), rel=1e-7)


def test_squares_of_the_wanted_size_are_the_least() -> None:
    """Each corner costs 2 and twice the area's share, at ease 0; any move costs more."""
    quads = lattice(3, 3)
    y, x = np.divmod(np.arange(16), 4)
    flat = np.stack([x, y, 0 * x], axis=1).astype(float)
    energy = _Energy(quads, np.tile(UP, (9, 4, 1)), np.ones((9, 4)), 1e-9)
    value, gradient = energy.value(flat)
    assert value == pytest.approx(36 * 2.2)
    assert np.abs(gradient).max() < 1e-6
    moves = np.random.default_rng(0).normal(size=(20, 16, 3)) * 0.05
    assert all(energy.value(flat + move)[0] > value for move in moves)


def test_sides_grow_by_little_along_their_quads_and_only_become_shorter() -> None:
    sides = np.array([[1.0, 20.0, 1.0, 3.0], [1.0, 1.0, 1.0, 1.0]])
    assert graded(lattice(4, 1), sides).tolist() == [[1.0, 1.5, 1.0, 1.5], [1.0] * 4]
    # across, sides may differ by any factor
    assert graded(lattice(1, 4), sides).tolist() == sides.tolist()
    assert graded(lattice(4, 1)[:, [1, 2, 3, 0]], sides[::-1])[1].tolist() == [1.0, 1.5, 1.0, 1.5]


@pytest.mark.parametrize("power", [3.0, 6.0])
def test_a_block_pressed_through_its_border_comes_back(power: float) -> None:
    """A block of quads is mirrored in place, so that no single vertex has a way out."""
    mesh = square(12)
    places = mesh.vertices.copy()
    block = np.abs(places[:, :2]).max(axis=1) < 0.5 - power / 12 / 2
    assert block.sum() >= 9
    places[block, 0] *= -0.5
    folded = on_surface(mesh.surface, places, mesh.quads, np.flatnonzero(mesh.fixed).tolist())
    assert (folded.scaled_jacobian <= 0).sum() >= 9
    sliding = Sliding(folded, [], np.where(folded.on_boundary, 0, -1))
    inner = np.flatnonzero(~folded.on_boundary)
    found = unfold(sliding, sliding.start(), inner, np.full((2, folded.n_quads), 1 / 12))
    assert sliding.quality(found, folded.quads).min() > 0.15
    assert (found.vertices[folded.on_boundary] == folded.vertices[folded.on_boundary]).all()
