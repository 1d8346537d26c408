"""Refinement keeps shape, boundary and quality, and puts vertices at the singularities."""

import numpy as np
import pytest

from solvers.fields.isotropic import IsotropicSolver
from solvers.primitives import BUILTIN
from solvers.singularities.budget import default_corners
from solvers.surface.points import SurfacePoint
from solvers.surface.refinement import refine_at, refine_everywhere
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import SURFACES, at_vertices

ANYWHERE = (
    SurfacePoint(3, (1 / 3, 1 / 3, 1 / 3)),
    SurfacePoint(40, (0.6, 0.3, 0.1)),
    SurfacePoint(41, (0.5, 0.5, 0.0)),
    SurfacePoint(90, (0.0, 0.0, 1.0)),
    SurfacePoint(120, (0.2, 0.3, 0.5)),
    SurfacePoint(120, (0.5, 0.2, 0.3)),
)


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("levels", [0, 1, 3])
def test_shape_boundary_and_places_are_kept(name: str, levels: int) -> None:
    surface = SURFACES[name]()
    refinement = refine_at(surface, ANYWHERE, levels)
    refined = refinement.surface
    TriSurface(refined.vertices, refined.faces)  # a valid surface
    assert refined.area == pytest.approx(surface.area, rel=1e-12)
    assert refined.euler_characteristic == surface.euler_characteristic
    assert (refined.vertices[: surface.n_vertices] == surface.vertices).all()
    places = refined.vertices[refinement.vertices]
    assert np.abs(places - surface.positions(ANYWHERE)).max() < 1e-14
    assert [surface.loop_length(loop) for loop in surface.boundary_loops] == pytest.approx(
        [refined.loop_length(loop) for loop in refined.boundary_loops]
    )
    assert default_corners(refined) == default_corners(surface)
    # Each refined triangle lies in the plane of its parent, within it.
    for corner in range(3):
        for face in range(0, refined.n_faces, 7):
            point = SurfacePoint(face, tuple(np.eye(3)[corner]))
            lifted = refinement.lift(point)
            gap = surface.position(lifted) - refined.position(point)
            assert np.linalg.norm(gap) < 1e-12 * surface.diagonal


def test_triangles_halve_with_each_level_and_stay_well_shaped() -> None:
    surface = BUILTIN["sphere"](subdivisions=3)
    point = SurfacePoint(5, (0.4, 0.35, 0.25))
    sizes = []
    for levels in range(1, 5):
        refinement = refine_at(surface, [point], levels)
        refined, vertex = refinement.surface, int(refinement.vertices[0])
        around = (refined.faces == vertex).any(axis=1)
        sizes.append(refined.triangulation.lengths[around].mean())
        assert refined.triangle_quality.min() > 0.2
    assert np.array(sizes[:-1]) / np.array(sizes[1:]) == pytest.approx([2, 2, 2], rel=0.4)


def test_it_does_not_matter_in_which_triangle_a_point_on_a_vertex_or_edge_is_given() -> None:
    surface = BUILTIN["torus"](n=24)
    corner = int(surface.faces[30, 0])
    stars = [
        SurfacePoint(int(face), tuple(np.eye(3)[list(surface.faces[face]).index(corner)]))
        for face in np.flatnonzero((surface.faces == corner).any(axis=1))
    ]
    h = 3 * 30 + 1
    twin = int(surface.triangulation.twin[h])
    sides = [
        SurfacePoint(side // 3, tuple(np.roll([weight, 1 - weight, 0.0], side % 3)))
        for side, weight in ((h, 0.3), (twin, 0.7))
    ]
    for points in (stars, sides):
        refined = [refine_at(surface, [point], 3).surface for point in points]
        for other in refined[1:]:
            assert other.n_faces == refined[0].n_faces
            places = [np.sort(s.vertices.round(9) @ [1, np.pi, 7]) for s in (refined[0], other)]
            assert places[0] == pytest.approx(places[1], abs=1e-7)


def test_points_close_together_leave_no_triangle_without_area() -> None:
    """The second point lies on a short side that the first has made, next to its end."""
    surface = BUILTIN["square"](n=2)
    corner, middle = np.array([1.0, 0.0, 0.0]), np.full(3, 1 / 3)
    for gap in (1e-2, 1e-3, 1e-4):
        first = corner + gap * (middle - corner)
        second = corner + 1e-4 * (first - corner)
        points = [SurfacePoint(0, (p[0], p[1], p[2])) for p in (first, second)]
        refined = refine_at(surface, points, 0).surface
        TriSurface(refined.vertices, refined.faces)


def test_only_the_neighbourhood_changes() -> None:
    surface = BUILTIN["torus"](n=36)
    refinement = refine_at(surface, [SurfacePoint(0, (0.3, 0.3, 0.4))], 3)
    untouched = np.bincount(refinement.parent_face, minlength=surface.n_faces) == 1
    assert untouched.sum() > 0.95 * surface.n_faces


def test_the_field_next_to_a_singularity_gets_better_with_refinement() -> None:
    """On the disk, against the closed form, at a fixed small distance from the singularity."""
    surface = BUILTIN["disk"](edge_length=0.1)
    points = [
        surface.closest_point([0.5 * np.cos(a), 0.5 * np.sin(a), 0]) for a in (0.2, 2, 3.5, 5)
    ]
    places = surface.positions(points) @ [1, 1j, 0]
    errors = []
    for levels in (0, 2, 4):
        refinement = refine_at(surface, points, levels)
        refined = refinement.surface
        field = IsotropicSolver(refined).solve(
            at_vertices(refined, refinement.vertices.tolist(), [3] * 4)
        )
        z = refined.vertices @ [1, 1j, 0]
        rings = []
        for place in places:
            ring = refined.positions(
                [
                    refined.closest_point([w.real, w.imag, 0])
                    for w in place + 0.02 * np.exp(1j * np.linspace(0, 6.2, 24))
                ]
            )
            rings.append(ring @ [1, 1j, 0])
        w = np.concatenate(rings)
        found = np.array(
            [
                np.dot(p.barycentric, field.H[refined.faces[p.face]])
                for p in (refined.closest_point([v.real, v.imag, 0]) for v in w)
            ]
        )
        exact = (np.log(np.abs(w[:, None] - places) * np.abs(1 - w[:, None] * places.conj()))).sum(
            1
        )
        far = np.argmin(np.abs(z))
        level = (
            np.log(np.abs(z[far] - places) * np.abs(1 - z[far] * places.conj())).sum() / 4
            - field.H[far]
        )
        errors.append(np.abs(found - exact / 4 + level).max())
    assert errors[1] < 0.5 * errors[0]
    assert errors[2] < 0.5 * errors[1]


@pytest.mark.parametrize("gap", [1e-4, 1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("levels", [0, 2])
def test_points_next_to_edges_vertices_and_each_other_leave_a_surface_to_solve_on(
    gap: float, levels: int
) -> None:
    surface = BUILTIN["sphere"](subdivisions=1)
    points = [
        SurfacePoint(3, (0.4, 0.6 - gap, gap)),
        SurfacePoint(3, (0.3, 0.2, 0.5)),
        SurfacePoint(40, (gap, 1 - 3 * gap, 2 * gap)),
        SurfacePoint(40, (0.2, 0.4, 0.4)),
        SurfacePoint(60, (0.3, 0.3, 0.4)),
        SurfacePoint(60, (0.3 + 30 * gap, 0.3, 0.4 - 30 * gap)),
    ]
    points = points[:5] if gap < 1e-6 else points  # nearer ones become one point
    refinement = refine_at(surface, points, levels)
    refined = refinement.surface
    TriSurface(refined.vertices, refined.faces)
    assert refined.area == pytest.approx(surface.area, rel=1e-12)
    moved = refined.vertices[refinement.vertices] - surface.positions(points)
    assert np.linalg.norm(moved, axis=1).max() < 1e-5
    valences = [2, 2, 3, 3, 2, 4][: len(points)]
    field = IsotropicSolver(refined).solve(
        at_vertices(refined, refinement.vertices.tolist(), valences)
    )
    assert field.max_closing_error < 1e-9


@pytest.mark.parametrize("name", ["sphere", "plate", "torus_with_hole"])
def test_every_triangle_is_split_in_four_alike(name: str) -> None:
    surface = SURFACES[name]()
    refinement = refine_everywhere(surface)
    refined = refinement.surface
    TriSurface(refined.vertices, refined.faces)  # a valid surface
    assert (refined.vertices[: surface.n_vertices] == surface.vertices).all()
    assert refined.n_vertices == surface.n_vertices + len(surface.edges)
    assert (np.bincount(refinement.parent_face) == 4).all()
    assert np.allclose(refined.face_areas, surface.face_areas[refinement.parent_face] / 4)
    assert default_corners(refined) == default_corners(surface)
