"""Sectors between marked edges."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_allclose

from solvers.primitives import sphere
from solvers.surface import corner_sectors


def test_marked_edges_part_the_angles_around_a_vertex() -> None:
    t = sphere(subdivisions=1).triangulation
    marked = np.zeros(len(t.twin), dtype=bool)
    chosen = np.flatnonzero(t.tail == 0)[[0, 2]]  # two edges of one vertex
    marked[chosen] = marked[t.twin[chosen]] = True
    sector = corner_sectors(t, marked)
    vertex = np.empty(sector.max() + 1, dtype=np.int64)
    vertex[sector] = t.tail
    counts = np.bincount(vertex)
    assert counts[0] == 2
    assert set(counts[1:]) == {1}
    angle = np.bincount(sector, t.angles.reshape(-1))
    assert_allclose(angle[vertex == 0].sum(), 2 * np.pi - t.curvatures[0])
