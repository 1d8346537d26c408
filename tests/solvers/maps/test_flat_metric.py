"""Flat metrics with prescribed cones: upright maps where the linear one is folded."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.fields import IntegratedField, aligned_field, prepare
from solvers.maps.flat_metric import flat_metric
from solvers.maps.matching import Matching
from solvers.maps.seamless import SeamlessFit, seamless_map
from solvers.primitives import annulus, sphere, torus
from solvers.singularities import Singularity
from solvers.surface import TriSurface


def with_one_of(valence: int, surface: TriSurface) -> IntegratedField:
    """The field of one large valence on a sphere, balanced by valences 3 in two rings below."""
    threes = 8 + valence - 4
    angle = 2 * np.pi * np.arange(threes) / threes
    z = np.where(np.arange(threes) % 2, -0.3, -0.8)
    r = np.sqrt(1 - z**2)
    places = [[0.0, 0.0, 1.0], *np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)]
    valences = [valence, *[3] * threes]
    singularities = [
        Singularity(surface.closest_point(place), k)
        for place, k in zip(places, valences, strict=True)
    ]
    aligned = aligned_field(prepare(surface, singularities))
    return IntegratedField(aligned, aligned.start)


@pytest.mark.parametrize("valence", [1, 2, 8, 12, 16, 20, 24])
def test_every_valence_gets_the_triangles_that_it_needs(valence: int) -> None:
    map_ = seamless_map(with_one_of(valence, sphere(subdivisions=2)))
    assert map_.upright
    z = map_.images @ np.array([1, 1j])
    assert np.abs(z.sum(axis=1)).max() < 1e-12 * np.abs(z).max()
    # images of both sides of an edge differ by quarter turns
    t, jumps = map_.matching.triangulation, map_.matching.period_jumps
    h = np.flatnonzero(t.twin >= 0)
    across = -z.reshape(-1)[h] * 1j ** jumps[h]
    assert np.abs(z.reshape(-1)[t.twin[h]] - across).max() < 1e-12 * np.abs(z).max()


def test_a_flat_torus_is_its_own_metric() -> None:
    surface = torus(n=16)
    aligned = aligned_field(prepare(surface))
    matching = Matching.of(aligned.integrability)
    t = matching.triangulation
    # of lengths far from flat, noisy and of a curved surface
    noise = np.random.default_rng(3).normal(0, 0.05, len(t.twin))
    log_lengths = np.log(t.lengths.reshape(-1)) + noise + noise[t.twin]
    found = flat_metric(matching, log_lengths, aligned.integrability.theta)
    assert found is not None
    z = found.images @ np.array([1, 1j])
    assert ((z[:, 0].conj() * z[:, 1]).imag > 0).all()
    assert_allclose(z.sum(axis=1), 0, atol=1e-7)
    assert_array_equal(np.unique(found.matching.quads), 4)


def test_boundaries_stay_straight_and_cones_exact() -> None:
    surface = annulus(inner=0.4, n=48)
    aligned = aligned_field(prepare(surface))
    matching = Matching.of(aligned.integrability)
    t = matching.triangulation
    noise = np.random.default_rng(4).normal(0, 0.05, len(t.twin))
    twin = np.where(t.twin >= 0, t.twin, np.arange(len(t.twin)))
    found = flat_metric(
        matching, np.log(t.lengths.reshape(-1)) + noise + noise[twin], aligned.integrability.theta
    )
    assert found is not None
    matching, images = found.matching, found.images.reshape(-1, 2)
    on_boundary = matching.triangulation.boundary_halfedges
    across = images[on_boundary, (matching.axes[on_boundary] + 1) % 2]
    assert np.abs(across).max() < 1e-7 * np.abs(images).max()


def test_joins_keep_a_repaired_map_upright() -> None:
    fit = SeamlessFit(with_one_of(12, sphere(subdivisions=3)))
    assert fit.map.upright
    assert fit.matching is fit.map.matching
    assert not fit.matching.working.unchanged


def test_a_sector_without_quads_has_no_metric() -> None:
    matching = Matching.of(aligned_field(prepare(annulus(inner=0.4, n=24))).integrability)
    quads = matching.quads.copy()
    quads[0] = 0
    t = matching.triangulation
    none = Matching(matching.working, matching.period_jumps, matching.axes, matching.sector, quads)
    assert flat_metric(none, np.log(t.lengths.reshape(-1)), np.zeros(t.n_faces)) is None
