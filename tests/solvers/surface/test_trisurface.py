"""The surface: Gauss-Bonnet, topology, places, and every bad input refused with its elements."""

from typing import Any

import numpy as np
import pytest

from solvers.errors import SurfaceError
from solvers.fields.isotropic import IsotropicSolver
from solvers.primitives import BUILTIN
from solvers.surface.trisurface import TriSurface
from solvers.surface.validation import problems
from tests.solvers.suite import SURFACES

# genus and number of boundary loops
TOPOLOGY = {
    "sphere": (0, 0),
    "disk": (0, 1),
    "square": (0, 1),
    "l_shape": (0, 1),
    "annulus": (0, 2),
    "plate": (0, 4),
    "cylinder": (0, 2),
    "torus": (1, 0),
    "torus_with_hole": (1, 1),
    "double_torus": (2, 0),
    "slivers": (0, 2),
}


@pytest.mark.parametrize("name", SURFACES)
def test_topology_and_gauss_bonnet(name: str) -> None:
    surface = SURFACES[name]()
    genus, loops = TOPOLOGY[name]
    assert (surface.genus, len(surface.boundary_loops)) == (genus, loops)
    assert surface.euler_characteristic == 2 - 2 * genus - loops
    total = 2 * np.pi * surface.euler_characteristic
    assert surface.angle_defects.sum() == pytest.approx(total, abs=1e-9)


@pytest.mark.parametrize("name", SURFACES)
def test_edges_know_their_faces_and_faces_their_edges(name: str) -> None:
    surface = SURFACES[name]()
    for i in range(3):
        ends = surface.edges[surface.face_edges[:, i]]
        corners = surface.faces[:, [i, (i + 1) % 3]]
        assert (np.sort(ends, axis=1) == np.sort(corners, axis=1)).all()
        beside = surface.edge_faces[surface.face_edges[:, i]]
        assert (beside == np.arange(surface.n_faces)[:, None]).any(axis=1).all()
    assert ((surface.edge_faces[:, 1] < 0).sum()) == sum(map(len, surface.boundary_loops))


def test_boundary_loops_keep_the_surface_on_the_left() -> None:
    surface = BUILTIN["annulus"](n=24)
    outer, inner = (surface.vertices[loop] for loop in surface.boundary_loops)
    assert np.linalg.norm(outer, axis=1) == pytest.approx(1.0)
    for loop, sense in ((outer, 1), (inner, -1)):
        following = np.roll(loop, -1, axis=0)
        turning = loop[:, 0] * following[:, 1] - loop[:, 1] * following[:, 0]
        assert (sense * turning > 0).all()


@pytest.mark.parametrize("name", ["sphere", "annulus", "torus"])
def test_the_closest_point_is_no_farther_than_any_sample(name: str) -> None:
    surface = SURFACES[name]()
    rng = np.random.default_rng(1)
    weights = rng.dirichlet([1, 1, 1], size=surface.n_faces)
    samples = np.einsum("ki,kij->kj", weights, surface.vertices[surface.faces])
    for place in rng.normal(size=(20, 3)):
        found = surface.position(surface.closest_point(place))
        nearest = np.linalg.norm(samples - place, axis=1).min()
        nearest = min(nearest, np.linalg.norm(surface.vertices - place, axis=1).min())
        assert np.linalg.norm(found - place) <= nearest + 1e-12
    for face in rng.integers(surface.n_faces, size=20):
        point = surface.closest_point(samples[face])
        assert np.linalg.norm(surface.position(point) - samples[face]) < 1e-12


def test_arrays_are_frozen_copies() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    surface = TriSurface(vertices, [[0, 1, 2]])
    vertices[0] = 7.0
    assert surface.vertices[0, 0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        surface.vertices[0] = 1.0


SQUARE = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
HALVES = [[0, 1, 2], [0, 2, 3]]
TENT = [[0.0, 0, 0], [1, 0, 0], [0.5, 1, 0], [0.5, -1, 0], [0.5, 0, 1]]

BAD: dict[str, tuple[Any, Any, str, list[Any]]] = {
    "empty": (SQUARE, np.zeros((0, 3)), "the surface is empty", []),
    "not finite": ([*SQUARE[:3], [0, np.nan, 0]], HALVES, "not finite", [3]),
    "index too large": (SQUARE, [[0, 1, 2], [0, 2, 9]], r"outside 0\.\.3", [1]),
    "negative index": (SQUARE, [[0, 1, 2], [0, 2, -1]], r"outside 0\.\.3", [1]),
    "degenerate": ([*SQUARE, [2, 0, 0]], [*HALVES, [1, 0, 4]], "1 degenerate", [2]),
    "nearly flat": ([*SQUARE, [1.7, 3e-8, 0]], [*HALVES, [1, 0, 4]], "1 degenerate", [2]),
    "repeated corner": (SQUARE, [*HALVES, [1, 1, 2]], "1 degenerate", [2]),
    "duplicate": (SQUARE, [*HALVES, [1, 2, 0]], "1 duplicate", [2]),
    "unreferenced": ([*SQUARE, [5, 5, 5]], HALVES, "of no triangle", [4]),
    "crowded edge": (TENT, [[0, 1, 2], [1, 0, 3], [0, 1, 4]], "non-manifold edge", [[0, 1]]),
    "orientation": (SQUARE, [[0, 1, 2], [0, 3, 2]], "oriented against", [[0, 2]]),
    "bow tie": (
        [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]],
        [[0, 1, 2], [0, 3, 4]],
        "1 non-manifold vert",
        [0],
    ),
    "two pieces": (
        [*SQUARE[:3], [9, 0, 0], [10, 0, 0], [9, 1, 0]],
        [[0, 1, 2], [3, 4, 5]],
        "2 separate components",
        [],
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_surfaces_are_refused_by_name_and_element(case: str) -> None:
    vertices, faces, message, elements = BAD[case]
    with pytest.raises(SurfaceError, match=message) as refusal:
        TriSurface(vertices, np.asarray(faces, dtype=np.int64).reshape(-1, 3))
    assert refusal.value.elements.tolist() == elements
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("gap", [1e-3, 1e-5, 3e-7])
@pytest.mark.parametrize("place", [0.0, 1e-3, 0.5])
def test_slivers_that_are_accepted_are_solved_on(gap: float, place: float) -> None:
    """A vertex next to the diagonal of a square, and next to its end or not."""
    vertices = np.array([*SQUARE, [place + gap, place + 3 * gap, 0]])
    surface = TriSurface(vertices, [[0, 1, 2], [0, 2, 4], [0, 4, 3], [4, 2, 3]])
    field = IsotropicSolver(surface).solve([])
    assert np.ptp(field.H) < 1e-7
    assert field.max_closing_error < 1e-7


def test_every_problem_is_listed_at_once() -> None:
    vertices = np.array([*SQUARE, [5, 5, 5]])
    faces = np.array([*HALVES, [1, 2, 0], [3, 3, 2]])
    told = " ".join(str(problem) for problem in problems(vertices, faces))
    for part in ("degenerate", "duplicate", "of no triangle"):
        assert part in told


def test_nobody_writes_to_what_a_surface_is_made_of_or_keeps() -> None:
    surface = BUILTIN["annulus"](n=12)
    kept = [surface.boundary_loops[0], *surface.face_frames]
    for value in (surface, surface.triangulation):
        names = [name for name in dir(type(value)) if not name.startswith("_")]
        kept += [a for name in names if isinstance(a := getattr(value, name), np.ndarray)]
    kept += [surface.triangulation.lengths, surface.triangulation.twin]
    assert len(kept) > 25
    for array in kept:
        with pytest.raises(ValueError, match="read-only"):
            array[:] = 0
