"""Corners by interior angle, and the index budget in plain words."""

import numpy as np
import pytest

from solvers.primitives import BUILTIN
from solvers.singularities.budget import default_corners, index_budget
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import SURFACES, at_vertices


def test_corners_of_an_l_shape() -> None:
    corners = default_corners(BUILTIN["l_shape"](edge_length=0.2))
    assert sorted(corners.values()) == [-1, 1, 1, 1, 1, 1]


def test_the_two_sides_of_a_slit_end_in_a_corner_of_index_minus_two() -> None:
    """A fan of eight triangles around a vertex, closed up to a slit."""
    angles = np.linspace(0, 2 * np.pi, 9)
    rim = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    vertices = np.vstack([[0, 0, 0], rim])
    faces = [[0, i, i + 1] for i in range(1, 9)]
    assert default_corners(TriSurface(vertices, faces))[0] == -2


@pytest.mark.parametrize("turn", [0.0, 0.1, 0.3, 1.0])
def test_angles_halfway_between_two_corners_are_judged_alike(turn: float) -> None:
    """All of a regular octagon's 135 degrees are straight, however rounding falls."""
    angles = turn + 2 * np.pi * np.arange(8) / 8
    octagon = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    faces = [[8, i, (i + 1) % 8] for i in range(8)]
    assert default_corners(TriSurface(np.vstack([octagon, [0, 0, 0]]), faces)) == {}


@pytest.mark.parametrize(
    ("degrees", "index"), [(5, 1), (90, 1), (134, 1), (136, 0), (224, 0), (226, -1), (314, -1)]
)
def test_the_index_of_a_corner_is_that_of_the_nearest_number_of_quads(
    degrees: float, index: int
) -> None:
    angles = np.radians(degrees) * np.arange(9) / 8
    rim = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    faces = [[0, i, i + 1] for i in range(1, 9)]
    corners = default_corners(TriSurface(np.vstack([[0, 0, 0], rim]), faces))
    assert corners.get(0, 0) == index


@pytest.mark.parametrize(
    ("name", "valences", "message"),
    [
        ("sphere", [3] * 8, "index 8 of 8"),
        ("sphere", [3] * 7, "index 7 of 8: add one valence 3"),
        ("disk", [3, 3], "index 2 of 4: add 2 valence 3 or make #2 a valence 1"),
        ("annulus", [3], "index 1 of 0: add one valence 5 or remove #1"),
        ("torus", [3, 3, 5], "index 1 of 0: add one valence 5 or make #3 a valence 6"),
        ("double_torus", [8], "index -4 of -8: add 4 valence 5 or add one valence 8"),
        ("square", [], "index 4 of 4"),
    ],
)
def test_the_budget_says_what_is_missing(name: str, valences: list[int], message: str) -> None:
    surface = SURFACES[name]()
    inner = np.flatnonzero(~surface.boundary_vertices)[: len(valences)]
    singularities = at_vertices(surface, inner.tolist(), valences)
    budget = index_budget(surface, singularities, default_corners(surface))
    assert budget.message.startswith(message)
    assert budget.satisfied == (budget.missing == 0)
