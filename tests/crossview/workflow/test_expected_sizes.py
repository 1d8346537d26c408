"""What is expected of quads, and which are looked at: closed forms and invariances."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import crossview
from crossview.scene.camera import Camera
from crossview.workflow.expected_sizes import expected_sizes
from crossview.workflow.spots import WORST, worst_quads
from solvers.primitives import annulus
from solvers.surface import TriSurface
from tests.solvers.quads.quad_grids import GRIDS


def test_edges_of_an_annulus_grow_with_the_radius() -> None:
    # e^H = c r, so the integral of e^-2H is 2 pi log(4) / c^2
    surface = annulus(inner=0.25, n=96)
    sizes = expected_sizes(crossview.solve(crossview.Problem(surface)))
    assert sizes.ratio == pytest.approx(4, rel=0.06)  # of triangles the mean
    radii = [np.linalg.norm(spot.place) for spot in (sizes.at_least, sizes.at_largest)]
    assert radii == pytest.approx([0.25, 1], rel=0.03)
    factor = np.sqrt(2 * np.pi * np.log(4) / 500)
    assert sizes.edges(500) == pytest.approx([factor * r for r in radii], rel=0.02)


def test_edges_go_with_the_surface_and_the_root_of_the_number() -> None:
    small = annulus(inner=0.25, n=48)
    large = TriSurface(7 * small.vertices, small.faces)
    of_small, of_large = (
        expected_sizes(crossview.solve(crossview.Problem(s))) for s in (small, large)
    )
    assert np.multiply(of_small.edges(100), 7) == pytest.approx(of_large.edges(100))
    assert np.divide(of_small.edges(100), 2) == pytest.approx(of_small.edges(400))


def test_the_worst_quads_are_told_worst_first_and_none_that_are_good() -> None:
    grid = GRIDS["square"]()
    assert worst_quads(grid) == ()
    moved = grid.vertices.copy()
    inner = np.flatnonzero(~grid.on_boundary)[0]
    moved[inner] += 0.4 * (grid.edge_lengths.mean() * np.array([1.0, 0.7, 0]))
    mesh = replace(grid, vertices=moved)
    worst = worst_quads(mesh)
    assert 0 < len(worst) <= WORST
    found = [quad.quality for quad in worst]
    assert found == sorted(found)
    assert found[0] == mesh.scaled_jacobian.min()
    near = np.linalg.norm(np.array(worst[0].spot.place) - moved[inner])
    assert near < worst[0].edge
    assert worst[0].spot.normal == pytest.approx((0, 0, 1))


@pytest.mark.parametrize("scale", [None, 3.0])
def test_a_camera_that_faces_a_place_sees_so_much_of_it(scale: float | None) -> None:
    before = Camera((5, 1, 2), (0, 0, 0), (0, 1, 0), parallel_scale=scale)
    place, normal = np.array([0.3, -0.2, 0.1]), np.array([0.6, 0.0, 0.8])
    seen = before.facing(place, normal, 0.5)
    away = np.subtract(seen.position, seen.focus)
    assert seen.focus == pytest.approx(tuple(place))
    assert away / np.linalg.norm(away) == pytest.approx(normal)
    assert np.dot(seen.up, normal) == pytest.approx(0)
    if scale is None:
        assert np.linalg.norm(away) * np.tan(np.radians(12)) == pytest.approx(0.25)
    else:
        assert seen.parallel_scale == 0.25
    # looked at along what was up before, it still has an up
    assert np.isfinite(before.facing(place, np.array([0.0, 1.0, 0.0]), 0.5).up).all()
