"""Intrinsic Delaunay flips: the metric stays, the weights become non-negative."""

import numpy as np
import pytest

from solvers.fields.isotropic import IsotropicSolver
from solvers.primitives import BUILTIN
from solvers.surface.delaunay import intrinsic_delaunay
from solvers.surface.triangulation import wrap
from solvers.surface.trisurface import TriSurface
from solvers.surface.working import WorkingTriangulation
from tests.solvers.suite import SURFACES, random_configuration


def flipped(surface: TriSurface) -> WorkingTriangulation:
    return intrinsic_delaunay(surface.triangulation)


@pytest.mark.parametrize("name", SURFACES)
def test_flips_keep_the_metric_and_end_delaunay(name: str) -> None:
    surface = SURFACES[name]()
    t = flipped(surface).triangulation
    inner = t.twin >= 0
    assert t.weights[inner].min() > -1e-9
    assert t.areas.sum() == pytest.approx(surface.area, rel=1e-12)
    assert np.abs(t.curvatures - surface.angle_defects).max() < 1e-9
    h = np.flatnonzero(inner)
    assert (t.twin[t.twin[h]] == h).all()
    assert (t.tail[h] == t.head[t.twin[h]]).all()


def test_a_stretched_sheet_needs_flips() -> None:
    assert flipped(SURFACES["slivers"]()).n_flips > 500


def test_points_and_directions_are_followed_through_the_flips() -> None:
    """On a flat sheet a linear function tells place, and its gradient direction, exactly."""
    flat = BUILTIN["annulus"](n=48)
    x, y, _ = flat.vertices.T
    surface = TriSurface(np.stack([x + 4 * y, 0.3 * y, 0 * x], axis=1), flat.faces)
    delaunay = flipped(surface)
    own, t = surface.triangulation, delaunay.triangulation
    value = surface.vertices @ [0.7, -0.4, 0.0]
    rng = np.random.default_rng(0)
    weights = rng.dirichlet([1, 1, 1], size=surface.n_faces)
    flat_places = np.einsum("ki,kij->kj", weights, own.corner_positions)
    located = delaunay.locate(np.arange(surface.n_faces), flat_places)
    gradient = t.gradients(value[t.faces])
    corner = t.corner_positions[located.face]
    reached = value[t.faces[located.face, 0]] + np.einsum(
        "ki,ki->k", gradient[located.face], located.place - corner[:, 0]
    )
    expected = np.einsum("ki,ki->k", weights, value[surface.faces])
    assert np.abs(reached - expected).max() < 1e-9
    before = own.gradients(value[own.faces])
    angle_before = np.arctan2(before[:, 1], before[:, 0])
    there = gradient[located.face]
    angle_after = np.arctan2(there[:, 1], there[:, 0]) - located.turn
    assert np.abs(wrap(angle_after - angle_before, 2 * np.pi)).max() < 1e-9


def test_fixed_edges_stay_and_carry_their_numbers() -> None:
    surface = SURFACES["slivers"]()
    own = surface.triangulation
    edges = own.edge_halfedges[own.twin[own.edge_halfedges] >= 0]
    kept = edges[own.weights[edges] < 0][::3]
    chain = np.zeros((1, len(own.twin)), dtype=np.int64)
    chain[0, kept] = np.arange(1, len(kept) + 1)
    delaunay = intrinsic_delaunay(own, chain)
    t = delaunay.triangulation
    there = np.flatnonzero(delaunay.marks[0])
    number = delaunay.marks[0, there] - 1
    assert sorted(number.tolist()) == list(range(len(kept)))
    assert (t.tail[there] == own.tail[kept[number]]).all()
    assert (t.head[there] == own.head[kept[number]]).all()


def test_the_field_on_slivers_agrees_with_good_triangles() -> None:
    """A square cut into slivers by a sheared grid has the straight field of the square."""
    n = 12
    x, y = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n)
    vertices = np.stack([x.ravel(), 40 * y.ravel(), 0 * x.ravel()], axis=1)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    faces = np.concatenate(
        [
            np.stack([corner, corner + 1, corner + n + 2], axis=1),
            np.stack([corner, corner + n + 2, corner + n + 1], axis=1),
        ]
    )
    field = IsotropicSolver(TriSurface(vertices, faces)).solve([])
    assert np.abs(field.H).max() < 1e-9
    angle = np.arctan2(field.u[:, 1], field.u[:, 0])
    assert np.abs(wrap(angle, np.pi / 2)).max() < 1e-9


def test_crosses_of_neighbours_agree_on_the_surface_itself() -> None:
    """Away from singularities the crosses, brought back from the flips, vary little."""
    surface = SURFACES["slivers"]()
    field = IsotropicSolver(surface).solve(random_configuration(surface, seed=1, pairs=1))
    own = surface.triangulation
    h = own.edge_halfedges[own.twin[own.edge_halfedges] >= 0]
    step = field.theta[h // 3] + own.transport[h] - field.theta[own.twin[h] // 3]
    turning = np.abs(wrap(step, np.pi / 2))
    assert np.median(turning) < np.radians(3)
