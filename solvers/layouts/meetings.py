"""Traces that end at nodes only where two meet: each where the other starts, against it.

One that comes within rounding of a node that does not lead back to it would end there alone, and
lie on the other's way from then on. It runs past instead.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solvers.layouts.charts import Chart
from solvers.layouts.nodes import Node, starts_at
from solvers.layouts.tracing import NODE, NOTHING, Traces, trace
from solvers.surface.triangulation import FloatArray, IntArray

EXACT = 1e-6
"""How far beside a node a trace meets it, in edges of the map there. Chosen, above rounding."""


def meeting_traces(chart: Chart, nodes: Sequence[Node], longest: float) -> Traces:
    """Trace curves from nodes until two meet, or one comes to the boundary or is too long.

    Parameters
    ----------
    chart : Chart
        A seamless map.
    nodes : sequence of Node
        Where traces start, and end.
    longest : float
        Length in the map beyond which a trace is given up.
    """
    starts, past = starts_at(chart, nodes), NOTHING
    while True:
        traces = trace(chart, nodes, starts, EXACT * _edges_at(chart, nodes), longest, past)
        alone = _ending_alone(traces)
        if not len(alone):
            return traces
        past = np.concatenate([past, np.column_stack([alone, traces.end_node[alone]])])


def _ending_alone(traces: Traces) -> IntArray:
    """Return the traces that end at a node from which none leads back to where they start."""
    back = traces.leading_back
    alone = back[back] != np.arange(len(back))
    return np.flatnonzero((traces.ends == NODE) & ((back < 0) | alone))


def _edges_at(chart: Chart, nodes: Sequence[Node]) -> FloatArray:
    """Return the length (N,) of the shortest edge's image at each node, at most a typical one."""
    images = np.abs(chart.images.reshape(-1))
    return np.array([min(images[node.ring].min(), chart.edge_length) for node in nodes])
