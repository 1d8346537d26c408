"""Quad meshes: topology, irregular vertices and quality of known grids; broken meshes refused."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.errors import CrossviewError
from solvers.quads.corners import scaled_jacobian
from solvers.quads.projection import Projection
from solvers.quads.quadmesh import QuadMesh
from tests.solvers.quads.quad_grids import GRIDS, square
from tests.solvers.suite import SURFACES

IRREGULAR = {
    "annulus": ({}, {}, 0),
    "torus": ({}, {}, 0),
    "sphere": ({3: 8}, {}, 2),
    "square": ({}, {1: 4}, 1),
}


@pytest.mark.parametrize("name", GRIDS)
def test_grids_have_the_topology_of_their_surface(name: str) -> None:
    mesh = GRIDS[name]()
    mesh.check()
    irregular, corners, chi = IRREGULAR[name]
    assert (mesh.irregular, mesh.corners, mesh.euler_characteristic) == (irregular, corners, chi)
    # the index budget, in quarter turns
    inner = sum((4 - k) * count for k, count in mesh.irregular.items())
    assert inner + sum((2 - k) * count for k, count in mesh.corners.items()) == 4 * chi
    assert (mesh.on_boundary == (mesh.boundary_loop >= 0)).all()
    assert mesh.max_distance_to_surface < 1e-14


def test_the_scaled_jacobian_is_the_smallest_sine() -> None:
    angles = np.array([0.2, 1.0, 0.5 * np.pi, 2.5, np.pi, 4.0])
    sheared = np.array(
        [
            [[0, 0, 1], [3, 0, 1], [3 + np.cos(a), np.sin(a), 1], [np.cos(a), np.sin(a), 1]]
            for a in angles
        ]
    )
    up = np.array([0.0, 0, 1])
    assert scaled_jacobian(sheared, up) == pytest.approx(np.sin(angles), abs=1e-12)
    dart = np.array([[0.0, 0, 0], [1, 0, 0], [0.2, 0.2, 0], [0, 1, 0]])
    for folded in (dart, dart[::-1], dart[[0, 0, 1, 3]]):
        assert scaled_jacobian(folded, up) <= 0


def test_the_distance_is_that_to_the_nearest_point_wherever_the_vertex_is_said_to_lie() -> None:
    mesh = square()
    lifted = mesh.vertices + [0, 0, 0.01]
    lifted[7] += [0, 0, 0.02]
    assert replace(mesh, vertices=lifted).max_distance_to_surface == pytest.approx(0.03)
    wrong = replace(mesh, faces=np.zeros_like(mesh.faces))
    assert wrong.max_distance_to_surface < 1e-14


def broken(mesh: QuadMesh, how: str) -> QuadMesh:
    quads = mesh.quads.copy()
    if how == "a quad missing":
        inner = ~mesh.on_boundary[quads].any(axis=1)
        return replace(mesh, quads=np.delete(quads, np.flatnonzero(inner)[0], axis=0))
    if how == "an inverted quad":
        quads[0] = quads[0, ::-1]
    if how == "a quad twice":
        quads = np.concatenate([quads, quads[:1]])
    if how == "a vertex twice":
        quads[0, 1] = quads[0, 0]
    if how == "two vertices made one":
        numbers = np.flatnonzero(~mesh.on_boundary)
        quads[quads == numbers[-1]] = numbers[0]
    return replace(mesh, quads=quads)


@pytest.mark.parametrize("name", GRIDS)
@pytest.mark.parametrize(
    "how",
    [
        "a quad missing",
        "an inverted quad",
        "a quad twice",
        "a vertex twice",
        "two vertices made one",
    ],
)
def test_broken_meshes_are_refused_in_one_line(name: str, how: str) -> None:
    mesh = broken(GRIDS[name](), how)
    with pytest.raises(CrossviewError, match="quad mesh") as refusal:
        mesh.check()
    assert "\n" not in str(refusal.value)


def test_a_mesh_of_another_surface_is_refused() -> None:
    mesh = replace(GRIDS["square"](), surface=SURFACES["annulus"]())
    with pytest.raises(CrossviewError, match="another topology"):
        mesh.check()


@pytest.mark.parametrize("name", ["sphere", "torus", "annulus", "slivers"])
def test_the_nearest_points_of_many_places_are_those_of_each(name: str) -> None:
    surface = SURFACES[name]()
    places = np.random.default_rng(2).normal(size=(40, 3))
    projection = Projection(surface)
    found = projection.positions(*projection.nearest(places))
    alone = np.array([surface.position(surface.closest_point(x)) for x in places])
    gaps = np.linalg.norm(found - places, axis=1)
    assert gaps == pytest.approx(np.linalg.norm(alone - places, axis=1), abs=1e-14)


@pytest.mark.parametrize("name", ["sphere", "torus", "l_shape", "slivers"])
def test_sliding_finds_points_of_the_surface_again_from_farther_off(name: str) -> None:
    surface = SURFACES[name]()
    projection = Projection(surface)
    weights = np.random.default_rng(3).dirichlet([1, 1, 1], size=surface.n_faces)
    places = projection.positions(np.arange(surface.n_faces), weights)
    start = surface.edge_faces[surface.face_edges[:, 1]]
    beside = np.where(start[:, 0] == np.arange(surface.n_faces), start[:, 1], start[:, 0])
    inner = beside >= 0
    faces, weights = projection.slide(beside[inner], places[inner])
    assert projection.positions(faces, weights) == pytest.approx(places[inner], abs=1e-13)
