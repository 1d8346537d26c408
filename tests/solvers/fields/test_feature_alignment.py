"""Fields along features: no sector is empty, and what has no room is released by its value."""

import numpy as np
import pytest

from crossview.cases.model import Case
from crossview.workflow.problem import Problem
from solvers.features.dihedral import sharp_edges
from solvers.features.edges import Features, no_features
from solvers.fields.aligned import IntegratedField, aligned_field
from solvers.fields.natural import natural_singularities
from solvers.fields.prepared import prepare
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.surface.edge_paths import EdgePaths
from solvers.surface.trisurface import TriSurface
from tests.real_surfaces import PATHS, REAL
from tests.solvers.fields.test_sector_quads import quads
from tests.solvers.suite import at_vertices


def wheel(spokes: int, lengths: list[float]) -> tuple[TriSurface, Features]:
    """A disk with features from its centre towards the boundary, as far as `lengths` says."""
    n, rings = 4 * spokes, 8
    angle = 2 * np.pi * np.arange(n) / n
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    radii = np.arange(1, rings + 1) / rings
    vertices = np.concatenate([np.zeros((1, 3)), *(r * ring for r in radii)])
    around = np.arange(n)
    after = (around + 1) % n
    faces = [np.stack([0 * around, 1 + around, 1 + after], axis=1)]
    for k in range(rings - 1):
        a, b, c, d = (1 + k * n + i for i in (around, after, n + around, n + after))
        faces += [np.stack([a, c, d], axis=1), np.stack([a, d, b], axis=1)]
    surface = TriSurface(vertices, np.concatenate(faces))
    paths = EdgePaths(surface)
    drawn = [
        paths.through(np.array([0, *(1 + k * n + 4 * i for k in range(round(rings * length)))]))
        for i, length in enumerate(lengths)
    ]
    return surface, no_features(surface).united(np.concatenate(drawn))


def test_of_five_spokes_around_a_regular_vertex_the_shortest_is_released() -> None:
    """A vertex has as many quads as its valence, and each sector needs one."""
    surface, features = wheel(5, [0.75, 0.75, 0.5, 0.75, 0.75])
    corners = dict.fromkeys(surface.boundary_loops[0][::5].tolist(), 1)
    aligned = aligned_field(prepare(surface, refine=0, corners=corners, features=features))
    assert len(aligned.features.curves) == 4
    (spoke,) = aligned.released.curves
    assert len(spoke.members) == 4
    assert np.abs(surface.vertices[spoke.vertices]).max() < 0.51
    field = IntegratedField(aligned, aligned.start).field
    assert len(field.feature_misalignment) == 4
    assert np.degrees(np.abs(field.feature_misalignment)).max() < 1e-6


def test_around_a_valence_of_five_there_is_room_for_all() -> None:
    surface, features = wheel(5, [0.75, 0.75, 0.5, 0.75, 0.75])
    corners = dict.fromkeys(surface.boundary_loops[0][::4].tolist(), 1)
    five = at_vertices(surface, [0], [5])
    aligned = aligned_field(prepare(surface, five, refine=0, corners=corners, features=features))
    assert len(aligned.released) == 0
    at_centre = aligned.sectors.vertex == 0
    assert quads(aligned)[at_centre] == pytest.approx(np.ones(5))


def test_where_no_curve_has_room_none_is_followed() -> None:
    surface, features = wheel(6, [0.5] * 6)
    corners = dict.fromkeys(surface.boundary_loops[0][::8].tolist(), 1)
    one = at_vertices(surface, [0], [3])
    aligned = aligned_field(prepare(surface, one, refine=0, corners=corners, features=features))
    assert len(aligned.features.curves) == 3
    assert len(aligned.features) + len(aligned.released) == len(features)


@pytest.mark.parametrize("name", REAL)
def test_each_sector_of_real_surfaces_has_a_quad(name: str) -> None:
    surface = Problem.from_case(Case(str(PATHS[name]))).surface
    features = Features(surface, sharp_edges(surface, 40))
    found = run(natural_singularities(surface, "globally-optimal", features=features))
    aligned = aligned_field(prepare(surface, found, refine=0, features=features))
    sectors = aligned.sectors
    beside = (sectors.start >= 0) | (sectors.end >= 0)
    assert quads(aligned)[beside].min(initial=1.0) > 1 - 1e-6


def test_one_circle_on_a_sphere_is_followed_though_all_crosses_may_turn_at_no_cost() -> None:
    """The energy of the only whole number is zero, or what rounding leaves: of either sign."""
    for n in (4, 6, 8):
        surface = BUILTIN["cube_sphere"](n=n)
        equator = np.abs(surface.vertices[:, 2]) < 1e-9
        features = no_features(surface).united(np.flatnonzero(equator[surface.edges].all(axis=1)))
        assert len(features.curves) == 1
        found = run(natural_singularities(surface, features=features))
        aligned = aligned_field(prepare(surface, found, refine=0, features=features))
        field = IntegratedField(aligned, aligned.start).field
        assert np.degrees(np.abs(field.feature_misalignment)).max() < 1e-6
