"""Built-in surfaces: topology, shape, symmetry and triangles as their names promise."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from solvers.errors import SurfaceError
from solvers.primitives import (
    BUILTIN,
    annulus,
    blob,
    cube_sphere,
    cylinder,
    disk,
    ellipsoid,
    genus,
    l_shape,
    planar,
    plate_with_holes,
    rectangle,
    sphere,
    square,
    torus,
    torus_with_hole,
)
from solvers.surface.trisurface import TriSurface

# Euler characteristic and boundary loops
TOPOLOGY = {
    "square": (1, 1),
    "rectangle": (1, 1),
    "disk": (1, 1),
    "annulus": (0, 2),
    "l_shape": (1, 1),
    "plate_with_holes": (-1, 3),
    "planar": (1, 1),
    "sphere": (2, 0),
    "cube_sphere": (2, 0),
    "ellipsoid": (2, 0),
    "blob": (2, 0),
    "cylinder": (0, 2),
    "torus": (0, 0),
    "torus_with_hole": (-1, 1),
    "genus": (-2, 0),
}


def volume(surface: TriSurface) -> float:
    return float(np.einsum("ij,ij->", surface.area_vectors, surface.barycentres)) / 3


def test_every_builtin_surface_is_listed_here() -> None:
    assert set(TOPOLOGY) == set(BUILTIN)


@pytest.mark.parametrize("name", BUILTIN)
def test_topology_and_triangles(name: str) -> None:
    surface = BUILTIN[name]()
    chi, loops = TOPOLOGY[name]
    assert surface.euler_characteristic == chi
    assert len(surface.boundary_loops) == loops
    assert surface.triangle_quality.min() > 0.65
    assert surface.triangle_quality.mean() > 0.85
    assert 900 < surface.n_vertices < 4000


@pytest.mark.parametrize("name", BUILTIN)
def test_the_same_call_gives_the_same_surface(name: str) -> None:
    first, second = BUILTIN[name](), BUILTIN[name]()
    assert np.array_equal(first.vertices, second.vertices)
    assert np.array_equal(first.faces, second.faces)


@pytest.mark.parametrize("make", [disk, annulus, l_shape, plate_with_holes, planar, square])
def test_planar_surfaces_look_up_and_are_delaunay(make: Callable[[], TriSurface]) -> None:
    surface = make()
    assert np.all(surface.face_normals[:, 2] == 1)
    assert surface.triangulation.weights.min() > -1e-12


@pytest.mark.parametrize(
    ("surface", "expected"),
    [
        (sphere(5), 4 / 3 * np.pi),
        (cube_sphere(40), 4 / 3 * np.pi),
        (ellipsoid(2, 1, 0.5, subdivisions=5), 4 / 3 * np.pi),
        (torus(1, 0.4, n=160), 2 * np.pi**2 * 0.4**2),
    ],
    ids=["sphere", "cube_sphere", "ellipsoid", "torus"],
)
def test_closed_surfaces_face_outwards_and_hold_their_volume(
    surface: TriSurface, expected: float
) -> None:
    assert volume(surface) == pytest.approx(expected, rel=0.005)


def test_blob_and_genus_face_outwards() -> None:
    assert volume(blob()) > 0
    assert volume(genus(3)) > 0


@pytest.mark.parametrize("handles", [1, 2, 5])
def test_genus_has_the_handles_asked_for(handles: int) -> None:
    assert genus(handles, subdivisions=1).genus == handles


def test_areas() -> None:
    assert square(8, size=2).area == pytest.approx(4)
    assert rectangle(3, 2, 6, 4).area == pytest.approx(6)
    assert l_shape(2, 0.1).area == pytest.approx(3)
    assert disk(2, 0.05).area == pytest.approx(4 * np.pi, rel=1e-3)
    assert annulus(0.5, 1, n=200).area == pytest.approx(0.75 * np.pi, rel=1e-3)
    assert cylinder(1, 3, n=200).area == pytest.approx(6 * np.pi, rel=1e-3)


def mapped(surface: TriSurface, rotation: Rotation) -> NDArray[np.int64]:
    """The number of the vertex that each vertex is turned to, at most 1e-12 away."""
    turned = surface.vertices @ rotation.as_matrix().T
    distance = np.linalg.norm(turned[:, None] - surface.vertices[None], axis=2)
    assert distance.min(axis=1).max() < 1e-12
    return np.asarray(distance.argmin(axis=1))


def assert_symmetric(surface: TriSurface, rotation: Rotation) -> None:
    """The turned surface has the same vertices and the same triangles."""

    def faces_as_set(faces: NDArray[np.int64]) -> set[tuple[int, ...]]:
        smallest = faces.argmin(axis=1)
        rolled = np.take_along_axis(faces, (smallest[:, None] + np.arange(3)) % 3, axis=1)
        return set(map(tuple, rolled.tolist()))

    turned = mapped(surface, rotation)[surface.faces]
    assert faces_as_set(turned) == faces_as_set(surface.faces)


@pytest.mark.parametrize("rotation", list(Rotation.create_group("O")))
def test_cube_sphere_has_the_cubes_symmetry(rotation: Rotation) -> None:
    assert_symmetric(cube_sphere(6), rotation)


def test_cube_sphere_has_the_cubes_corners() -> None:
    corners = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, 8).T / np.sqrt(3)
    surface = cube_sphere(10)
    distance = np.linalg.norm(corners[:, None] - surface.vertices[None], axis=2)
    assert distance.min(axis=1).max() < 1e-15
    assert np.linalg.norm(surface.vertices, axis=1) == pytest.approx(1, abs=1e-15)


@pytest.mark.parametrize(
    ("surface", "steps"),
    [(annulus(n=24), 24), (disk(edge_length=0.2), 6), (square(8), 4), (torus(n=24), 24)],
    ids=["annulus", "disk", "square", "torus"],
)
def test_rotation_symmetry(surface: TriSurface, steps: int) -> None:
    assert_symmetric(surface, Rotation.from_rotvec([0, 0, 2 * np.pi / steps]))


def test_annulus_vertices_lie_on_rings_and_fill_both_circles() -> None:
    radii = np.hypot(*annulus(0.4, 1, n=48).vertices[:, :2].T)
    ring = np.unique(radii.round(12))
    assert ring[0] == pytest.approx(0.4)
    assert ring[-1] == pytest.approx(1)
    assert np.diff(np.log(ring)) == pytest.approx(np.log(ring[1] / ring[0]))
    assert np.unique(np.sum(np.abs(radii[:, None] - ring) < 1e-11, axis=0)) == [48]


def test_torus_lies_on_the_torus() -> None:
    x, y, z = torus(2, 0.7).vertices.T
    assert (np.hypot(x, y) - 2) ** 2 + z**2 == pytest.approx(0.7**2)


def test_the_hole_of_a_torus_is_round_and_as_large_as_asked() -> None:
    surface = torus_with_hole(1, 0.4, n=120, hole=0.3)
    (rim,) = surface.boundary_loops
    middle = surface.vertices[rim].mean(axis=0)
    radii = np.linalg.norm(surface.vertices[rim] - middle, axis=1)
    assert radii == pytest.approx(0.3, rel=0.15)


def test_planar_keeps_every_corner_and_every_side() -> None:
    outer = np.array([[0, 0], [4, 0], [4, 3], [2, 1.2], [0, 3]])
    hole = np.array([[0.5, 0.5], [1.5, 0.5], [1, 1]])
    surface = planar(outer, [hole], 0.1)
    rim, inner = (surface.vertices[loop, :2] for loop in surface.boundary_loops)
    for corners, loop in ((outer, rim), (hole, inner)):
        assert np.linalg.norm(corners[:, None] - loop, axis=2).min(axis=1).max() == 0
        side = np.roll(corners, -1, axis=0) - corners
        perimeter = np.linalg.norm(side, axis=1).sum()
        assert np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1).sum() == pytest.approx(
            perimeter
        )
    hull_area = 4 * 3 - 0.5 * 4 * 1.8
    assert surface.area == pytest.approx(hull_area - 0.25)


def test_planar_takes_polygons_either_way_round_and_at_any_angle() -> None:
    turn = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    outer = np.array([[0, 0], [2, 0], [2, 1], [0, 1]]) @ turn.T
    assert planar(outer[::-1], (), 0.1).area == pytest.approx(2)
    assert planar(outer, (), 0.1).triangle_quality.min() > 0.6


@pytest.mark.parametrize(
    ("outer", "holes", "edge_length"),
    [
        ([[0, 0], [1, 1], [1, 0], [0, 1]], [], 0.1),
        ([[0, 0], [1, 0], [2, 0]], [], 0.1),
        ([[0, 0], [1, 0], [1, 0], [0, 1]], [], 0.1),
        ([[0, 0], [1, 0]], [], 0.1),
        ([[0, 0], [1, 0], [0, np.nan]], [], 0.1),
        ([[0, 0], [1, 0], [0, "a"]], [], 0.1),
        ([[0, 0], [1, 0], [1, 1], [0, 1]], [[[2, 2], [3, 2], [2, 3]]], 0.1),
        ([[0, 0], [1, 0], [1, 1], [0, 1]], [[[0.5, 0.5], [3, 0.5], [0.5, 0.6]]], 0.1),
        ([[0, 0], [1, 0], [1, 1], [0, 1]], [], 0),
        ([[0, 0], [1, 0], [1, 1], [0, 1]], [], 1e-6),
        ([[0, 0], [1, 0], [1, 1], [0, 1]], [[[0.5, 0.5], [0.6, 0.5], [0.6, -1e9]]], 0.1),
    ],
    ids=[
        "crossing itself",
        "flat",
        "repeated corner",
        "two corners",
        "not finite",
        "not numbers",
        "hole outside",
        "hole across the side",
        "no edge length",
        "too fine",
        "too fine along a hole",
    ],
)
def test_bad_polygons_are_refused(outer: Any, holes: Any, edge_length: float) -> None:
    with pytest.raises(SurfaceError):
        planar(outer, holes, edge_length)


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("sphere", {"subdivisions": -1}),
        ("sphere", {"subdivisions": 2.5}),
        ("sphere", {"subdivisions": 40}),
        ("sphere", {"radius": float("nan")}),
        ("cube_sphere", {"n": 7}),
        ("annulus", {"inner": 1.5}),
        ("annulus", {"n": 2}),
        ("torus", {"minor": 1.0}),
        ("torus_with_hole", {"hole": 5}),
        ("disk", {"radius": 0}),
        ("disk", {"edge_length": "fine"}),
        ("disk", {"edge_length": 1e-320}),
        ("planar", {"holes": 3}),
        ("planar", {"edge_length": 1e-200}),
        ("plate_with_holes", {"edge_length": 1e-320}),
        ("cylinder", {"radius": 1e-320}),
        ("genus", {"handles": 10**400}),
        ("square", {"n": 10**7}),
        ("plate_with_holes", {"radius": 2}),
        ("blob", {"waves": 3}),
        ("genus", {"handles": 0}),
    ],
)
def test_bad_parameters_are_refused_in_one_line(name: str, parameters: dict[str, Any]) -> None:
    with pytest.raises(SurfaceError) as caught:
        BUILTIN[name](**parameters)
    assert "\n" not in str(caught.value)
