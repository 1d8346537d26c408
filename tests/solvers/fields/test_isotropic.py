"""The isotropic solver against identities, closed forms and its own invariances."""

from collections.abc import Callable
from itertools import permutations, product

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from solvers.algebra.operators import midpoint_offsets, stiffness
from solvers.errors import SingularityError
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.least_squares import least_squares_theta
from solvers.primitives import BUILTIN
from solvers.singularities.budget import Singularity
from solvers.surface.homology import DualTree
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import wrap
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import SURFACES, at_vertices, random_configuration

QUARTER = np.pi / 2


@pytest.fixture(params=SURFACES)
def surface(request: pytest.FixtureRequest) -> TriSurface:
    return SURFACES[request.param]()


def test_every_edge_closes_and_the_reference_boundary_is_aligned(surface: TriSurface) -> None:
    solver = IsotropicSolver(surface)
    for seed in range(3):
        field = solver.solve(random_configuration(surface, seed))
        assert field.max_closing_error < 1e-9
        assert field.residual < 1e-12
        assert len(field.defects) == 2 * surface.genus + max(len(surface.boundary_loops) - 1, 0)
        if surface.boundary_loops:
            assert abs(field.boundary_misalignment[0]) < 1e-9


def test_the_walk_solves_the_least_squares_problem_of_the_paper(surface: TriSurface) -> None:
    solver = IsotropicSolver(surface)
    configuration = random_configuration(surface, seed=7)
    field = solver.solve(configuration)
    vertices = [
        surface.faces[s.point.face, int(np.argmax(s.point.barycentric))] for s in configuration
    ]
    h = field.solved.H
    walked = solver.discretization.walk(midpoint_offsets(solver.discretization.triangulation, h))
    solved = least_squares_theta(solver.discretization, h, np.array(vertices))
    assert np.abs(solved - walked).max() < 1e-9


@pytest.mark.parametrize("valence", [1, 2, 3, 4, 5, 6, 8, 12])
def test_any_valence_has_its_index_in_the_crosses(valence: int) -> None:
    surface = BUILTIN["disk"](edge_length=0.06)
    index = 4 - valence
    centre = int(np.argmin(np.linalg.norm(surface.vertices, axis=1)))
    rest = 4 - index
    angles = 2 * np.pi * np.arange(abs(rest)) / max(abs(rest), 1)
    ring = [surface.closest_point([0.7 * np.cos(a), 0.7 * np.sin(a), 0]) for a in angles]
    others = [Singularity(p, 3 if rest > 0 else 5) for p in ring]
    field = IsotropicSolver(surface).solve(
        [Singularity(surface.point_at_vertex(centre), valence), *others]
    )
    # Walk around the centre on a circle through the triangles at radius 0.4, in the plane.
    phi = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    circle = 0.4 * np.stack([np.cos(phi), np.sin(phi), 0 * phi], axis=1)
    nearest = np.argmin(np.linalg.norm(surface.barycentres[:, None] - circle[None], axis=2), axis=0)
    angle = np.arctan2(field.u[nearest, 1], field.u[nearest, 0])
    turns = wrap(np.roll(angle, -1) - angle, QUARTER).sum() / QUARTER
    assert round(turns, 6) == index


def exact_disk(x: np.ndarray, places: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """H on the unit disk: the Neumann function of each singularity and its mirror image."""
    z, w = x[:, 0] + 1j * x[:, 1], places[:, 0] + 1j * places[:, 1]
    with np.errstate(divide="ignore"):
        parts = np.log(np.abs(z[:, None] - w)) + np.log(np.abs(1 - z[:, None] * w.conj()))
    return np.asarray(parts @ indices / 4)


def exact_sphere(x: np.ndarray, places: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """H on the unit sphere: the logarithm of the chord to each singularity."""
    with np.errstate(divide="ignore"):
        chord = np.log(np.linalg.norm(x[:, None] - places[None], axis=2))
    return np.asarray(chord @ indices / 4)


Exact = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]


def errors_away_from_singularities(
    surfaces: list[TriSurface], targets: np.ndarray, valences: list[int], exact: Exact
) -> tuple[list[float], list[float]]:
    lengths, errors = [], []
    for surface in surfaces:
        vertices = [
            int(np.argmin(np.linalg.norm(surface.vertices - target, axis=1))) for target in targets
        ]
        field = IsotropicSolver(surface).solve(at_vertices(surface, vertices, valences))
        places = surface.vertices[vertices]
        away = np.linalg.norm(surface.vertices[:, None] - places[None], axis=2).min(axis=1) > 0.25
        difference = field.H - exact(surface.vertices, places, 4.0 - np.array(valences))
        weight = np.bincount(
            surface.faces.reshape(-1), np.repeat(surface.face_areas / 3, 3), surface.n_vertices
        )[away]
        difference = difference[away] - np.average(difference[away], weights=weight)
        errors.append(float(np.sqrt(np.average(difference**2, weights=weight))))
        lengths.append(float(surface.triangulation.lengths.mean()))
    return lengths, errors


def observed_order(lengths: list[float], errors: list[float]) -> float:
    return float(np.polyfit(np.log(lengths), np.log(errors), 1)[0])


def test_H_converges_at_order_two_on_the_disk() -> None:
    surfaces = [BUILTIN["disk"](edge_length=e) for e in (0.16, 0.08, 0.04, 0.02)]
    targets = np.array([[0.4, 0.1, 0], [-0.3, 0.4, 0], [-0.4, -0.4, 0], [0.2, -0.5, 0], [0, 0, 0]])
    order = observed_order(
        *errors_away_from_singularities(surfaces, targets, [3, 2, 3, 3, 5], exact_disk)
    )
    assert 1.7 < order < 2.4


def test_H_converges_at_order_two_on_the_sphere() -> None:
    surfaces = [BUILTIN["sphere"](subdivisions=s) for s in (2, 3, 4, 5)]
    targets = np.random.default_rng(3).normal(size=(6, 3))
    targets /= np.linalg.norm(targets, axis=1)[:, None]
    order = observed_order(
        *errors_away_from_singularities(surfaces, targets, [3, 3, 1, 5, 2, 2], exact_sphere)
    )
    assert 1.7 < order < 2.4


def test_crosses_on_the_disk_converge_to_the_closed_form() -> None:
    """The exact cross angle is the argument where H is the modulus."""
    errors = []
    for edge_length in (0.08, 0.04, 0.02):
        surface = BUILTIN["disk"](edge_length=edge_length)
        targets = np.array([[0.5, 0, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]])
        vertices = [int(np.argmin(np.linalg.norm(surface.vertices - x, axis=1))) for x in targets]
        field = IsotropicSolver(surface).solve(at_vertices(surface, vertices, [3] * 4))
        places = surface.vertices[vertices]
        z = surface.barycentres @ [1, 1j, 0]
        w = places @ [1, 1j, 0]
        angle = np.angle(z[:, None] - w).sum(axis=1) + np.angle(1 - z[:, None] * w.conj()).sum(
            axis=1
        )
        found = np.arctan2(field.u[:, 1], field.u[:, 0])
        gap = np.linalg.norm(surface.barycentres[:, None] - places, axis=2).min(axis=1)
        difference = np.exp(4j * (found - angle / 4))
        difference = difference[gap > 0.25] / np.exp(1j * np.angle(difference[gap > 0.25].mean()))
        errors.append(np.abs(np.angle(difference)).max() / 4)
    assert errors[2] < 0.01
    assert errors[0] / errors[2] > 3


def test_a_square_has_straight_crosses_and_equal_sizes() -> None:
    surface = BUILTIN["square"](n=10)
    field = IsotropicSolver(surface).solve([])
    assert np.abs(field.H).max() < 1e-12
    assert np.abs(wrap(np.arctan2(field.u[:, 1], field.u[:, 0]), QUARTER)).max() < 1e-12


def test_the_cube_on_the_sphere_has_the_symmetry_of_the_cube() -> None:
    surface = BUILTIN["cube_sphere"](n=8)
    corners = np.array(list(product((-1, 1), repeat=3))) / np.sqrt(3)
    field = IsotropicSolver(surface).solve(
        [Singularity(surface.closest_point(x), 3) for x in corners]
    )
    for axes in permutations(range(3)):
        for signs in product((-1, 1), repeat=3):
            turned = np.zeros((3, 3))
            turned[range(3), axes] = signs
            if np.linalg.det(turned) < 0:
                continue
            images = surface.vertices @ turned.T
            gap, image = _nearest(surface.vertices, images)
            assert gap < 1e-9
            assert np.abs(field.H[image] - field.H).max() < 1e-9


def _nearest(points: np.ndarray, images: np.ndarray) -> tuple[float, np.ndarray]:
    distance = np.linalg.norm(points[None] - images[:, None], axis=2)
    return float(distance.min(axis=1).max()), distance.argmin(axis=1)


@pytest.mark.parametrize("name", ["disk", "annulus", "torus", "double_torus"])
def test_the_field_does_not_depend_on_numbering_place_or_size(name: str) -> None:
    surface = SURFACES[name]()
    configuration = random_configuration(surface, seed=2)
    field = IsotropicSolver(surface).solve(configuration)
    rng = np.random.default_rng(0)
    order, rows = rng.permutation(surface.n_vertices), rng.permutation(surface.n_faces)
    spin = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    spin *= np.linalg.det(spin)
    number = np.argsort(order)  # new number of each old vertex
    other = TriSurface(
        3.0 * surface.vertices[order] @ spin.T + [5, -2, 1],
        np.roll(number[surface.faces][rows], 1, axis=1),
    )
    vertices = [
        number[surface.faces[s.point.face, int(np.argmax(s.point.barycentric))]]
        for s in configuration
    ]
    again = IsotropicSolver(other).solve(
        at_vertices(other, vertices, [s.valence for s in configuration])
    )
    assert np.abs(again.H[number] - field.H).max() < 1e-9
    if surface.boundary_loops:
        # The reference makes the crosses unique.
        same = np.einsum("ij,ij->i", again.u @ spin, field.u[rows])
        across = np.einsum("ij,ij->i", again.u @ spin, field.v[rows])
        assert np.abs(wrap(np.arctan2(across, same), QUARTER)).max() < 1e-8
    if surface.genus == 0:
        assert (
            np.abs(wrap(np.abs(again.defects) - np.abs(field.defects), QUARTER)).max(initial=0)
            < 1e-9
        )


def test_a_singularity_inside_a_triangle_equals_one_inserted_there() -> None:
    surface = BUILTIN["disk"](edge_length=0.15)
    solver = IsotropicSolver(surface)
    fixed = at_vertices(surface, _spread(surface, 3), [3, 3, 3])
    face = int(np.argmin(np.linalg.norm(surface.barycentres - [0.1, 0.05, 0], axis=1)))
    inner = SurfacePoint(face, (0.5, 0.3, 0.2))
    field = solver.solve([*fixed, Singularity(inner, 3)])
    a, b, c = surface.faces[face]
    new = surface.n_vertices
    faces = np.concatenate(
        [np.delete(surface.faces, face, axis=0), [[a, b, new], [b, c, new], [c, a, new]]]
    )
    split = TriSurface(np.vstack([surface.vertices, surface.position(inner)]), faces)
    points = [split.closest_point(surface.position(s.point)) for s in fixed]
    t = split.triangulation
    right = t.curvatures.copy()
    for point in points:
        right[split.faces[point.face, int(np.argmax(point.barycentric))]] -= QUARTER
    right[new] -= QUARTER
    reference = np.append(0.0, spsolve(stiffness(t)[1:, 1:], right[1:]))
    assert np.ptp(field.H - reference[:new]) < 1e-12
    # theta walked over the split triangulation itself, the three parts of the triangle included.
    offset = midpoint_offsets(t, reference).reshape(-1)
    tree = DualTree(t, 0, np.zeros((1, len(t.twin)), dtype=bool))
    steps = t.transport[tree.crossing] + offset[tree.crossing] - offset[t.twin[tree.crossing]]
    theta = tree.accumulate(0.0, steps)
    kept = np.delete(np.arange(surface.n_faces), face)
    difference = wrap(field.theta[kept] - theta[:-3], QUARTER)
    assert np.abs(wrap(difference - difference[0], QUARTER)).max() < 1e-9
    assert field.max_closing_error < 1e-9


def _spread(surface: TriSurface, count: int) -> list[int]:
    angles = 2 * np.pi * np.arange(count) / count + 0.3
    targets = 0.6 * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    return [int(np.argmin(np.linalg.norm(surface.vertices - x, axis=1))) for x in targets]


def test_the_field_follows_a_dragged_singularity_without_a_jump() -> None:
    """Over an edge from one triangle into the next, H changes no more than by the clearance."""
    surface = BUILTIN["disk"](edge_length=0.15)
    solver = IsotropicSolver(surface)
    fixed = at_vertices(surface, _spread(surface, 3), [3, 3, 3])
    face = int(np.argmin(np.linalg.norm(surface.barycentres, axis=1)))
    h = int(surface.triangulation.twin[3 * face])
    other = [0.5 - 5e-10, 0.5 - 5e-10, 0.5 - 5e-10]
    other[(h % 3 + 2) % 3] = 1e-9
    here = solver.solve([*fixed, Singularity(SurfacePoint(face, (0.5, 0.5 - 1e-9, 1e-9)), 3)])
    there = solver.solve(
        [*fixed, Singularity(SurfacePoint(h // 3, (other[0], other[1], other[2])), 3)]
    )
    assert np.abs(here.H - there.H).max() < 1e-5


@pytest.mark.parametrize("gap", [0.0, 1e-12, 1e-9, 1e-6, 3e-6, 1e-4])
def test_a_dragged_singularity_closes_next_to_edges_and_vertices(gap: float) -> None:
    surface = BUILTIN["torus"](n=12)
    solver = IsotropicSolver(surface)
    for points in (
        (SurfacePoint(20, (gap, 0.3, 0.7 - gap)), SurfacePoint(81, (0.8, 0.2 - gap, gap))),
        (SurfacePoint(20, (1 - 3 * gap, gap, 2 * gap)), SurfacePoint(81, (gap, gap, 1 - 2 * gap))),
    ):
        pair = [Singularity(p, v) for p, v in zip(points, (2, 6), strict=True)]
        field = solver.solve(pair)
        assert field.max_closing_error < 1e-9
        assert np.abs(wrap(solver.holonomy.defects(pair) - field.defects, QUARTER)).max() < 1e-9


def test_singularities_that_have_no_field_are_refused_in_one_line() -> None:
    surface = BUILTIN["disk"](edge_length=0.2)
    solver = IsotropicSolver(surface)
    inner = np.flatnonzero(~surface.boundary_vertices)[:4]
    with pytest.raises(SingularityError, match=r"index budget, 3 of 4: add one valence 3"):
        solver.solve(at_vertices(surface, inner[:3].tolist(), [3, 3, 3]))
    rim = int(surface.boundary_loops[0][0])
    with pytest.raises(SingularityError, match="singularity 4 lies on the boundary"):
        solver.solve(at_vertices(surface, [*inner[:3].tolist(), rim], [3] * 4))
    t = surface.triangulation
    h = int(t.boundary_halfedges[0])
    weights = [0.5, 0.5, 0.5]
    weights[(h % 3 + 2) % 3] = 0.0
    on_edge = Singularity(SurfacePoint(h // 3, (weights[0], weights[1], weights[2])), 3)
    with pytest.raises(SingularityError, match="singularity 4 lies on the boundary"):
        solver.solve([*at_vertices(surface, inner[:3].tolist(), [3] * 3), on_edge])
    with pytest.raises(SingularityError, match="singularities 1 and 2 lie in the same vertex"):
        solver.solve(at_vertices(surface, [inner[0], inner[0], inner[1], inner[2]], [3] * 4))
