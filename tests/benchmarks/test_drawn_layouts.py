"""Layouts of configurations that were once refused one."""

import numpy as np

from benchmarks.map_configurations import Drawn
from crossview.workflow.layout import layout
from crossview.workflow.pipeline import Pipeline
from solvers.progress import run


def test_sizes_over_ten_powers_of_ten_leave_rectangles() -> None:
    """Two of valence 12 and 9 in a plate with a hole: a millionth of its typical edge is wide."""
    solution = run(Pipeline().solve(Drawn("plate", 1).problem()))
    made = run(layout(solution))
    tmesh, chart = made.tmesh, made.arrangement.curves.chart
    edges = np.abs(chart.images)
    assert edges.max() > 1e10 * edges.min()
    assert tmesh.n_nodes - tmesh.n_arcs + tmesh.n_rectangles == made.surface.euler_characteristic
    sides = tmesh.side_totals(tmesh.lengths)
    np.testing.assert_allclose(sides[:, :2], sides[:, 2:], rtol=1e-6, atol=1e-9 * sides.max())
    np.testing.assert_allclose(tmesh.area, chart.area, rtol=1e-8)
