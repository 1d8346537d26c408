"""Separatrices that nearly meet a singularity, and the map in which they do.

A trace that passes a node closer than the mesh resolves is taken to mean it: that its node and the
one it passes lie on one line of the map becomes a condition on the map. So it does where a trace
ends at a node that lies off it by more than rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array

from solvers.layouts.charts import AXES, ComplexArray
from solvers.layouts.crossings import Crossings, ends_of
from solvers.layouts.motorcycles import doubled
from solvers.layouts.tracing import NODE, Traces
from solvers.surface.triangulation import FloatArray, IntArray

NEAR = 0.02
"""Nodes this much off a line, of its length, are put on it, if the mesh does not resolve that.
Chosen: about a degree.
"""

ACCIDENT = 0.2
"""Nodes that would be as near to a line by accident, on average: with more nothing is put on it.
Chosen.
"""

ROUNDING = 1e-9
"""How far beside its end a trace may run for nothing but rounding, in typical edges of the map.
Chosen, far above it.
"""


def passing(traces: Traces, crossings: Crossings, n_nodes: int) -> IntArray:
    """Return the first node that each trace passes too closely.

    Parameters
    ----------
    traces, crossings
        The traces, those of `with_rims` too, and where they cross.
    n_nodes : int
        Number of nodes they leave.

    Returns
    -------
    (p, 2) int array
        Where a trace meets one that leaves the node at right angles: the chords of both. The
        least accidental come first; most that mean the same line are left out.
    """
    both = [crossings, crossings.exchanged]
    chord = np.concatenate([c.chord for c in both])
    trace = np.concatenate([c.trace for c in both])
    at = np.concatenate([c.at for c in both])
    chart = traces.chart
    # In the strip around a trace there are this many nodes by accident.
    accident = 2 * at[:, 0] * at[:, 1] * n_nodes / chart.area
    close = (at[:, 1] < np.minimum(NEAR * at[:, 0], chart.edge_length)) & (accident < ACCIDENT)
    close &= trace[:, 0] < len(traces.ends)
    order = np.flatnonzero(close)[np.lexsort((at[close, 0], trace[close, 0]))]
    first = order[np.unique(trace[order, 0], return_index=True)[1]]
    first = first[np.argsort(accident[first], kind="stable")]
    return chord[first[_one_way(traces, trace[first], at[first, 0])]]


def _one_way(traces: Traces, trace: IntArray, length: FloatArray) -> IntArray:
    """Return which passings (p, 2) to keep: of two that tell of one line both ways, the first."""
    node = np.append(traces.starts.node, -1)[np.minimum(trace, len(traces.ends))]
    steps = np.rint(2 * length / traces.chart.edge_length).astype(np.int64)
    lines = np.column_stack([node.min(axis=1), node.max(axis=1), steps])
    return np.sort(np.unique(lines, axis=0, return_index=True)[1])


def beside(traces: Traces) -> IntArray:
    """Return the last chords (e,) of traces that end at a node but run beside it, each line once.

    Parameters
    ----------
    traces : Traces
        The traces.
    """
    chart, chords = traces.chart, traces.chords
    last = (traces.offsets[1:] - 1)[(traces.ends == NODE) & ~doubled(traces)]
    final = chords[last]
    enters, leaves = ends_of(chart, final)
    off = ((leaves - enters) * AXES[final.axis].conj()).imag
    return np.asarray(last[np.abs(off) > ROUNDING * chart.edge_length])


def conditions(traces: Traces, passed: IntArray) -> csr_array:
    """Return the rows (p, 6 m) that take the passed nodes onto the traces.

    Parameters
    ----------
    traces : Traces
        In the map.
    passed : (p, 2) int array
        What passes what, as `passing` returns it.

    Returns
    -------
    sparse array
        Coefficients of the components of images: the offsets of the nodes from the traces.
    """
    ways = [way_between(traces, pair) for pair in passed]
    return _offsets_across(traces, [(way.halfedge, way.factor) for way in ways])


@dataclass(frozen=True, eq=False)
class Way:
    """Halfedges whose images lead from a node along its trace, and back along another, to a node.

    Parameters
    ----------
    halfedge : (s,) int array
        In the order of the way.
    factor : (s,) complex array
        What their images are multiplied with, to be in the frame along the first trace.
    along : (s,) complex array
        What any vector's image in their triangles is multiplied with to be in that frame.
    """

    halfedge: IntArray
    factor: ComplexArray
    along: ComplexArray


def way_between(traces: Traces, pair: IntArray) -> Way:
    """Return the way between two nodes.

    Parameters
    ----------
    traces : Traces
        In any map.
    pair : (2,) int array
        The chords of two traces that cross.
    """
    a, b = pair
    axis, face = traces.chords.axis, traces.chords.face
    over, back = _corner_steps(traces, a), _corner_steps(traces, b)
    between = _steps(_reference(traces, a), _reference(traces, b))
    turned = AXES[axis[b]] / AXES[axis[a]]
    here = np.full(len(between[0]), AXES[axis[a]].conj())
    return Way(
        np.concatenate([over[0], 3 * face[a] + between[0], back[0][::-1]]),
        np.concatenate([over[1], between[1] * here, -turned * back[1][::-1]]),
        np.concatenate([over[2], here, turned * back[2][::-1]]),
    )


def ending(traces: Traces, last: IntArray) -> csr_array:
    """Return the rows (e, 6 m) that take the nodes where traces end onto them.

    Parameters
    ----------
    traces : Traces
        In the map.
    last : (e,) int array
        The last chords of the traces, as `beside` returns them.

    Returns
    -------
    sparse array
        As `conditions`.
    """
    chords = traces.chords
    ways = []
    for a in last:
        over = _corner_steps(traces, a)
        on = _steps(_reference(traces, a), int(chords.side_out[a]))
        halfedge = np.concatenate([over[0], 3 * chords.face[a] + on[0]])
        ways.append((halfedge, np.concatenate([over[1], on[1] / AXES[chords.axis[a]]])))
    return _offsets_across(traces, ways)


def _offsets_across(traces: Traces, ways: list[tuple[IntArray, ComplexArray]]) -> csr_array:
    """Return rows whose products with the images are the parts of ways across their traces."""
    rows, columns, values = [], [], []
    for number, (halfedge, factor) in enumerate(ways):
        # Across the trace: the imaginary part of factor times image.
        rows.append(np.full(2 * len(halfedge), number))
        columns.append(np.stack([2 * halfedge, 2 * halfedge + 1], axis=1).reshape(-1))
        values.append(np.stack([factor.imag, factor.real], axis=1).reshape(-1))
    shape = (len(ways), 6 * traces.chart.triangulation.n_faces)
    if not rows:
        return csr_array(shape)
    indices = (np.concatenate(rows), np.concatenate(columns))
    return csr_array(coo_array((np.concatenate(values), indices), shape=shape))


def _corner_steps(traces: Traces, last: int) -> tuple[IntArray, ComplexArray, ComplexArray]:
    """Return halfedges and factors that sum to the way from a node to a chord's triangle.

    To the corner left of where the trace enters it, in the frame along the trace; last what takes
    any image in their triangles to that frame.
    """
    first = int(traces.offsets[traces.chords.trace[last]])
    chords = traces.chords[np.arange(first, last)]
    start, end = chords.side_in, (chords.side_out + ~chords.corner_out) % 3
    forward, backward = end == (start + 1) % 3, start == (end + 1) % 3
    along = AXES[chords.axis].conj()
    moving = forward | backward
    halfedge = 3 * chords.face + np.where(forward, start, end)
    factor = np.where(forward, along, -along)
    return halfedge[moving], factor[moving], along[moving]


def _reference(traces: Traces, chord: int) -> int:
    """Return the corner of a chord's triangle left of where the trace enters it, or starts."""
    return int(traces.chords.side_in[chord])


def _steps(start: int, end: int) -> tuple[IntArray, ComplexArray]:
    """Return sides of a triangle and signs that sum to the way from one corner to another."""
    if start == end:
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=complex)
    if end == (start + 1) % 3:
        return np.array([start]), np.array([1.0 + 0j])
    return np.array([end]), np.array([-1.0 + 0j])
