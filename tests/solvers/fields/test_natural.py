"""Natural singularities: the budget always, and the anticube on the sphere."""

from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

from solvers.errors import CrossviewError, SingularityError
from solvers.features.dihedral import sharp_edges
from solvers.features.edges import Features, no_features
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.natural import (
    NATURAL_METHODS,
    CrossesStep,
    _Crosses,
    natural_singularities,
)
from solvers.fields.principal import principal_crosses
from solvers.primitives import BUILTIN
from solvers.progress import Progress, relayed, run
from solvers.singularities.budget import default_corners, index_budget
from solvers.surface.symmetries import isometries
from solvers.surface.triangulation import wrap
from solvers.surface.trisurface import TriSurface
from tests.solvers.features.test_features import cube
from tests.solvers.suite import SURFACES


@pytest.mark.parametrize("method", NATURAL_METHODS)
@pytest.mark.parametrize("name", SURFACES)
def test_indices_sum_to_the_budget(name: str, method: str) -> None:
    surface = SURFACES[name]()
    found = run(natural_singularities(surface, method))
    assert index_budget(surface, found, default_corners(surface)).satisfied
    positions = surface.positions([s.point for s in found])
    boundary = surface.vertices[surface.boundary_vertices]
    if len(found) and len(boundary):
        assert np.linalg.norm(positions[:, None] - boundary, axis=2).min() > 0


@pytest.mark.parametrize("method", NATURAL_METHODS)
@pytest.mark.parametrize("name", ["square", "annulus", "cylinder"])
def test_no_singularity_where_none_is_needed(name: str, method: str) -> None:
    assert run(natural_singularities(SURFACES[name](), method)) == ()


def anticube() -> np.ndarray:
    """The corners of the square antiprism that eight equal charges take on the sphere."""
    latitude = np.radians(34.1)
    angles = np.pi / 2 * np.arange(4)
    rings = [
        (np.cos(latitude) * np.cos(a + turn), np.cos(latitude) * np.sin(a + turn), sign)
        for turn, sign in ((0, 1), (np.pi / 4, -1))
        for a in angles
    ]
    return np.array([(x, y, sign * np.sin(latitude)) for x, y, sign in rings])


def misfit(points: np.ndarray) -> float:
    """Degrees by which the sorted mutual angles differ from those of the anticube."""

    def angles(x: np.ndarray) -> np.ndarray:
        cosine = np.clip(x @ x.T, -1, 1)[np.triu_indices(len(x), 1)]
        return np.sort(np.degrees(np.arccos(cosine)))

    return float(np.abs(angles(points) - angles(anticube())).mean())


@pytest.mark.parametrize("method", ["mbo", "ginzburg-landau"])
def test_the_sphere_has_the_anticube(method: str) -> None:
    def fit(subdivisions: int, seed: int) -> float:
        surface = BUILTIN["sphere"](subdivisions=subdivisions)
        found = run(natural_singularities(surface, method, seed))
        assert [s.valence for s in found] == [3] * 8
        points = surface.positions([s.point for s in found])
        return misfit(points / np.linalg.norm(points, axis=1)[:, None])

    assert max(fit(3, seed) for seed in range(3)) < 3.0  # edges are 8 degrees long
    assert fit(4, 0) < 1.5


def test_an_unknown_method_is_refused() -> None:
    with pytest.raises(CrossviewError, match="one of mbo, ginzburg-landau, globally-optimal"):
        run(natural_singularities(SURFACES["disk"](), "best"))


def direction_off(surface: TriSurface, step: CrossesStep, directions: np.ndarray) -> np.ndarray:
    """Degrees between the cross of each triangle and a direction (m, 3), 0 to 45."""
    along, across = surface.face_frames
    angle = np.arctan2((across * directions).sum(axis=1), (along * directions).sum(axis=1))
    return np.degrees(np.abs(wrap(step.theta - angle, np.pi / 2)))


def around(surface: TriSurface) -> np.ndarray:
    """The direction around the z axis in each triangle."""
    x, y, _ = surface.barycentres.T
    return np.stack([-y, x, np.zeros_like(x)], axis=1)


@pytest.mark.parametrize("name", ["cylinder", "torus"])
def test_principal_directions_run_around_and_along(name: str) -> None:
    surface = SURFACES[name]()
    step = CrossesStep("", 0.0, surface, principal_crosses(surface))
    assert np.median(direction_off(surface, step, around(surface))) < 1
    assert 0.5 < np.median(np.abs(step.z)) < 1.5


@pytest.mark.parametrize("name", ["square", "sphere"])
def test_nothing_draws_where_both_curvatures_agree(name: str) -> None:
    assert np.abs(principal_crosses(BUILTIN[name]())).max() < 0.1


@pytest.mark.parametrize("method", NATURAL_METHODS)
def test_crosses_are_drawn_along_curvature(method: str) -> None:
    surface = SURFACES["torus"]()
    seen: list[CrossesStep] = []

    def look(step: Progress) -> Progress:
        seen.append(step) if isinstance(step, CrossesStep) else None
        return step

    found = run(relayed(natural_singularities(surface, method, alignment="curvature"), look))
    assert found == ()
    if method != "globally-optimal":  # which takes one step
        assert np.median(direction_off(surface, seen[-1], around(surface))) < 1


def test_a_cone_of_features_gathers_singularities_at_its_corners() -> None:
    sphere = BUILTIN["cube_sphere"](n=12)
    cube = TriSurface(sphere.vertices / np.abs(sphere.vertices).max(axis=1)[:, None], sphere.faces)
    features = Features(cube, sharp_edges(cube, 40))
    for method in NATURAL_METHODS:
        found = run(natural_singularities(cube, method, features=features))
        places = cube.positions([s.point for s in found])
        assert [s.valence for s in found] == [3] * 8
        assert np.abs(places) == pytest.approx(np.ones((8, 3)))


@pytest.mark.parametrize(
    "wrong",
    [
        {"alignment": "symmetry"},
        {"alignment": "curvature", "weight": -1.0},
        {"most_valence": 4},
    ],
)
def test_wrong_options_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(CrossviewError, match=r"smoothness, curvature|weight|most valence"):
        run(natural_singularities(SURFACES["disk"](), **wrong))


def test_a_surface_without_vertices_inside_has_them_in_its_triangles() -> None:
    hexagon = [[np.cos(a), np.sin(a), 0] for a in np.pi / 3 * np.arange(6)]
    surface = TriSurface(hexagon, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])
    found = run(natural_singularities(surface))
    assert index_budget(surface, found, default_corners(surface)).satisfied
    assert len({s.point.face for s in found}) == len(found) > 0
    field = IsotropicSolver(surface).solve(found)  # refuses those on the boundary, or together
    assert np.abs(field.boundary_misalignment).max() < 1e-9


def test_a_triangle_has_one_valence_3() -> None:
    (only,) = run(natural_singularities(TriSurface([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])))
    assert only.valence == 3


def spike(height: float) -> TriSurface:
    """A disk drawn up to a needle in its middle."""
    flat = BUILTIN["disk"](edge_length=0.15)
    x, y, _ = flat.vertices.T
    up = height * np.maximum(0, 1 - 3 * np.hypot(x, y))
    return TriSurface(np.stack([x, y, up], axis=1), flat.faces)


@pytest.mark.parametrize("method", NATURAL_METHODS)
def test_a_spike_has_no_valence_below_2(method: str) -> None:
    surface = spike(10)
    assert surface.angle_defects.max() > np.radians(300)  # that of a valence 1 or 0
    found = run(natural_singularities(surface, method))
    assert min(s.valence for s in found) >= 2
    assert index_budget(surface, found, default_corners(surface)).satisfied


@pytest.mark.parametrize("name", ["torus", "double_torus", "sphere", "plate", "annulus"])
def test_the_fewest_singularities_are_what_the_budget_asks_for(name: str) -> None:
    surface = SURFACES[name]()
    missing = index_budget(surface, (), default_corners(surface)).missing
    found = run(natural_singularities(surface, fewest=True))
    assert [s.valence for s in found] == [4 - int(np.sign(missing))] * abs(missing)


def dented_disk(shift: float = 0.0) -> TriSurface:
    """A disk with eight sharp dents that are small beside it."""
    flat = BUILTIN["disk"](edge_length=0.04)
    x, y, _ = flat.vertices.T
    angle = shift + np.pi / 4 * np.arange(8)[:, None]
    away = np.hypot(x - 0.5 * np.cos(angle), y - 0.5 * np.sin(angle)).min(axis=0)
    return TriSurface(np.stack([x, y, 2 * np.maximum(0, 0.12 - away)], axis=1), flat.faces)


def test_details_below_the_scale_hold_no_singularities() -> None:
    surface = dented_disk()
    assert len(run(natural_singularities(surface, scale=0.0))) > 12
    for scale in (0.4, 0.8):
        found = run(natural_singularities(surface, scale=scale))
        assert [s.valence for s in found] == [3] * 4


def test_a_scale_below_the_triangles_changes_nothing() -> None:
    surface = dented_disk()
    found, other = (run(natural_singularities(surface, scale=scale)) for scale in (1e-6, 0.0))
    assert found == other


@pytest.mark.parametrize("method", NATURAL_METHODS)
def test_of_a_rough_cube_its_corners_are_no_details_and_its_roughness_is(method: str) -> None:
    surface = rough_cube(0.012)
    corners = surface.vertices[(np.abs(surface.vertices) == 1).all(axis=1)]
    found = run(natural_singularities(surface, method))
    assert [s.valence for s in found] == [3] * 8
    places = surface.positions([s.point for s in found])
    assert np.linalg.norm(places[:, None] - corners, axis=2).min(axis=0).max() < 1e-12
    assert len(run(natural_singularities(surface, method, scale=0.0))) > 8


def rough_cube(noise: float) -> TriSurface:
    """A cube with vertices on its sides, but for those near its edges, raised at random."""
    smooth = cube(40)
    x = smooth.vertices.copy()
    side = np.argmax(np.abs(x), axis=1)
    inner = np.sort(np.abs(x), axis=1)[:, 1] < 0.96
    raised = np.random.default_rng(0).normal(scale=noise, size=len(x))
    x[inner, side[inner]] += raised[inner]
    return TriSurface(x, smooth.faces)


def test_the_scale_is_a_length() -> None:
    surface = dented_disk()
    larger = TriSurface(1000 * surface.vertices, surface.faces)
    found, other = (
        run(natural_singularities(s, scale=scale)) for s, scale in ((surface, 0.1), (larger, 100.0))
    )
    assert [s.valence for s in found] == [s.valence for s in other]
    assert np.allclose(
        1000 * surface.positions([s.point for s in found]),
        larger.positions([s.point for s in other]),
    )


def test_corners_between_features_keep_their_quads_at_any_scale() -> None:
    surface = cube()
    features = Features(surface, sharp_edges(surface, 40))
    found = run(natural_singularities(surface, features=features, scale=10.0))
    assert sorted(s.valence for s in found) == [3] * 8
    corners = surface.vertices[features.corners]
    places = surface.positions([s.point for s in found])
    assert np.linalg.norm(places[:, None] - corners, axis=2).min(axis=1).max() < 1e-9


@pytest.mark.parametrize("most", [40, 13, 10])
def test_no_more_singularities_than_asked_for(most: int) -> None:
    surface = dented_disk()
    found = run(natural_singularities(surface, most=most, scale=0.0))
    assert len(found) <= most
    assert index_budget(surface, found, default_corners(surface)).satisfied
    assert all(3 <= s.valence <= 8 for s in found)


def test_fewer_than_the_budget_needs_are_refused() -> None:
    with pytest.raises(SingularityError, match="no fewer than 8"):
        run(natural_singularities(SURFACES["sphere"](), most=7))


@pytest.mark.parametrize("scale", [-1.0, np.nan, np.inf])
def test_a_scale_that_is_no_length_is_refused(scale: float) -> None:
    with pytest.raises(CrossviewError, match="scale"):
        run(natural_singularities(SURFACES["disk"](), scale=scale))


def test_every_sector_between_features_has_a_quad() -> None:
    surface = BUILTIN["disk"](edge_length=0.2)
    middle = surface.nearest_vertex(surface.closest_point([0, 0, 0]))
    spokes = np.flatnonzero((surface.edges == middle).any(axis=1))
    assert len(spokes) > 4
    found = run(natural_singularities(surface, features=Features(surface, spokes)))
    (hub,) = (s for s in found if s.point == surface.point_at_vertex(middle))
    assert hub.valence == len(spokes)
    assert index_budget(surface, found, default_corners(surface)).satisfied


@pytest.mark.parametrize("method", ["mbo", "ginzburg-landau"])
@pytest.mark.parametrize("name", ["disk", "ellipsoid", "double_torus"])
def test_symmetric_surfaces_have_symmetric_singularities(name: str, method: str) -> None:
    surface = BUILTIN["ellipsoid"](subdivisions=3) if name == "ellipsoid" else SURFACES[name]()
    group = isometries(surface)
    assert len(group) > 1
    for seed in (0, 1):
        found = run(natural_singularities(surface, method, seed))
        assert found
        places = surface.positions([s.point for s in found])
        valences = np.array([s.valence for s in found])
        for isometry in group:
            gaps = np.linalg.norm(isometry.image(places)[:, None] - places, axis=2)
            gaps[valences[:, None] != valences] = np.inf
            assert gaps.min(axis=1).max() < 1e-6 * surface.diagonal


def test_no_crosses_of_unit_norm_are_smoother_than_the_globally_optimal() -> None:
    surface = BUILTIN["sphere"](subdivisions=2)
    problem = _Crosses(surface, no_features(surface), 0.0, surface.triangulation.angles)
    z = run(problem.globally_optimal(np.random.default_rng(0)))
    least = eigh(problem.energy.toarray(), np.diag(problem.mass), eigvals_only=True)[0]
    energy = (z.conj() @ (problem.energy @ z)).real / (problem.mass @ np.abs(z) ** 2)
    assert energy == pytest.approx(least, rel=1e-9)
