"""Traces along the boundary from corners that point inwards: what misses those crosses these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from solvers.layouts.curves import along_edges
from solvers.layouts.nodes import Node
from solvers.layouts.tracing import Chords, Traces
from solvers.surface.triangulation import IntArray


def with_rims(traces: Traces, nodes: Sequence[Node], loops: Sequence[IntArray]) -> Traces:
    """Return the traces, and further ones along the boundary from corners that point inwards.

    Traces that miss such a corner cross them at the boundary.

    Parameters
    ----------
    traces : Traces
        From the nodes.
    nodes : sequence of Node
        Some of them corners.
    loops : sequence of (k,) int array
        Halfedges of the boundary loops.
    """
    chart = traces.chart
    tails = [chart.triangulation.tail[loop] for loop in loops]
    reentrant = {node.vertex for node in nodes if not node.inner and node.quads > 2}
    if not reentrant:
        return traces
    pieces, offsets = [traces.chords], list(traces.offsets)
    for loop, tail in zip(loops, tails, strict=True):
        for at in np.flatnonzero(np.isin(tail, list(reentrant))):
            for backwards in (False, True):
                along = np.roll(loop[::-1], at) if backwards else np.roll(loop, -at)
                # as far as a typical edge is long
                far = np.cumsum(np.abs(chart.images.reshape(-1)[along]))
                along = along[: int(np.searchsorted(far, chart.edge_length)) + 1]
                piece = along_edges(chart, along, len(offsets) - 1, backwards=backwards)
                pieces.append(piece)
                offsets.append(offsets[-1] + len(piece))
    return replace(traces, chords=Chords.joined(pieces), offsets=np.array(offsets))
