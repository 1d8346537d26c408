"""Quads between curves: what topology says of them, whatever the whole numbers are."""

import numpy as np
import pytest

from solvers.features.dihedral import sharp_edges
from solvers.features.edges import Features, no_features
from solvers.fields.aligned import AlignedField, aligned_field
from solvers.fields.natural import natural_singularities
from solvers.fields.prepared import prepare
from solvers.fields.sector_quads import turned_over_corners
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import Singularity
from solvers.surface.triangulation import QUARTER, FloatArray
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import SURFACES, at_vertices


def quads(aligned: AlignedField) -> FloatArray:
    """By how many quarter turns the field turns over each sector."""
    i = aligned.integrability
    turned = i.triangulation.angles - turned_over_corners(i.offsets)
    return aligned.sectors.total(turned) / QUARTER


def circle(surface: TriSurface) -> Features:
    """The edges of a cylinder or torus at half its height."""
    at = np.abs(surface.vertices[:, 2]) < 1e-9
    return no_features(surface).united(np.flatnonzero(at[surface.edges].all(axis=1)))


@pytest.mark.parametrize("name", ["disk", "l_shape", "plate", "cylinder", "torus_with_hole"])
def test_sectors_of_a_vertex_hold_its_valence(name: str) -> None:
    surface = SURFACES[name]()
    rng = np.random.default_rng(3)
    marked = np.flatnonzero(rng.random(len(surface.edges)) < 0.05)
    features = no_features(surface).united(marked)
    singularities = run(natural_singularities(surface, features=features))
    prepared = prepare(surface, singularities, features=features)
    aligned = aligned_field(prepared)
    found, sectors = quads(aligned), aligned.sectors
    beside = (sectors.start >= 0) | (sectors.end >= 0)
    assert np.abs(found - np.rint(found))[beside].max() < 1e-6
    assert found[beside].min() > 0.5
    t = aligned.integrability.triangulation
    valence = np.full(t.n_vertices, 4)
    valence[t.tail[t.boundary_halfedges]] = 2
    for vertex, index in prepared.corners.items():
        valence[vertex] -= index
    for s in prepared.singularities:
        valence[prepared.surface.nearest_vertex(s.point)] = s.valence
    around = np.bincount(sectors.vertex, found)
    touched = np.unique(sectors.vertex[beside])
    assert len(touched) > 10
    assert around[touched] == pytest.approx(valence[touched], abs=1e-6)


def test_the_sides_of_a_cube_meet_in_one_quad_each_at_its_corners() -> None:
    sphere = BUILTIN["cube_sphere"](n=6)
    reach = np.abs(sphere.vertices).max(axis=1)
    surface = TriSurface(sphere.vertices / reach[:, None], sphere.faces)
    features = Features(surface, sharp_edges(surface, 40))
    corners = at_vertices(surface, features.corners.tolist(), [3] * 8)
    aligned = aligned_field(prepare(surface, corners, refine=0, features=features))
    sectors = aligned.sectors
    beside = sectors.start >= 0
    at_corner = np.isin(sectors.vertex, features.corners)
    assert quads(aligned)[at_corner & beside] == pytest.approx(np.ones(24))
    assert quads(aligned)[~at_corner & beside] == pytest.approx(2.0)


@pytest.mark.parametrize("threes", [0, 1, 2, 4])
def test_a_circle_is_broken_as_often_as_the_singularities_beside_it_ask_for(threes: int) -> None:
    """By Gauss and Bonnet: the part between a circle and a boundary has index 0."""
    surface = BUILTIN["cylinder"](n=48)
    angle = 2 * np.pi * (0.1 + np.arange(threes)) / max(threes, 1)
    singularities = [
        Singularity(surface.closest_point([np.cos(a), np.sin(a), side * 0.5]), 4 - side)
        for a in angle
        for side in (1, -1)
    ]
    aligned = aligned_field(prepare(surface, singularities, features=circle(surface)))
    sectors = aligned.sectors
    found = np.rint(quads(aligned)[sectors.start >= 0]).astype(int)
    assert len(aligned.released) == 0
    assert np.bincount(found, minlength=4).tolist() == [0, threes, len(found) - 2 * threes, threes]
