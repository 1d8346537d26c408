"""What becomes one where arcs get no edges: counted by hand, and by Euler's formula."""

import numpy as np
import pytest

from solvers.layouts.tmesh import TMesh
from solvers.quads.merged import merged
from tests.solvers.quads.tilings import cube, tiling, torus


def test_a_row_of_squares_without_edges_is_one_segment() -> None:
    t = tiling([(k, 0, k + 1, 1) for k in range(4)])
    upright = np.array([_upright(t, arc) for arc in range(t.n_arcs)])
    vertices, edges = merged(t, np.where(upright, 3, 0))
    assert [len(piece) for piece in vertices.groups] == [5] * 4  # one of each of five uprights
    assert [len(piece) for piece in edges.groups] == [5] * 3
    # Bottom and top lie along the boundary; what is between joins its left to its right.
    assert len(vertices.torn) == 2
    assert len(edges.torn) == 3


def _upright(t: TMesh, arc: int) -> bool:
    """Whether an arc is side 1 or 3 of its rectangles: upright in a row."""
    sides = np.repeat(np.arange(4 * t.n_rectangles), np.diff(t.side_offsets))
    return bool((sides[t.side_halfarcs // 2 == arc] % 2 == 1).all())


@pytest.mark.parametrize("t", [cube(), torus()], ids=["cube", "torus"])
@pytest.mark.parametrize("edges_each", [1, 2, 3])
def test_nothing_merges_where_every_arc_has_an_edge(t: TMesh, edges_each: int) -> None:
    vertices, edges = merged(t, np.full(t.n_arcs, edges_each))
    inner = t.n_rectangles * (edges_each - 1) ** 2
    quads = t.n_rectangles * edges_each**2
    # Vertices and edges along arcs alone: those inside rectangles are known.
    characteristic = vertices.count + inner - 2 * quads + quads
    assert characteristic == t.n_nodes - t.n_arcs + t.n_rectangles
    assert edges.count == t.n_arcs * edges_each
    assert all(len(piece) == 1 for points in (vertices, edges) for piece in points.groups)


def test_a_closed_ring_that_vanishes_is_torn() -> None:
    t = torus()
    vertices, _ = merged(t, np.zeros(t.n_arcs, dtype=np.int64))
    assert vertices.count == 1
    assert vertices.torn.tolist() == [0]
