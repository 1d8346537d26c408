"""Tracing curves along the cross, triangle by triangle, all of them in step.

Every triangle has a plane image in which its cross is the axes; over an edge the image turns by
whole quarter turns. In a seamless map two triangles' images fit, so a trace is one straight line;
for any other field each triangle's own cross is followed.

Where a trace runs is decided by which side of it a corner lies on, a corner on it counting as left
of it: the same answer in every triangle, also where a trace runs along edges.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from solvers.layouts.charts import AXES, Chart, ComplexArray
from solvers.layouts.nodes import Node, Starts
from solvers.surface.triangulation import (
    BoolArray,
    FloatArray,
    IntArray,
)

NODE, BORDER, LENGTH = range(3)
"""How a trace ends: at a node, at the boundary, or for its length."""

GRAZING = 1e-3
"""Where on an edge, from its end, a trace leaves that the next cross does not let in.

A share of the edge's length. Chosen.
"""

NOTHING = np.empty((0, 2), dtype=np.int64)
"""No trace runs past a node that it meets."""


@dataclass(frozen=True, eq=False)
class Chords:
    """Pieces of traces, one in each triangle they run through.

    Parameters
    ----------
    trace, face, axis : (c,) int arrays
        The trace, the triangle, and the direction there in quarter turns.
    side_in, side_out : (c,) int arrays
        Side of the triangle where a chord enters and leaves, or the corner if it is one.
    t_in, t_out : (c,) float arrays
        How far along that side, 0 to 1.
    corner_in, corner_out : (c,) bool arrays
        Whether it is a corner.
    start, end : (c,) float arrays
        Length of the trace in the map where the chord enters and leaves.
    """

    trace: IntArray
    face: IntArray
    axis: IntArray
    side_in: IntArray
    t_in: FloatArray
    corner_in: BoolArray
    side_out: IntArray
    t_out: FloatArray
    corner_out: BoolArray
    start: FloatArray
    end: FloatArray

    def __len__(self) -> int:
        return len(self.trace)

    @classmethod
    def joined(cls, pieces: Sequence[Chords]) -> Chords:
        """Return the chords of all pieces, one after the other."""
        columns = zip(*(piece._columns() for piece in pieces), strict=True)
        return cls(*(np.concatenate(column) for column in columns))

    def _columns(self) -> list[Any]:
        return [getattr(self, column.name) for column in fields(self)]

    def __getitem__(self, chosen: IntArray | BoolArray) -> Chords:
        return Chords(*(values[chosen] for values in self._columns()))


@dataclass(frozen=True, eq=False)
class Traces:
    """Curves along the cross.

    Parameters
    ----------
    chart : Chart
        The images.
    starts : Starts
        Where the traces start, k of them.
    chords : Chords
        Trace by trace, in order.
    offsets : (k + 1,) int array
        The chords of trace i are ``offsets[i]`` to ``offsets[i + 1]``.
    ends : (k,) int array
        `NODE`, `BORDER` or `LENGTH`.
    end_node, end_slot : (k,) int arrays
        The node where a trace ends and the direction there that leads back; -1 elsewhere.
    """

    chart: Chart
    starts: Starts
    chords: Chords
    offsets: IntArray
    ends: IntArray
    end_node: IntArray
    end_slot: IntArray

    @cached_property
    def leading_back(self) -> IntArray:
        """(k,) the trace that leaves where each ends, the other way; -1 where there is none."""
        most = 1 + max(self.starts.slot.max(initial=0), self.end_slot.max(initial=0))
        left, met = (
            node * most + slot
            for node, slot in ((self.starts.node, self.starts.slot), (self.end_node, self.end_slot))
        )
        order = np.argsort(left)
        at = order[np.minimum(np.searchsorted(left[order], met), len(order) - 1)]
        return np.where((self.ends == NODE) & (left[at] == met), at, -1)

    @property
    def lengths(self) -> FloatArray:
        """(k,) length of each trace in the map."""
        return self.chords.end[self.offsets[1:] - 1]


def trace(
    chart: Chart,
    nodes: Sequence[Node],
    starts: Starts,
    tolerance: float | FloatArray,
    longest: float,
    past: IntArray = NOTHING,
) -> Traces:
    """Trace curves until they meet a node or the boundary, or have become too long.

    Parameters
    ----------
    chart : Chart
        The images.
    nodes : sequence of Node
        Where traces start, and end.
    starts : Starts
        Of the traces.
    tolerance : float or (N,) float array
        How far beside each node, in the map, a trace still meets it.
    longest : float
        Length in the map beyond which a trace is given up.
    past : (p, 2) int array, optional
        Traces, and nodes that they run past, however close.

    Returns
    -------
    Traces
    """
    walk = _Walk(chart, nodes, tolerance, past)
    t = chart.triangulation
    k = len(starts.halfedge)
    ends = np.full(k, LENGTH)
    records = [walk.first(starts)]
    for _ in range(int(60 * np.sqrt(t.n_faces)) + 1000):
        last = records[-1]
        h = 3 * last.face + last.side_out
        border = ~last.corner_out & (t.twin[h] < 0)
        ends[last.trace[last.corner_out]] = NODE
        ends[last.trace[border]] = BORDER
        going = ~last.corner_out & ~border & (last.end < longest)
        if not going.any():
            break
        records.append(walk.next(last[going]))
    joined = Chords.joined(records)
    chords = joined[np.argsort(joined.trace, kind="stable")]
    offsets = np.searchsorted(chords.trace, np.arange(k + 1))
    end_node, end_slot = walk.arrivals(chords, offsets, ends)
    return Traces(chart, starts, chords, offsets, ends, end_node, end_slot)


class _Walk:
    """Steps of many traces from one triangle to the next."""

    def __init__(
        self,
        chart: Chart,
        nodes: Sequence[Node],
        tolerance: float | FloatArray,
        past: IntArray,
    ) -> None:
        self._chart = chart
        self._nodes = nodes
        self._node_of = np.full(chart.triangulation.n_vertices, -1, dtype=np.int64)
        for number, node in enumerate(nodes):
            self._node_of[node.vertex] = number
        self._tolerance = np.zeros(len(self._node_of))
        self._tolerance[[node.vertex for node in nodes]] = tolerance
        self._past = past @ [len(nodes), 1]

    def first(self, starts: Starts) -> Chords:
        """Return the chords from corners."""
        k = len(starts.halfedge)
        face, corner = starts.halfedge // 3, starts.halfedge % 3
        at = self._chart.corners[face, corner]
        zero = np.zeros(k)
        return self._chords(np.arange(k), face, starts.axis, corner, zero, at, zero, True)

    def next(self, last: Chords) -> Chords:
        """Return the chords that follow others over the sides where they leave."""
        chart = self._chart
        h = 3 * last.face + last.side_out
        g = chart.triangulation.twin[h]
        face, side, t = g // 3, g % 3, 1 - last.t_out
        axis = (last.axis + chart.period_jumps[h]) % 4
        tail, head = chart.corners[face, side], chart.corners[face, (side + 1) % 3]
        place = tail + t * (head - tail)
        return self._chords(last.trace, face, axis, side, t, place, last.end, False)

    def _chords(
        self,
        trace: IntArray,
        face: IntArray,
        axis: IntArray,
        side: IntArray,
        t: FloatArray,
        place: ComplexArray,
        start: FloatArray,
        from_corner: bool,
    ) -> Chords:
        """Return the chords from a place on a side, or from the corner `side`, along an axis."""
        rows = np.arange(len(face))
        corners = self._chart.corners[face]
        # Ahead along the trace, and to its left.
        seen = (corners - place[:, None]) * AXES[axis].conj()[:, None]
        apex = (side + 2) % 3
        apex_right = np.zeros(len(face), dtype=bool) if from_corner else seen[rows, apex].imag < 0
        # A trace leaves over the side from `right` to `left`, the corners on either side of it.
        right = np.where(apex_right, apex, (side + 1) % 3)
        left = apex if from_corner else np.where(apex_right, side, apex)
        low, high = seen[rows, right].imag, seen[rows, left].imag
        out = np.clip(low / np.where(low == high, -1.0, low - high), 0.0, 1.0)
        side_out = right
        corner_out = np.zeros(len(face), dtype=bool)
        if not from_corner:
            side_out, out = self._let_in(seen, rows, side, side_out, out)
        for corner in [right, left] if from_corner else [apex]:
            there = seen[rows, corner]
            vertex = self._chart.triangulation.faces[face, corner]
            node = self._node_of[vertex]
            target = (node >= 0) & (np.abs(there.imag) <= self._tolerance[vertex])
            target &= (there.real > 0) & ~np.isin(trace * len(self._nodes) + node, self._past)
            corner_out |= target
            side_out = np.where(target, corner, side_out)
            out = np.where(target, 0.0, out)
        tail, head = corners[rows, side_out], corners[rows, (side_out + 1) % 3]
        ahead = ((tail + out * (head - tail) - place) * AXES[axis].conj()).real
        return Chords(
            trace,
            face,
            axis,
            side,
            t,
            np.full(len(face), from_corner),
            side_out,
            out,
            corner_out,
            start,
            start + np.maximum(ahead, 0.0),
        )

    def _let_in(
        self,
        seen: ComplexArray,
        rows: IntArray,
        side: IntArray,
        side_out: IntArray,
        out: FloatArray,
    ) -> tuple[IntArray, FloatArray]:
        """Lead traces that the next cross sends back along the side they came over."""
        after = (side + 1) % 3
        along = seen[rows, after] - seen[rows, side]
        # A trace along the side itself may come in either way.
        outwards = along.imag > 1e-9 * np.abs(along)
        forwards = along.real > 0
        side_out = np.where(outwards, np.where(forwards, after, (side + 2) % 3), side_out)
        out = np.where(outwards, np.where(forwards, GRAZING, 1 - GRAZING), out)
        return side_out, out

    def arrivals(
        self, chords: Chords, offsets: IntArray, ends: IntArray
    ) -> tuple[IntArray, IntArray]:
        """Return at which node traces end, and the direction there that leads back."""
        chart = self._chart
        node, slot = np.full(len(ends), -1), np.full(len(ends), -1)
        last = chords[offsets[1:] - 1]
        for i in np.flatnonzero(ends == NODE):
            h = 3 * last.face[i] + last.side_out[i]
            node[i] = self._node_of[chart.triangulation.tail[h]]
            back = AXES[(last.axis[i] + 2) % 4] / chart.images.reshape(-1)[h]
            slot[i] = self._nodes[node[i]].slot_of(h, float(np.angle(back)))
        return node, slot
