"""Flips and splits of too flat triangles change neither the surface nor the metric of images."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_allclose

from solvers.features import Features
from solvers.fields import aligned_field, prepare
from solvers.maps.flatness import Flatness
from solvers.maps.image_lengths import FLAT, ImageLengths
from solvers.maps.matching import FREE, Matching
from solvers.primitives import square
from solvers.surface.triangulation import next_halfedge, previous_halfedge


def flattened() -> tuple[Matching, ImageLengths]:
    """A square with a line across, and images with 177 degrees opposite edges of both kinds."""
    surface = square(n=6)
    middle = surface.vertices[surface.edges][:, :, 1]
    line = Features(surface, np.flatnonzero((np.abs(middle) < 1e-9).all(axis=1)))
    aligned = aligned_field(prepare(surface, features=line, refine=0))
    matching = Matching.of(aligned.integrability)
    t = matching.triangulation
    x = np.log(t.lengths.reshape(-1))
    inner = np.flatnonzero((matching.axes != FREE) & (t.twin > np.arange(len(t.twin))))
    for h in (t.boundary_halfedges[0], inner[1], inner[4]):
        two = np.exp(x[[next_halfedge(h), previous_halfedge(h)]])
        opposite = np.sqrt((two**2).sum() - 2 * two.prod() * np.cos(np.radians(177)))
        x[h] = np.log(opposite)
        if t.twin[h] >= 0:
            x[t.twin[h]] = x[h]
    return matching, ImageLengths(matching, x, aligned.integrability.theta)


def test_splits_keep_both_metrics_and_what_is_off() -> None:
    matching, lengths = flattened()
    before = lengths.target()
    off = Flatness(lengths, before).off(before)
    while lengths.split_flat():
        pass
    after, found = lengths.target(), lengths.matching()
    new = after.n_vertices - before.n_vertices
    assert new >= 3
    assert after.angles.max() < FLAT
    assert_allclose(after.areas.sum(), before.areas.sum(), rtol=1e-9)
    assert_allclose(found.triangulation.areas.sum(), matching.triangulation.areas.sum(), rtol=1e-12)
    left = Flatness(lengths, after).off(after)
    assert_allclose(np.linalg.norm(left), np.linalg.norm(off), rtol=1e-6)
    # a new vertex is regular: two quads on each side of what is aligned, four where nothing is
    here = found.vertex >= before.n_vertices
    around = np.bincount(found.vertex[here] - before.n_vertices, found.quads[here])
    on_boundary = np.isin(
        np.arange(before.n_vertices, after.n_vertices), after.tail[after.boundary_halfedges]
    )
    assert_allclose(around, np.where(on_boundary, 2, 4))


def test_what_is_split_is_limited() -> None:
    _, lengths = flattened()
    n = lengths.target().n_faces
    while lengths.split_flat(np.radians(89)):
        pass
    assert lengths.target().n_faces < 1.3 * n
