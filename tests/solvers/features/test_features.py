"""Feature networks, and fields that follow them."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from crossview.cases.model import Case
from crossview.workflow.problem import Problem
from solvers.features.dihedral import sharp_edges
from solvers.features.edges import Features, no_features
from solvers.features.strays import without_spurs
from solvers.fields.aligned import IntegratedField, aligned_field
from solvers.fields.crossfield import CrossField
from solvers.fields.feature_integers import nearest_integers
from solvers.fields.integrable import anisotropic_field
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.natural import natural_singularities
from solvers.fields.prepared import prepare
from solvers.maps.seamless import seamless_map
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import Singularity, default_corners
from solvers.surface.edge_paths import EdgePaths
from solvers.surface.refinement import refine_at, refine_everywhere
from solvers.surface.triangulation import wrap
from solvers.surface.trisurface import TriSurface
from tests.real_surfaces import PATHS, REAL
from tests.solvers.suite import at_vertices


def cube(n: int = 8) -> TriSurface:
    """The surface of a cube with n by n cells on each side."""
    sphere = BUILTIN["cube_sphere"](n=n)
    reach = np.abs(sphere.vertices).max(axis=1)
    return TriSurface(sphere.vertices / reach[:, None], sphere.faces)


def turned(surface: TriSurface) -> TriSurface:
    """The same, turned in space."""
    axes = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    return TriSurface(surface.vertices @ (axes * np.linalg.det(axes)), surface.faces)


def circle(surface: TriSurface, height: float) -> Features:
    """The edges of a cylinder or torus at a height."""
    at = np.abs(surface.vertices[:, 2] - height) < 1e-9
    return no_features(surface).united(np.flatnonzero(at[surface.edges].all(axis=1)))


def length(features: Features) -> float:
    ends = features.surface.vertices[features.ends]
    return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())


def misalignment(field: CrossField) -> float:
    """The largest of any feature curve, degrees."""
    return float(np.degrees(np.abs(field.feature_misalignment).max(initial=0.0)))


def solved(
    surface: TriSurface, features: Features, singularities: Sequence[Singularity], refine: int = 2
) -> tuple[IntegratedField, IntegratedField]:
    """The aligned and the anisotropic field, refined at the singularities."""
    aligned = aligned_field(prepare(surface, singularities, refine=refine, features=features))
    return IntegratedField(aligned, aligned.start), run(anisotropic_field(aligned))


def test_a_cube_has_twelve_sharp_curves_between_eight_corners() -> None:
    surface = cube()
    features = Features(surface, sharp_edges(surface, 40))
    assert len(features.curves) == 12
    assert not any(curve.closed for curve in features.curves)
    assert sorted(np.abs(surface.vertices[features.corners]).sum(axis=1)) == pytest.approx([3] * 8)
    assert length(features) == pytest.approx(24)
    for curve in features.curves:
        along = np.sort(np.stack([curve.vertices[:-1], curve.vertices[1:]], axis=1), axis=1)
        assert (along == np.sort(features.ends[curve.members], axis=1)).all()


def test_the_threshold_is_the_angle_between_normals() -> None:
    surface = cube()
    assert len(sharp_edges(surface, 89.9)) == 12 * 8
    assert len(sharp_edges(surface, 90.1)) == 0


def test_a_circle_is_one_closed_curve() -> None:
    surface = BUILTIN["cylinder"](n=32)
    (curve,) = circle(surface, 0.0).curves
    assert curve.closed
    assert len(curve.members) == 32


def test_a_square_drawn_on_a_plane_turns_at_its_corners() -> None:
    surface = BUILTIN["square"](n=8)
    middle = surface.vertices.mean(axis=0)
    vertex = [
        int(np.argmin(np.linalg.norm(surface.vertices - middle - [x / 4, y / 4, 0], axis=1)))
        for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    drawn = EdgePaths(surface).through(np.array([*vertex, vertex[0]]))
    features = no_features(surface).united(drawn)
    assert sorted(features.corners.tolist()) == sorted(vertex)
    assert len(features.curves) == 4
    assert np.degrees(features.turns[vertex]) == pytest.approx([90] * 4)


def test_a_spur_beside_a_longer_curve_is_no_feature() -> None:
    angle = np.radians(15 * np.arange(24))
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    ring[0] *= 2  # the ray to the right is longer than those beside it
    around = 1 + np.arange(24)
    faces = np.stack([0 * around, around, 1 + np.arange(1, 25) % 24], axis=1)
    surface = TriSurface(np.concatenate([[[0.0, 0.0, 0.0]], ring]), faces)

    def rays(*degrees: int) -> NDArray[np.int64]:
        return EdgePaths(surface).through(
            np.array([v for d in degrees for v in (0, 1 + d // 15, 0)])
        )

    drawn = no_features(surface).united(rays(0, 15, 180))
    assert len(drawn.curves) == 3
    sharp = np.full(len(surface.edges), np.radians(90))
    kept = without_spurs(drawn, sharp, np.radians(40))
    assert kept.edges.tolist() == sorted(set(rays(0, 180).tolist()))
    apart = no_features(surface).united(rays(0, 45, 180))
    assert without_spurs(apart, sharp, np.radians(40)).edges.tolist() == apart.edges.tolist()


def test_edges_of_the_boundary_are_no_features() -> None:
    surface = BUILTIN["square"](n=8)
    assert len(no_features(surface).united(np.arange(len(surface.edges)))) == np.count_nonzero(
        surface.edge_faces[:, 1] >= 0
    )


def test_refinement_keeps_features() -> None:
    surface = cube()
    features = Features(surface, sharp_edges(surface, 40))
    rng = np.random.default_rng(1)
    on_edge = [surface.point_at_vertex(int(v)) for v in features.ends[::9, 0]]
    anywhere = [surface.closest_point(x) for x in rng.uniform(-1, 1, (5, 3))]
    for refinement in (
        refine_everywhere(surface),
        refine_at(surface, [*on_edge, *anywhere], 3, features.edges),
    ):
        fine = features.refined(refinement)
        assert length(fine) == pytest.approx(length(features))
        assert len(fine.curves) == 12
        bend = sharp_edges(refinement.surface, 40)
        assert (fine.edges == bend).all()


def test_triangles_between_features_are_split() -> None:
    surface = BUILTIN["square"](n=2)  # all inner edges: most triangles have three
    features = no_features(surface).united(np.arange(len(surface.edges)))
    refinement = refine_at(surface, [], 0, features.edges)
    fine = features.refined(refinement)
    follows = np.isin(fine.surface.face_edges, fine.edges)
    follows |= (fine.surface.edge_faces[:, 1] < 0)[fine.surface.face_edges]
    assert follows.sum(axis=1).max() == 1
    assert length(fine) == pytest.approx(length(features))
    assert fine.surface.area == pytest.approx(surface.area)


def test_integers_are_chosen_as_by_trying_all() -> None:
    rng = np.random.default_rng(2)
    for _ in range(20):
        root = rng.normal(size=(4, 4))
        matrix, wanted = root @ root.T + 0.1 * np.eye(4), rng.uniform(-2, 2, 4)
        linear = -matrix @ wanted
        found = nearest_integers(matrix, linear)
        grid = np.stack(np.meshgrid(*[np.arange(-8, 9)] * 4), axis=-1).reshape(-1, 4)
        cost = np.einsum("ki,ij,kj->k", grid, matrix, grid) + 2 * grid @ linear
        reached = found @ matrix @ found + 2 * linear @ found
        # Rounding finds no worse a field than the nearest multiple of each curve alone.
        alone = np.rint(wanted)
        assert reached <= alone @ matrix @ alone + 2 * linear @ alone + 1e-9
        assert reached >= cost.min() - 1e-9


@pytest.mark.parametrize("made", [cube, lambda: turned(cube())], ids=["straight", "turned"])
def test_a_cube_with_its_edges_marked_has_a_grid_on_each_side(
    made: Callable[[], TriSurface],
) -> None:
    surface = made()
    features = Features(surface, sharp_edges(surface, 40))
    found = run(natural_singularities(surface, features=features))
    assert [s.valence for s in found] == [3] * 8
    places = [int(np.argmax(s.point.barycentric)) for s in found]
    corners = [int(surface.faces[s.point.face, i]) for s, i in zip(found, places, strict=True)]
    assert sorted(corners) == features.corners.tolist()
    aligned, integrated = solved(surface, features, found, refine=0)
    assert aligned.field.energy < 1e-10
    assert misalignment(integrated.field) < 1e-8
    assert len(seamless_map(integrated).inverted) == 0
    # on each side u or v is along each of its edges: H is constant
    assert np.ptp(integrated.field.H) < 1e-9


def test_the_isotropic_field_reports_its_misalignment() -> None:
    surface = BUILTIN["cylinder"](n=48)
    along = circle(surface, 0.0)
    field = IsotropicSolver(surface, features=along).solve([])
    assert misalignment(field) < 1e-9
    # the field runs around and along the axis; a slanted edge is off by its slope
    ends = surface.vertices[surface.edges]
    slanted = (np.abs(ends[:, 0, 2] - ends[:, 1, 2]) > 1e-9) & (
        np.linalg.norm(ends[:, 0, :2] - ends[:, 1, :2], axis=1) > 1e-9
    )
    one = no_features(surface).united(np.flatnonzero(slanted)[10:11])
    field = IsotropicSolver(surface, features=one).solve([])
    run_along = ends[one.edges[0], 1] - ends[one.edges[0], 0]
    slope = np.degrees(np.arctan2(abs(run_along[2]), np.linalg.norm(run_along[:2])))
    expected = min(slope, 90 - slope)
    assert misalignment(field) == pytest.approx(expected, abs=1)


def test_where_nothing_else_fixes_the_crosses_they_turn_to_the_features() -> None:
    surface = cube()
    slanted = TriSurface(surface.vertices, np.roll(surface.faces, 1, axis=1))
    features = Features(slanted, sharp_edges(slanted, 40))
    corners = at_vertices(slanted, features.corners.tolist(), [3] * 8)
    field = IsotropicSolver(slanted, features=features).solve(corners)
    assert misalignment(field) < 1e-8
    plain = IsotropicSolver(slanted).solve(corners)
    off = np.degrees(wrap(field.theta - plain.theta, np.pi / 2))
    assert np.ptp(off) < 1e-9
    assert np.abs(off).max() > 1  # the first edge of the first triangle is a diagonal


def test_a_marked_circle_is_followed_where_the_isotropic_field_is_not() -> None:
    surface = BUILTIN["cylinder"](n=48)
    features = circle(surface, 0.0)
    places = ([np.cos(a), np.sin(a), z] for a, z in ((0.3, 0.5), (2.0, 0.4), (1.1, -0.5), (3, 0.6)))
    singularities = [
        Singularity(surface.closest_point(place), valence)
        for place, valence in zip(places, (3, 5, 3, 5), strict=True)
    ]
    aligned, integrated = solved(surface, features, singularities)
    assert misalignment(aligned.aligned.isotropic) > 1
    for field in (aligned.field, integrated.field):
        assert misalignment(field) < 1e-8
        assert np.degrees(np.abs(field.boundary_misalignment)).max() < 1e-8
        assert field.max_closing_error < 1e-10
    assert integrated.field.energy < 1e-10


def test_a_curve_that_the_singularities_do_not_fit_is_followed_and_told() -> None:
    # a circle on the cylinder with a valence 3 on one side and a valence 5 on the other
    surface = BUILTIN["cylinder"](n=48)
    features = circle(surface, 0.0)

    def pair(one: float, other: float) -> list[Singularity]:
        places = (([1, 0, one], 3), ([-1, 0, other], 5))
        return [Singularity(surface.closest_point(p), valence) for p, valence in places]

    split, _ = solved(surface, features, pair(0.5, -0.5))
    assert misalignment(split.field) < 1e-8
    assert split.field.max_closing_error < 1e-10
    assert len(split.aligned.forced_corners) > 0
    beside, _ = solved(surface, features, pair(0.5, 0.5))
    assert misalignment(beside.field) < 1e-8
    assert len(beside.aligned.forced_corners) == 0


def test_imposed_turns_are_kept_and_free_ones_are_chosen() -> None:
    surface = BUILTIN["annulus"](n=48)
    radius = np.linalg.norm(surface.vertices, axis=1)
    level = radius[np.argmin(np.abs(radius - 0.7))]
    ring = np.flatnonzero((np.abs(radius[surface.edges] - level) < 1e-6).all(axis=1))
    features = no_features(surface).united(ring)
    assert len(features.curves) >= 1
    prepared = prepare(surface, features=features)
    assert aligned_field(prepared).turns == (0,)
    forced = aligned_field(prepared, [1])
    assert forced.turns == (1,)
    assert misalignment(IntegratedField(forced, forced.start).field) < 1e-8


@pytest.mark.parametrize("name", REAL)
def test_features_of_real_surfaces_keep_budget_and_closing(name: str) -> None:
    surface = Problem.from_case(Case(str(PATHS[name]))).surface
    features = Features(surface, sharp_edges(surface, 60))
    found = run(natural_singularities(surface, "globally-optimal", features=features))
    indices = sum(s.index for s in found) + sum(default_corners(surface).values())
    assert indices == 4 * surface.euler_characteristic
    aligned = aligned_field(prepare(surface, found, refine=0, features=features))
    field = IntegratedField(aligned, aligned.start).field
    assert misalignment(field) < 1e-6
    assert np.degrees(np.abs(field.boundary_misalignment)).max(initial=0.0) < 1e-6
    assert field.max_closing_error < 1e-9


@pytest.mark.parametrize("name", ["plate_holes.stl", "wingnut.obj"])
def test_cad_files_come_out_aligned(name: str) -> None:
    surface = Problem.from_case(Case(str(PATHS[name]))).surface
    features = Features(surface, sharp_edges(surface, 40))
    found = run(natural_singularities(surface, features=features))
    aligned, integrated = solved(surface, features, found)
    assert misalignment(aligned.aligned.isotropic) > 10
    assert misalignment(aligned.field) < 1e-6
    assert misalignment(integrated.field) < 1e-6
    assert integrated.field.energy < 1e-10
    assert len(seamless_map(integrated).inverted) == 0


def test_pointy_has_no_edge_as_sharp_and_is_aligned_with_its_boundary() -> None:
    surface = Problem.from_case(Case(str(PATHS["pointy.obj"]))).surface
    features = Features(surface, sharp_edges(surface, 40))
    assert len(features) == 0
    found = run(natural_singularities(surface, features=features))
    aligned, integrated = solved(surface, features, found)
    assert np.degrees(np.abs(aligned.field.boundary_misalignment)).max() < 1e-6
    assert integrated.field.energy < 1e-10
