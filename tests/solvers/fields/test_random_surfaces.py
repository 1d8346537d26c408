"""Identities that hold on every surface, for every configuration that meets its budget."""

import numpy as np
from hypothesis import given
from numpy.typing import NDArray

from solvers.algebra.operators import midpoint_offsets, stiffness
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.least_squares import least_squares_theta
from solvers.primitives import cylinder
from solvers.singularities.budget import Singularity, default_corners, index_budget
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import wrap
from solvers.surface.trisurface import TriSurface
from tests.solvers.random_surfaces import configured, motions, surfaces

QUARTER = np.pi / 2
Configured = tuple[TriSurface, list[Singularity]]


@given(surfaces())
def test_gauss_and_bonnet(surface: TriSurface) -> None:
    total = 2 * np.pi * surface.euler_characteristic
    assert abs(surface.angle_defects.sum() - total) < 1e-9
    assert surface.euler_characteristic == 2 - 2 * surface.genus - len(surface.boundary_loops)


@given(configured())
def test_the_budget_is_four_times_the_euler_characteristic(drawn: Configured) -> None:
    surface, singularities = drawn
    corners = default_corners(surface)
    budget = index_budget(surface, singularities, corners)
    assert budget.satisfied
    assert budget.required == 4 * surface.euler_characteristic
    assert sum(s.index for s in singularities) + sum(corners.values()) == budget.required


@given(configured())
def test_H_flattens_all_curvature_into_the_singularities(drawn: Configured) -> None:
    """Liouville's equation: the metric e^(2 H) has the cone angles of the indices, and no more."""
    surface, singularities = drawn
    solver = IsotropicSolver(surface)
    field = solver.solve(singularities)
    t = solver.discretization.triangulation
    curvature = t.curvatures.copy()
    for s in singularities:
        curvature[surface.nearest_vertex(s.point)] -= QUARTER * s.index
    for vertex, index in field.corners.items():
        curvature[vertex] -= QUARTER * index
    assert np.abs(stiffness(t) @ field.solved.H - curvature).max() < 1e-9


@given(configured())
def test_theta_is_conjugate_to_H_over_every_edge(drawn: Configured) -> None:
    surface, singularities = drawn
    solver = IsotropicSolver(surface)
    field = solver.solve(singularities)
    assert field.max_closing_error < 1e-9
    assert len(field.defects) == 2 * surface.genus + max(len(surface.boundary_loops) - 1, 0)
    vertices = np.array([surface.nearest_vertex(s.point) for s in singularities], dtype=np.int64)
    h = field.solved.H
    offsets = midpoint_offsets(solver.discretization.triangulation, h)
    solved = least_squares_theta(solver.discretization, h, vertices)
    assert np.abs(solved - solver.discretization.walk(offsets)).max() < 1e-8


@given(configured(), motions())
def test_moved_and_scaled_a_surface_has_the_same_field(
    drawn: Configured, motion: tuple[NDArray[np.float64], float]
) -> None:
    surface, singularities = drawn
    turn, scale = motion
    moved = TriSurface(scale * surface.vertices @ turn.T, surface.faces)
    field = IsotropicSolver(surface).solve(singularities)
    other = IsotropicSolver(moved).solve(singularities)
    assert np.ptp(other.H - field.H) < 1e-8
    assert np.abs(wrap(other.defects - field.defects, QUARTER)).max(initial=0.0) < 1e-8
    between = np.einsum("ij,ij->i", other.u, field.u @ turn.T)
    off = np.arccos(np.clip(between, -1.0, 1.0))
    if surface.boundary_loops:
        assert np.abs(wrap(off, QUARTER)).max() < 1e-6


def test_a_triangle_that_was_halved_has_the_same_cross_whichever_way_it_lies() -> None:
    """Its barycentre is on the cut, and rounding would choose the side."""
    stretched = cylinder(n=16).vertices * [2.0, 0.5, 1.0]
    surface = TriSurface(stretched, cylinder(n=16).faces)
    field = IsotropicSolver(surface).solve([])
    rng = np.random.default_rng(0)
    for _ in range(4):
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        turn *= np.sign(np.linalg.det(turn))
        other = IsotropicSolver(TriSurface(stretched @ turn.T, surface.faces)).solve([])
        between = np.einsum("ij,ij->i", other.u, field.u @ turn.T)
        off = np.arccos(np.clip(between, -1.0, 1.0))
        assert np.abs(wrap(off, QUARTER)).max() < 1e-6


# where there are handles, which edges their loops run along, and never flip, is a matter of numbers
@given(configured(surfaces().filter(lambda surface: surface.genus == 0)))
def test_the_numbers_of_faces_and_vertices_mean_nothing(drawn: Configured) -> None:
    surface, singularities = drawn
    rng = np.random.default_rng(0)
    order, new = rng.permutation(surface.n_faces), rng.permutation(surface.n_vertices)
    vertices = np.empty_like(surface.vertices)
    vertices[new] = surface.vertices
    renumbered = TriSurface(vertices, new[surface.faces][order])
    place = np.argsort(order)
    same = [
        Singularity(SurfacePoint(int(place[s.point.face]), s.point.barycentric), s.valence)
        for s in singularities
    ]
    field = IsotropicSolver(surface).solve(singularities)
    assert np.ptp(IsotropicSolver(renumbered).solve(same).H[new] - field.H) < 1e-8
