"""What a seamless map keeps: quads in sectors, axes, windings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from solvers import run
from solvers.features import Features
from solvers.fields import IntegratedField, aligned_field, anisotropic_field, prepare
from solvers.maps import Matching, SeamlessMap, seamless_map
from solvers.primitives import annulus, square
from solvers.singularities import Singularity
from solvers.surface import IntrinsicTriangulation, WorkingTriangulation


def around(quads: int, spokes: int, turns: int) -> SeamlessMap:
    """A vertex of a number of quads, its fan of triangles mapped `turns` quarters around it."""
    faces = np.array([[0, 1 + k, 1 + (k + 1) % spokes] for k in range(spokes)])
    k = np.arange(spokes)
    twin = np.full((spokes, 3), -1)
    twin[:, 0], twin[:, 2] = 3 * ((k - 1) % spokes) + 2, 3 * ((k + 1) % spokes)
    rim = 2 * np.sin(np.pi / spokes)
    lengths = np.tile([1.0, rim, 1.0], (spokes, 1))
    t = IntrinsicTriangulation(spokes + 1, faces, twin.reshape(-1), lengths)
    step = turns * np.pi / 2 / spokes
    corner = np.exp(1j * step * np.stack([k, k + 1], axis=1))
    z = np.stack([corner[:, 0], corner[:, 1] - corner[:, 0], -corner[:, 1]], axis=1)
    sector = faces.reshape(-1)
    prescribed = np.concatenate([[quads], np.full(spokes, 2)])
    free = np.full(len(t.twin), -1)
    jumps = np.zeros(len(t.twin), dtype=np.int64)
    matching = Matching(WorkingTriangulation.of(t), jumps, free, sector, prescribed)
    return SeamlessMap(matching, np.stack([z.real, z.imag], axis=2), 0.0)


@pytest.mark.parametrize(("quads", "turns"), [(4, 4), (4, 8), (3, 7), (5, 5), (8, 4)])
def test_upright_maps_may_wind_wrongly_around_a_vertex(quads: int, turns: int) -> None:
    map_ = around(quads, 24, turns)
    assert len(map_.inverted) == 0
    assert (0 in map_.wrong_windings) == (quads != turns)


def test_quads_of_sectors_add_up_to_valences_and_corners() -> None:
    surface = annulus(inner=0.4, n=48)
    places = [surface.closest_point(place) for place in ([0.8, 0, 0], [0, 0.6, 0])]
    singularities = [Singularity(places[0], 3), Singularity(places[1], 5)]
    start = aligned_field(prepare(surface, singularities))
    matching = Matching.of(start.integrability)
    valence = np.bincount(matching.vertex, matching.quads)
    prepared = start.prepared
    t = matching.triangulation
    expected = np.full(t.n_vertices, 4)
    expected[t.tail[t.boundary_halfedges]] = 2
    for s in prepared.singularities:
        expected[prepared.surface.nearest_vertex(s.point)] = s.valence
    assert_array_equal(valence, expected)
    assert_array_equal(seamless_map(run(anisotropic_field(start))).wrong_windings, [])


def test_features_part_vertices_into_sectors_and_are_axes() -> None:
    surface = square(n=4, size=2.0)
    on_axis = (surface.vertices[surface.edges][:, :, 1] == 0).all(axis=1)
    features = Features(surface, np.flatnonzero(on_axis))
    start = aligned_field(prepare(surface, features=features))
    matching = Matching.of(start.integrability)
    assert_array_equal(np.bincount(matching.vertex)[[12, 13]], 2)
    assert_array_equal(matching.quads[np.isin(matching.vertex, [12, 13])], 2)
    images = seamless_map(IntegratedField(start, start.start)).images.reshape(-1, 2)
    across = images[matching.aligned, (matching.axes[matching.aligned] + 1) % 2]
    assert np.abs(across).max() < 1e-12


def test_images_of_other_matchings_wind_wrongly() -> None:
    map_ = around(4, 12, 4)
    quads = map_.matching.quads.copy()
    quads[0] = 5
    other = replace(map_, matching=replace(map_.matching, quads=quads))
    assert_array_equal(other.wrong_windings, [0])
