"""Traces along the boundary from corners that point inwards: what misses those crosses these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from solvers.layouts.charts import QUARTER, Chart
from solvers.layouts.nodes import Node
from solvers.layouts.tracing import Chords, Traces
from solvers.triangulation import IntArray, next_halfedge


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
    pieces, offsets = [traces.chords], list(traces.offsets)
    for loop, tail in zip(loops, tails, strict=True):
        for at in np.flatnonzero(np.isin(tail, list(reentrant))):
            for backwards in (False, True):
                along = np.roll(loop[::-1], at) if backwards else np.roll(loop, -at)
                piece = _rim(chart, along, backwards, len(offsets) - 1)
                pieces.append(piece)
                offsets.append(offsets[-1] + len(piece))
    columns = zip(*(vars(piece).values() for piece in pieces), strict=True)
    chords = Chords(*(np.concatenate(column) for column in columns))
    return replace(traces, chords=chords, offsets=np.array(offsets))


def _rim(chart: Chart, loop: IntArray, backwards: bool, number: int) -> Chords:
    """Return the chords along boundary halfedges, as far as a typical edge is long."""
    length = np.abs(chart.images.reshape(-1)[loop])
    ends = np.cumsum(length)
    n = int(np.searchsorted(ends, chart.edge_length)) + 1
    loop, ends, length = loop[:n], ends[:n], length[:n]
    axis = np.rint(np.angle(chart.images.reshape(-1)[loop]) / QUARTER).astype(np.int64)
    tail, head = loop % 3, next_halfedge(loop) % 3
    start, end = (head, tail) if backwards else (tail, head)
    zero, corner = np.zeros(len(loop)), np.ones(len(loop), dtype=bool)
    return Chords(
        np.full(len(loop), number),
        loop // 3,
        (axis + 2 * backwards) % 4,
        start,
        zero,
        corner,
        end,
        zero,
        corner,
        ends - length,
        ends,
    )
