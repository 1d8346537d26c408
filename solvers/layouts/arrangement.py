"""The T-mesh that traces and boundary loops cut a surface into."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from solvers.layouts.crossings import Crossings
from solvers.layouts.curves import Curves, boundary_halfedges, with_loops
from solvers.layouts.motorcycles import WHOLE, Stops, left_of
from solvers.layouts.nodes import Node
from solvers.layouts.pieces import as_sides, cycles
from solvers.layouts.tmesh import TMesh
from solvers.layouts.tracing import NODE, Traces
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray
from solvers.surface.trisurface import TriSurface


@dataclass(frozen=True, eq=False)
class Arrangement:
    """A T-mesh and where its arcs lie.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    curves : Curves
        What the arcs are parts of.
    n_traces : int
        How many of the curves are traces; the others are boundary loops.
    arc_curve : (A,) int array
        The curve each arc is part of.
    arc_span : (A, 2) float array
        From where to where along it, in the map.
    node_curve : (N,) int array
        A curve through each node.
    node_at : (N,) float array
        Where along it.
    t_junctions : (t,) int array
        Nodes where a trace was cut.
    """

    tmesh: TMesh
    curves: Curves
    n_traces: int
    arc_curve: IntArray
    arc_span: FloatArray
    node_curve: IntArray
    node_at: FloatArray
    t_junctions: IntArray


@dataclass(frozen=True, order=True)
class _Station:
    """A node on a curve, in order along it, and the node's slots of the ways back and on."""

    order: tuple[float, ...]
    at: float
    node: int
    back: int
    onwards: int


class _Builder:
    """Nodes with their slots, and arcs between them, while they are put together."""

    def __init__(self) -> None:
        self.quads: list[int] = []
        self.inner: list[bool] = []
        self.curve: list[int] = []
        self.at: list[float] = []
        self.arcs: list[tuple[int, int, int, int]] = []  # node and slot at both ends
        self.arc_curve: list[int] = []
        self.span: list[tuple[float, float]] = []

    def node(self, quads: int, inner: bool, curve: int, at: float) -> int:
        self.quads.append(quads)
        self.inner.append(inner)
        self.curve.append(curve)
        self.at.append(at)
        return len(self.quads) - 1

    def chain(self, curve: int, stations: list[_Station]) -> None:
        """Add arcs between stations in their order."""
        for one, other in pairwise(stations):
            self.arcs.append((one.node, one.onwards, other.node, other.back))
            self.arc_curve.append(curve)
            self.span.append((one.at, max(one.at, other.at)))


def arrange(
    surface: TriSurface,
    nodes: Sequence[Node],
    critical: BoolArray,
    traces: Traces,
    crossings: Crossings,
    stopped: Stops,
) -> Arrangement:
    """Cut a surface along traces and its boundary.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    nodes : sequence of Node
        Where the traces start.
    critical : (N,) bool array
        Which of them are singularities or corners.
    traces, crossings, stopped
        The traces, where they cross and how far they are kept.

    Raises
    ------
    LayoutError
        If a piece is not a rectangle.
    """
    loops = boundary_halfedges(traces.chart, surface)
    curves = with_loops(traces, loops)
    build = _Builder()
    for node in nodes:
        build.node(node.quads, node.inner, -1, 0.0)
    n_traces = len(traces.ends)
    stations: list[list[_Station]] = [[] for _ in curves.offsets[1:]]
    for i in np.flatnonzero(stopped.kept):
        start = int(traces.starts.node[i])
        stations[i].append(_Station((-1,), 0.0, start, -1, int(traces.starts.slot[i])))
        build.curve[start], build.at[start] = int(i), 0.0
    t_junctions = _add_crossings(build, stations, traces, crossings, stopped)
    _add_ends(build, stations, curves, traces, stopped, n_traces, loops)
    _add_corners(build, stations, curves, nodes, n_traces, loops)
    for curve, on_curve in enumerate(stations):
        on_curve.sort()
        if curve >= n_traces and on_curve:
            first, length = on_curve[0], curves.chords.end[curves.offsets[curve + 1] - 1]
            on_curve = [*on_curve, replace(first, at=first.at + length)]
        build.chain(curve, on_curve)
    return _finished(build, curves, nodes, critical, n_traces, t_junctions)


def _add_crossings(
    build: _Builder,
    stations: list[list[_Station]],
    traces: Traces,
    crossings: Crossings,
    stopped: Stops,
) -> IntArray:
    """Add a node for each crossing that is left; return those at which a trace is cut."""
    left = left_of(crossings, stopped)
    ending = []
    axes = traces.chords.axis[left.chord].tolist()
    columns = (c.tolist() for c in (left.trace, left.at, left.rank))
    for pair, at, rank, axis in zip(*columns, axes, strict=True):
        node = build.node(4, True, pair[0], at[0])
        for i, length, number, way in zip(pair, at, rank, axis, strict=True):
            stations[i].append(_Station((number,), length, node, (way + 2) % 4, way))
            if number == stopped.rank[i]:
                ending.append(node)
    return np.array(ending, dtype=np.int64)


def _add_ends(
    build: _Builder,
    stations: list[list[_Station]],
    curves: Curves,
    traces: Traces,
    stopped: Stops,
    n_traces: int,
    loops: Sequence[IntArray],
) -> None:
    """Add where traces end at nodes, or a node where they end at the boundary."""
    on_loop = {
        h: (curve, int(curves.offsets[curve]) + position)
        for curve, loop in enumerate(loops, start=n_traces)
        for position, h in enumerate(loop.tolist())
    }
    chords = curves.chords
    for i in np.flatnonzero(stopped.kept & ~stopped.cut):
        last = traces.offsets[i + 1] - 1
        length = float(chords.end[last])
        if traces.ends[i] == NODE:
            node, back = int(traces.end_node[i]), int(traces.end_slot[i])
            stations[i].append(_Station((WHOLE,), length, node, back, -1))
            build.curve[node], build.at[node] = int(i), length
            continue
        h = int(3 * chords.face[last] + chords.side_out[last])
        curve, chord = on_loop[h]
        size = chords.end[chord] - chords.start[chord]
        part = float(chords.t_out[last])
        at = float(chords.start[chord] + part * size)
        node = build.node(2, False, curve, at)
        stations[i].append(_Station((WHOLE,), length, node, 1, -1))
        stations[curve].append(_Station((chord, part, int(i)), at, node, 2, 0))


def _add_corners(
    build: _Builder,
    stations: list[list[_Station]],
    curves: Curves,
    nodes: Sequence[Node],
    n_traces: int,
    loops: Sequence[IntArray],
) -> None:
    """Add the nodes that lie on the boundary to their loops."""
    number = {node.vertex: i for i, node in enumerate(nodes) if not node.inner}
    tail = curves.chart.triangulation.tail
    for curve, loop in enumerate(loops, start=n_traces):
        start = curves.chords.start[curves.offsets[curve] : curves.offsets[curve + 1]]
        chords = range(curves.offsets[curve], curves.offsets[curve + 1])
        for chord, vertex, at in zip(chords, tail[loop].tolist(), start.tolist(), strict=True):
            if vertex in number:
                i = number[vertex]
                stations[curve].append(_Station((chord, -1), at, i, nodes[i].quads, 0))
                build.curve[i], build.at[i] = curve, at


def _finished(
    build: _Builder,
    curves: Curves,
    nodes: Sequence[Node],
    critical: BoolArray,
    n_traces: int,
    t_junctions: IntArray,
) -> Arrangement:
    arcs = np.array(build.arcs, dtype=np.int64).reshape(-1, 4)
    curve = np.array(build.arc_curve, dtype=np.int64)
    span = np.array(build.span, dtype=np.float64).reshape(-1, 2)
    inner = np.array(build.inner, dtype=bool)
    n = len(inner)
    around = cycles(arcs, curve >= n_traces, np.array(build.quads), inner)
    offsets, halfarcs = as_sides(around, curves, curve, span)
    tmesh = TMesh(
        arcs[:, [0, 2]],
        span[:, 1] - span[:, 0],
        curve >= n_traces,
        np.bincount(arcs[:, [0, 2]].reshape(-1), minlength=n),
        np.concatenate([critical, np.zeros(n - len(nodes), dtype=bool)]),
        ~inner,
        offsets,
        halfarcs,
    )
    return Arrangement(
        tmesh,
        curves,
        n_traces,
        curve,
        span,
        np.array(build.curve, dtype=np.int64),
        np.array(build.at),
        t_junctions,
    )
