"""Which curves are released first: those where the map fails, and of these the least."""

import numpy as np

from solvers.features.edges import no_features
from solvers.fields.aligned import IntegratedField, aligned_field
from solvers.fields.prepared import prepare
from solvers.maps.closed_images import SeamlessMap
from solvers.maps.release import by_release
from solvers.maps.seamless import seamless_map
from solvers.primitives import BUILTIN
from solvers.surface.edge_paths import EdgePaths
from solvers.surface.triangulation import IntArray
from solvers.surface.trisurface import TriSurface

N = 8
"""Cells of the square along each side."""


def row(surface: TriSurface, number: int, first: int = 0, last: int = N) -> np.ndarray:
    """The edges of a row of the square's vertices, from one column to another."""
    return EdgePaths(surface).through(np.arange(first, last + 1) + number * (N + 1))


def followed(surface: TriSurface, *curves: np.ndarray) -> IntegratedField:
    features = no_features(surface).united(np.concatenate(curves))
    aligned = aligned_field(prepare(surface, refine=0, features=features))
    assert len(aligned.features) == len(features)
    return IntegratedField(aligned, aligned.start)


def rows(field: IntegratedField, order: tuple[IntArray, ...]) -> list[int]:
    """The row of vertices that each curve runs along."""
    surface = field.aligned.prepared.surface
    heights = [np.unique(surface.vertices[surface.edges[edges]][:, :, 1]) for edges in order]
    assert all(len(height) == 1 for height in heights)
    lowest, highest = surface.vertices[:, 1].min(), surface.vertices[:, 1].max()
    return [round(N * (float(height[0]) - lowest) / (highest - lowest)) for height in heights]


def test_curves_beside_the_piece_that_fails_come_first() -> None:
    """Three rows in a square, one triangle turned over below them all: the lowest bounds it."""
    surface = BUILTIN["square"](n=N)
    lowest, middle, short = row(surface, 2), row(surface, 4), row(surface, 6, last=3)
    field = followed(surface, lowest, middle, short)
    found = seamless_map(field)
    t = found.matching.triangulation
    below = np.flatnonzero((t.faces < 2 * (N + 1)).all(axis=1))[0]
    images = found.images.copy()
    images[below, :, 0] *= -1
    order = by_release(field, SeamlessMap(found.matching, images, found.distance))
    assert rows(field, order) == [2, 6, 4]


def test_of_two_equal_curves_that_with_a_free_end_goes_first() -> None:
    surface = BUILTIN["square"](n=N)
    across, loose = row(surface, 2), row(surface, 6, last=N - 1)
    field = followed(surface, across, loose)
    assert rows(field, by_release(field)) == [6, 2]
