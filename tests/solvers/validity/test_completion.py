"""The missing indices: where symmetry and closed forms say they belong."""

from collections.abc import Sequence

import numpy as np
import pytest

from solvers.errors import SingularityError
from solvers.fields.isotropic import IsotropicSolver
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import Singularity, index_budget
from solvers.surface.trisurface import TriSurface
from solvers.validity.completion import missing_singularities
from tests.solvers.suite import SURFACES, at_vertices


def completed(surface: TriSurface, start: Sequence[Singularity] = ()) -> np.ndarray:
    found = run(missing_singularities(IsotropicSolver(surface), start))
    return surface.positions([s.point for s in found])


@pytest.mark.parametrize("name", SURFACES)
def test_the_budget_is_met_and_the_field_exists(name: str) -> None:
    surface = SURFACES[name]()
    solver = IsotropicSolver(surface)
    start = at_vertices(surface, [int(np.flatnonzero(~surface.boundary_vertices)[40])], [5])
    found = run(missing_singularities(solver, start))
    everyone = (*start, *found)
    assert index_budget(surface, everyone, solver.corners).satisfied
    assert len({s.valence for s in found}) == 1
    solver.solve(everyone)


def test_the_first_on_a_disk_lies_where_the_energy_falls_most() -> None:
    """H = r^2 / 2 with the sum spread evenly, and log(1 - r) / 8 for the rim: r (1 - r) = 1 / 8."""
    surface = BUILTIN["disk"](edge_length=0.03)
    solver = IsotropicSolver(surface)
    assert solver.corners == {}
    radius = np.linalg.norm(completed(surface), axis=1)
    assert radius == pytest.approx(np.full(4, 0.85), abs=0.06)


def test_four_on_a_disk_form_a_square() -> None:
    x, y, _ = completed(BUILTIN["disk"](edge_length=0.05)).T
    gaps = np.diff(np.sort(np.degrees(np.arctan2(y, x))))
    assert gaps == pytest.approx(np.full(3, 90), abs=8)


def test_eight_on_a_sphere_are_far_apart() -> None:
    """The cube's are 70.5 degrees apart, the antiprism's 74.9."""
    x = completed(BUILTIN["sphere"](subdivisions=4))
    cosines = x @ x.T - 2 * np.eye(len(x))
    assert len(x) == 8
    assert np.degrees(np.arccos(cosines.max())) > 62


def test_one_that_is_missing_goes_opposite_to_the_others() -> None:
    surface = BUILTIN["sphere"](subdivisions=4)
    corners = np.array([[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]) / 3**0.5
    nearest = [int(np.argmin(np.linalg.norm(surface.vertices - x, axis=1))) for x in corners]
    (found,) = completed(surface, at_vertices(surface, nearest[:-1], [3] * 7))
    assert np.degrees(np.arccos(found @ corners[-1])) < 6


def test_too_many_are_refused() -> None:
    surface = BUILTIN["genus"](handles=18, subdivisions=1)
    with pytest.raises(SingularityError, match="136 singularities are missing"):
        run(missing_singularities(IsotropicSolver(surface), ()))


def test_no_two_are_placed_at_one_vertex() -> None:
    """A tetrahedron has four vertices, and a cube's eight are just enough."""
    corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    tetrahedron = TriSurface(corners, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    for start in ([], at_vertices(tetrahedron, [0, 1], [3, 3])):
        with pytest.raises(SingularityError, match="there is no room for all the singularities"):
            completed(tetrahedron, start)
    cube = BUILTIN["cube_sphere"](n=2)
    assert len(np.unique(completed(cube), axis=0)) == 8


def test_none_is_placed_on_the_boundary_for_want_of_vertices_inside() -> None:
    hexagon = [[np.cos(a), np.sin(a), 0] for a in np.pi / 3 * np.arange(6)]
    surface = TriSurface(hexagon, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])
    with pytest.raises(SingularityError, match="there is no room"):
        completed(surface)
