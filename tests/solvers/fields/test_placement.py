"""Indices spread and cancelled: their sum, their range, and the energy by which they do."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solvers.errors import SingularityError
from solvers.features.edges import Features, no_features
from solvers.features.regions import face_regions
from solvers.fields.placement import placed_singularities
from solvers.primitives import BUILTIN
from solvers.singularities.budget import Singularity
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import SURFACES


def placed(
    surface: TriSurface,
    index: dict[int, int],
    *,
    features: Features | None = None,
    lacking: tuple[tuple[int, int], ...] = (),
    most_valence: int = 8,
    fewest: bool = False,
) -> tuple[Singularity, ...]:
    """Singularities of the indices of some vertices."""
    at_sites = np.zeros(surface.n_vertices + surface.n_faces, dtype=np.int64)
    at_sites[list(index)] = list(index.values())
    return placed_singularities(
        surface,
        at_sites,
        features or no_features(surface),
        np.array(lacking, dtype=np.int64).reshape(-1, 2),
        most_valence=most_valence,
        fewest=fewest,
    )


def vertex_at(surface: TriSurface, x: float, y: float) -> int:
    return int(np.argmin(np.hypot(surface.vertices[:, 0] - x, surface.vertices[:, 1] - y)))


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 1000), most=st.integers(5, 9))
@pytest.mark.parametrize("name", ["disk", "torus", "plate"])
def test_valences_are_in_range_and_their_sum_is_kept(name: str, seed: int, most: int) -> None:
    surface = SURFACES[name]()
    rng = np.random.default_rng(seed)
    vertices = rng.choice(surface.n_vertices, 6, replace=False)
    indices = rng.integers(-8, 5, 6)
    found = placed(surface, dict(zip(vertices, indices, strict=True)), most_valence=most)
    assert sum(s.index for s in found) == indices.sum()
    assert all(2 <= s.valence <= most for s in found)
    nearest = [surface.nearest_vertex(s.point) for s in found]
    assert not surface.boundary_vertices[nearest].any()
    assert len(set(nearest)) == len(nearest)


def test_what_is_too_much_stands_apart_around_its_place() -> None:
    surface = BUILTIN["disk"](edge_length=0.05)
    found = placed(surface, {vertex_at(surface, 0, 0): 4})
    assert sorted(s.valence for s in found) == [2, 3, 3]
    radii = np.linalg.norm(surface.positions([s.point for s in found]), axis=1)
    assert 0.05 < np.sort(radii)[1] < 0.95


def test_a_pair_on_a_plane_cancels_only_where_it_is_near() -> None:
    surface = BUILTIN["square"](n=20)
    middle, beside, far = (vertex_at(surface, x, 0.0) for x in (0.0, 0.05, 0.3))
    assert placed(surface, {middle: 1, beside: -1}) == ()
    assert len(placed(surface, {middle: 1, far: -1})) == 2
    assert placed(surface, {middle: 1, far: -1}, fewest=True) == ()


def test_a_near_pair_stays_where_curvature_holds_it() -> None:
    # A cone in a plane: as much curvature at its top as there is less of it at its foot.
    flat = BUILTIN["square"](n=20)
    middle, beside = (vertex_at(flat, x, 0.0) for x in (0.0, 0.1))
    x, y, _ = flat.vertices.T
    cone = np.maximum(0, 0.1 - np.hypot(x, y))
    bent = TriSurface(np.stack([x, y, 2 * cone], axis=1), flat.faces)
    assert bent.angle_defects[middle] > np.pi / 2
    assert placed(flat, {middle: 1, beside: -1}) == ()
    assert len(placed(bent, {middle: 1, beside: -1})) == 2


def test_pairs_do_not_cancel_across_features() -> None:
    surface = BUILTIN["square"](n=20)
    x = surface.vertices[surface.edges, 0]
    wall = Features(surface, np.flatnonzero((np.abs(x) < 1e-9).all(axis=1)))
    pair = {vertex_at(surface, -0.05, 0.0): 1, vertex_at(surface, 0.05, 0.0): -1}
    assert len(placed(surface, pair, features=wall, fewest=True)) == 2
    assert placed(surface, pair, fewest=True) == ()


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 1000))
def test_each_region_keeps_the_sum_that_gauss_and_bonnet_ask_of_it(seed: int) -> None:
    surface = BUILTIN["square"](n=12)
    x, y, _ = surface.vertices[surface.edges].transpose(2, 0, 1)
    crossing = (np.abs(x) < 1e-9).all(axis=1) | (np.abs(y) < 1e-9).all(axis=1)
    walls = Features(surface, np.flatnonzero(crossing))
    region = face_regions(walls)
    inside = np.flatnonzero(~np.isin(np.arange(surface.n_vertices), surface.edges[crossing]))
    inside = inside[~surface.boundary_vertices[inside]]
    rng = np.random.default_rng(seed)
    vertices = rng.choice(inside, 5, replace=False)
    indices = rng.integers(-8, 5, 5)
    middle = vertex_at(surface, 0, 0)
    short = tuple((middle, int(r)) for r in rng.integers(0, 4, 2))
    given = dict(zip(vertices.tolist(), indices.tolist(), strict=True))
    found = placed(surface, given, features=walls, lacking=short)
    before, after = np.zeros(4), np.zeros(4)
    np.add.at(before, region[[surface.point_at_vertex(int(v)).face for v in vertices]], indices)
    np.add.at(before, [r for _, r in short], 1)
    kept = [s for s in found if surface.nearest_vertex(s.point) != middle]
    np.add.at(after, region[[s.point.face for s in kept]], [s.index for s in kept])
    assert after.tolist() == before.tolist()
    assert sum(s.index for s in found if s not in kept) == -2


def test_a_hole_that_is_capped_by_a_fan_keeps_what_its_middle_has_too_much() -> None:
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    i = np.arange(24)
    j = (i + 1) % 24
    fan = np.stack([np.zeros(24, dtype=np.int64), 1 + i, 1 + j], axis=1)
    wall = np.concatenate(
        [np.stack([1 + i, 25 + i, 1 + j], axis=1), np.stack([25 + i, 25 + j, 1 + j], axis=1)]
    )
    points = np.concatenate([np.zeros((1, 3)), ring, ring + [0, 0, 1]])
    cap = TriSurface(points, np.concatenate([fan, wall]))
    rim = np.isin(cap.edges, 1 + i).all(axis=1)
    found = placed(cap, {0: 4}, features=Features(cap, np.flatnonzero(rim)))
    assert sorted(s.valence for s in found) == [2, 3, 3]
    assert np.allclose(cap.positions([s.point for s in found])[:, 2], 0)


def test_no_room_is_one_line() -> None:
    surface = TriSurface([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(SingularityError, match="no room"):
        placed(surface, {0: 3})
