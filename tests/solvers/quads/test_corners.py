"""The corners of quads in the tangent planes of their surface, on both sides of creases."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from solvers.primitives import BUILTIN
from solvers.quads.corners import TangentPlanes, corner_sines, scaled_jacobian
from solvers.quads.projection import Projection
from solvers.quads.smoothing import smooth
from solvers.surface.trisurface import TriSurface
from tests.solvers.quads.quad_grids import GRIDS, on_surface


def roof(angle: float) -> TriSurface:
    """Two squares of side 1 that meet along the y axis, the second bent down by an angle."""
    down = np.array([np.cos(angle), 0, -np.sin(angle)])
    flat = np.array([[-1.0, 0, 0], [0, 0, 0], [0, 1, 0], [-1, 1, 0]])
    corners = np.concatenate([flat, [down, down + [0, 1, 0]]])
    return TriSurface(corners, [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])


@pytest.mark.parametrize("angle", np.radians([40, 90, 150]))
def test_a_place_on_a_crease_has_the_normal_of_the_side_a_vector_points_to(angle: float) -> None:
    surface = roof(angle)
    down = np.array([np.cos(angle), 0, -np.sin(angle)])
    normals = {-1: np.array([0.0, 0, 1]), 1: np.array([np.sin(angle), 0, np.cos(angle)])}
    places = np.array([[0, 0.3, 0], [0, 0, 0], [0, 1, 0]])  # on the crease, and at its ends
    faces, weights = Projection(surface).nearest(places)
    planes = TangentPlanes(surface)
    for side, way in ((-1, np.array([-1.0, 0.1, 0])), (1, down + [0, 0.1, 0])):
        found = planes.normals(faces, weights, np.tile(way, (3, 1)))
        assert found == pytest.approx(np.tile(normals[side], (3, 1)), abs=1e-12)


def test_a_smooth_surface_has_one_normal_everywhere() -> None:
    surface = BUILTIN["sphere"](subdivisions=4)
    rng = np.random.default_rng(0)
    faces, weights = rng.integers(surface.n_faces, size=50), rng.dirichlet([1, 1, 1], 50)
    found = TangentPlanes(surface).normals(faces, weights, rng.normal(size=(50, 3)))
    places = (weights[:, :, None] * surface.vertices[surface.faces[faces]]).sum(axis=1)
    assert np.abs(found - places / np.linalg.norm(places, axis=1)[:, None]).max() < 0.01


def test_a_right_angle_measures_one_on_each_side_and_less_out_of_the_plane() -> None:
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    for tilt in (0.0, 0.3, 1.2):
        normal = np.array([np.sin(tilt), 0, np.cos(tilt)])
        assert corner_sines(square, np.tile(normal, (4, 1))) == pytest.approx(np.cos(tilt))
    assert scaled_jacobian(square[::-1], np.tile([0.0, 0, 1], (4, 1))) == pytest.approx(-1)


def test_a_side_without_length_is_the_worst_there_is() -> None:
    triangle = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 0]])
    assert scaled_jacobian(triangle, np.tile([0.0, 0, 1], (4, 1))) == -1


@pytest.mark.parametrize("name", GRIDS)
def test_turning_and_scaling_change_nothing(name: str) -> None:
    mesh = GRIDS[name](noise=0.2)
    turn = Rotation.from_rotvec([0.4, -1.0, 0.7])
    surface = TriSurface(3 * turn.apply(mesh.surface.vertices.copy()), mesh.surface.faces)
    fixed = np.flatnonzero(mesh.fixed).tolist()
    there = on_surface(surface, 3 * turn.apply(mesh.vertices.copy()), mesh.quads, fixed)
    assert there.scaled_jacobian == pytest.approx(mesh.scaled_jacobian, abs=1e-9)
    before, after = smooth(mesh).scaled_jacobian, smooth(there).scaled_jacobian
    assert after == pytest.approx(before, abs=1e-5)
